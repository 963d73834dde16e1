#include "slideway/format/rows.hpp"

#include <algorithm>

#include "dialect.hpp"
#include "encoding.hpp"
#include "fields.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

[[noreturn]] void refuse(std::size_t line, const std::string& what) {
  throw DataError("line " + std::to_string(line) + ": " + what);
}

char delimiter_of(std::string_view header) {
  for (const char c : {';', '\t'})
    if (header.find(c) != std::string_view::npos) return c;
  return ',';
}

std::vector<std::string> fields_of(std::string_view line, char delimiter, std::size_t number) {
  if (std::count(line.begin(), line.end(), '"') % 2 != 0)
    refuse(number, "double quotes that do not end");
  std::vector<std::string> fields;
  for (const std::string_view part : split(line, delimiter)) {
    std::string field(part);
    for (std::size_t at = 0; (at = field.find("\"\"", at)) != std::string::npos; ++at)
      field.erase(at, 1);
    fields.push_back(std::move(field));
  }
  return fields;
}

void check_names(const std::vector<std::string>& names, std::size_t line) {
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (name->empty())
      refuse(line, "column " + std::to_string(name - names.begin() + 1) + " has no name");
    if (std::find(names.begin(), name, *name) != name)
      refuse(line, "column '" + printable(*name) + "' is there twice");
  }
}

}  // namespace

TextRows parse_rows(std::string_view bytes) {
  const DecodedText decoded_text = decoded(bytes, "");
  std::string converted;
  if (!is_utf8(decoded_text.bytes())) converted = utf8_from_latin1(decoded_text.bytes());
  const std::string_view text = converted.empty() ? decoded_text.bytes() : converted;

  TextRows out;
  char delimiter = ',';
  std::size_t number = 1;
  for (std::size_t at = next_content(text, 0, number); at < text.size();) {
    const std::string_view line = line_at(text, at);
    if (out.names.empty()) {
      delimiter = delimiter_of(line);
      out.line = number;
      out.names = fields_of(line, delimiter, number);
      check_names(out.names, number);
    } else {
      std::vector<std::string> fields = fields_of(line, delimiter, number);
      while (fields.size() > out.names.size() && fields.back().empty()) fields.pop_back();
      if (fields.size() > out.names.size())
        refuse(number, std::to_string(fields.size()) + " fields, but " +
                           std::to_string(out.names.size()) +
                           (out.names.size() == 1 ? " column" : " columns"));
      fields.resize(out.names.size());
      out.rows.push_back({number, std::move(fields)});
    }
    at = next_content(text, std::min(text.size(), at + line.size() + 1), ++number);
  }
  if (out.names.empty()) throw DataError("holds no header line");
  return out;
}

}  // namespace slideway
