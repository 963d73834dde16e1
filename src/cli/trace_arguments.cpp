#include "trace_arguments.hpp"

#include <boost/program_options/value_semantic.hpp>
#include <charconv>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

void add_unit(const std::string& option, const std::string& asked, const std::string& accepted,
              bool known, const TraceFile& file, std::string& unit) {
  if (asked.empty()) return;
  if (!known)
    throw UsageError("--" + option + ": '" + printable(asked) +
                     "' is not accepted; accepted: " + accepted);
  if (!unit.empty() && unit != asked)
    throw UsageError("--" + option + " " + asked + ": the file, " + file.format + ", has " + unit);
  unit = asked;
}

}  // namespace

void TraceArguments::add_to(po::options_description_easy_init options) {
  options("position", po::value(&request_.position_column)->value_name("COL"),
          "text: column of the positions, header name or number (default 1)");
  options("value", po::value(&request_.value_column)->value_name("COL"),
          "text: column of the values (default 2)");
  options("position-unit", po::value(&position_unit_)->value_name("UNIT"),
          "text without units: m mm um nm inch s");
  options("value-unit", po::value(&value_unit_)->value_name("UNIT"),
          "text without units: m mm um nm inch, or a slope's");
  options("delimiter", po::value(&request_.delimiter)->value_name("CHAR"), "text: , ; tab blank");
  options("decimal", po::value(&request_.decimal)->value_name("CHAR"), "text: . or ,");
  options("encoding", po::value(&request_.encoding)->value_name("NAME"),
          "text: utf-8 utf-16 latin-1");
  options("header-lines", po::value(&header_lines_)->value_name("N"),
          "text: lines before the first row of numbers");
  options("line", po::value(&request_.line)->value_name("LINE"),
          "areal file: row:12 column:3 diameter:30");
  options("ignore-checksum", po::bool_switch(&request_.ignore_checksum),
          "read a file whose checksum is wrong");
}

TraceRequest TraceArguments::checked() const {
  TraceRequest request = request_;
  if (header_lines_.empty()) return request;
  int lines = 0;
  const char* const end = header_lines_.data() + header_lines_.size();
  const auto [stop, error] = std::from_chars(header_lines_.data(), end, lines);
  if (error != std::errc() || stop != end || lines < 0)
    throw UsageError("--header-lines: '" + printable(header_lines_) +
                     "' is not accepted; accepted: a whole number from 0");
  request.header_lines = lines;
  return request;
}

void TraceArguments::add_units(TraceFile& file) const {
  const std::string lengths(kLengthUnits);
  add_unit("position-unit", position_unit_, lengths + " s",
           length_unit(position_unit_) || position_unit_ == "s", file, file.trace.position_unit);
  add_unit("value-unit", value_unit_, lengths + " " + std::string(kSlopeUnits),
           length_unit(value_unit_) || slope_unit(value_unit_), file, file.trace.value_unit);
}

}  // namespace slideway
