#include "xml.hpp"

#include <algorithm>
#include <cstddef>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr int kDeepest = 32;

// A tree takes some 64 bytes for each tag. No honest file has more of them than of "<Datum/>".
constexpr std::size_t kFreeTags = 4096;
constexpr std::size_t kBytesPerTag = 8;

struct Inspector : pugi::xml_tree_walker {
  explicit Inspector(Doctype allowed) : doctype(allowed) {}

  bool for_each(pugi::xml_node& node) override {
    if (depth() > kDeepest)
      wrong = "elements nested deeper than " + std::to_string(kDeepest);
    else if (node.type() == pugi::node_doctype && doctype == Doctype::refused)
      wrong = "a DOCTYPE is not accepted";
    else if (node.type() == pugi::node_doctype &&
             std::string_view(node.value()).find('[') != std::string_view::npos)
      wrong = "a DOCTYPE that declares entities is not accepted";
    return wrong.empty();
  }

  Doctype doctype;
  std::string wrong;
};

}  // namespace

std::unique_ptr<pugi::xml_document> parse_xml(std::string_view text, Doctype doctype,
                                              const std::string& place) {
  const auto tags = static_cast<std::size_t>(std::count(text.begin(), text.end(), '<'));
  if (tags > kFreeTags + text.size() / kBytesPerTag)
    throw DataError(place + ": " + std::to_string(tags) + " tags in " +
                    std::to_string(text.size()) + " bytes; accepted: one in " +
                    std::to_string(kBytesPerTag));
  auto document = std::make_unique<pugi::xml_document>();
  const pugi::xml_parse_result result =
      document->load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_doctype);
  if (!result)
    throw DataError(place + ", byte " + std::to_string(result.offset + 1) +
                    ": no well-formed XML: " + result.description());
  Inspector inspector(doctype);
  document->traverse(inspector);
  if (!inspector.wrong.empty()) throw DataError(place + ": " + inspector.wrong);
  return document;
}

pugi::xml_node element(pugi::xml_node parent, const char* path, const std::string& place) {
  const pugi::xml_node found = parent.first_element_by_path(path);
  if (!found) throw DataError(place + ": the element " + path + " is missing");
  return found;
}

std::string_view text_of(pugi::xml_node node) { return trimmed(node.child_value()); }

}  // namespace slideway
