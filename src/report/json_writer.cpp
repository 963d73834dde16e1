#include "json_writer.hpp"

#include <charconv>
#include <nlohmann/json.hpp>

#include "slideway/report/number.hpp"

namespace slideway {
namespace {

using Json = nlohmann::ordered_json;

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

void JsonWriter::write(double number) {
  if (is_probability_) number = written_probability(number);
  if (!std::isfinite(number)) {
    text_ += "null";
    return;
  }
  number += 0.0;  // no -0, which reads back as a whole number
  char buffer[32];
  char* const end = buffer + sizeof buffer;
  const auto [stop, error] =
      digits_ > 0 ? std::to_chars(buffer, end, number, std::chars_format::general, digits_)
                  : std::to_chars(buffer, end, number);
  const std::string_view text(buffer, static_cast<std::size_t>(stop - buffer));
  text_ += text;
  if (digits_ == 0 && text.find_first_of(".e") == std::string_view::npos) text_ += ".0";
}

void JsonWriter::write(const std::string& text) {
  if (digits_ == kJsonText && Json::accept(text))
    text_ += dumped(Json::parse(text));
  else
    quote(text);
}

void JsonWriter::quote(std::string_view text) { text_ += dumped(Json(text)); }

void JsonWriter::open(char bracket) {
  text_ += bracket;
  ++depth_;
  is_first_ = true;
}

void JsonWriter::next() {
  if (!is_first_) text_ += ",";
  is_first_ = false;
  if (indented_) text_.append("\n").append(2 * depth_, ' ');
}

void JsonWriter::key(std::string_view name) {
  next();
  text_.append("\"").append(name).append(indented_ ? "\": " : "\":");
}

void JsonWriter::close(char bracket) {
  --depth_;
  if (indented_ && !is_first_) text_.append("\n").append(2 * depth_, ' ');
  text_ += bracket;
  is_first_ = false;
}

}  // namespace slideway
