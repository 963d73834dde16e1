#pragma once

#include <memory>
#include <pugixml.hpp>
#include <string>
#include <string_view>

/// XML read with distrust.
namespace slideway {

enum class Doctype { refused, external_only };

/// The elements of a document. Refused: what is not well-formed, elements nested deeper than 32,
/// more tags than any file of numbers has, entities declared in the document.
/// @throws DataError "place: what is wrong"
std::unique_ptr<pugi::xml_document> parse_xml(std::string_view text, Doctype doctype,
                                              const std::string& place);

/// The element at a path of names separated by '/', below a node.
/// @throws DataError if it is missing
pugi::xml_node element(pugi::xml_node parent, const char* path, const std::string& place);

/// Text of a node without the blanks around it.
std::string_view text_of(pugi::xml_node node);

}  // namespace slideway
