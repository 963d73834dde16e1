#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "areal.hpp"
#include "numbers.hpp"
#include "registry.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "writable.hpp"

// SDF (ISO 25178-71, before it EUR 15178 and BCR): a header, rows of heights, a trailer; in text,
// with '*' behind each of the three, or in binary, lowest byte first.
namespace slideway {
namespace {

constexpr std::size_t kVersionSize = 8;
constexpr std::size_t kBinaryHeaderSize = 81;
constexpr std::array<std::size_t, 8> kTypeSizes{1, 2, 4, 4, 1, 2, 4, 8};
constexpr std::array<std::string_view, 3> kMissingWords{"BAD", "NaN", "nan"};

struct Header {
  std::size_t points = 0;    // of a row
  std::size_t profiles = 0;  // rows
  double x_scale = 0.0;      // m
  double y_scale = 0.0;      // m; not looked at if there is one row only
  double z_scale = 0.0;      // m
  unsigned type = 0;
};

// "aBCR-1.0", "bISO-1.0", "aNPL-V1.0", "aBCR - 1.0": coding, who defined it, version.
bool is_version(std::string_view text) {
  std::string dense;
  for (const char c : text.substr(0, 16))
    if (c != ' ' && c != '\0') dense += c;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const std::size_t dash = dense.find('-');
  if (dash == std::string::npos || dash < 2 || (dense[0] != 'a' && dense[0] != 'b')) return false;
  if (!std::all_of(dense.begin(), dense.begin() + static_cast<std::ptrdiff_t>(dash), is_letter))
    return false;
  std::string_view number = std::string_view(dense).substr(dash + 1);
  if (number.starts_with('V')) number.remove_prefix(1);
  return number.size() >= 3 && number.find_first_not_of("0123456789.") == std::string_view::npos;
}

// The first line of text, the first bytes of binary.
std::string_view version_of(std::string_view bytes) {
  return bytes.starts_with('b')
             ? bytes.substr(0, kVersionSize)
             : trimmed(bytes.substr(0, std::min(bytes.find('\n'), bytes.size())));
}

[[noreturn]] void refuse(const std::string& key, double value, const std::string& accepted) {
  throw DataError("header: " + key + " = " + significant(value, 6) + "; accepted: " + accepted);
}

void check(const Header& header, double compression, double checksum, double type) {
  if (compression != 0.0) refuse("Compression", compression, "0 (none)");
  if (checksum != 0.0) refuse("CheckType", checksum, "0 (none)");
  if (!(type >= 0.0 && type <= 7.0) || type != std::floor(type)) refuse("DataType", type, "0 to 7");
  const auto extent = static_cast<double>(header.points) * header.x_scale;
  if (!(header.x_scale > 0.0 && std::isfinite(extent)))
    refuse("Xscale", header.x_scale, "a spacing above 0, in m");
  if (header.profiles > 1 && !(header.y_scale > 0.0))
    refuse("Yscale", header.y_scale, "a spacing above 0, in m");
  if (header.z_scale == 0.0 || !std::isfinite(header.z_scale))
    refuse("Zscale", header.z_scale, "the m that a height of 1 stands for");
}

Header read_text_header(std::string_view text) {
  std::string blanked(text);
  std::replace(blanked.begin(), blanked.end(), '=', ' ');
  const auto lower = [](std::string_view word) {
    std::string low(word.substr(0, 16));
    for (char& c : low)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return low;
  };
  std::map<std::string, std::string_view> values{
      {"numpoints", {}}, {"numprofiles", {}}, {"xscale", {}},   {"yscale", {}},
      {"zscale", {}},    {"compression", {}}, {"datatype", {}}, {"checktype", {}}};
  Words left(blanked);
  while (const auto word = left.next())
    if (const auto key = values.find(lower(*word)); key != values.end() && key->second.empty())
      key->second = left.next().value_or("");

  const auto value = [&](const std::string& key) {
    const std::string_view field = values.at(lower(key));
    if (field.empty()) throw DataError("header: " + key + " is missing");
    return field;
  };
  const auto number = [&](const std::string& key) {
    return read_number(value(key), "header: " + key);
  };
  Header header;
  header.points = read_count(value("NumPoints"), "header: NumPoints");
  header.profiles = read_count(value("NumProfiles"), "header: NumProfiles");
  header.x_scale = number("Xscale");
  header.y_scale = number("Yscale");
  header.z_scale = number("Zscale");
  const double type = number("DataType");
  check(header, number("Compression"), number("CheckType"), type);
  header.type = static_cast<unsigned>(type);
  return header;
}

Header read_binary_header(std::string_view bytes) {
  if (bytes.size() < kBinaryHeaderSize)
    throw DataError("header: " + std::to_string(bytes.size()) + " bytes where " +
                    std::to_string(kBinaryHeaderSize) + " are needed; is the file cut off?");
  const auto number = [&](std::size_t at) { return little_endian<double>(bytes.substr(at)); };
  const auto byte = [&](std::size_t at) { return little_endian<std::uint8_t>(bytes.substr(at)); };
  const auto count = [&](std::size_t at, const std::string& key) {
    return read_count(std::to_string(little_endian<std::uint16_t>(bytes.substr(at))),
                      "header: " + key);
  };
  // After version (8), ManufacID (10), CreateDate and ModDate (12 each).
  Header header{count(42, "NumPoints"),
                count(44, "NumProfiles"),
                number(46),
                number(54),
                number(62),
                byte(79)};
  check(header, byte(78), byte(80), byte(79));
  return header;
}

// Some programs (Olympus) put the numbers 5 and 1 behind the header of bISO-1.0; the file is then
// longer than the header says by just these eight bytes.
bool has_longer_header(std::string_view rest, std::size_t data_size) {
  return rest.size() == data_size + 8 && rest.starts_with({"\5\0\0\0\1\0\0\0", 8});
}

std::vector<double> read_text_values(std::string_view text, const Header& header) {
  if (header.points > (std::size_t{1} << 53U) / header.profiles)
    throw DataError("header: NumPoints x NumProfiles: more points than any file holds");
  const std::size_t end = text.find('*');
  if (end == std::string_view::npos)
    throw DataError("data: no '*' behind the heights; is the file cut off?");
  if (!trimmed(text.substr(end + 1)).ends_with('*'))
    throw DataError("trailer: no '*' at its end; is the file cut off?");
  return read_numbers(text.substr(0, end), header.points * header.profiles, "data", kMissingWords);
}

template <typename Number>
std::vector<double> decode(std::string_view bytes, std::size_t count, std::optional<Number> bad) {
  check_count(count, bytes.size(), sizeof(Number), "data");
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto stored = little_endian<Number>(bytes.substr(i * sizeof(Number)));
    values[i] = bad && stored == *bad ? std::numeric_limits<double>::quiet_NaN()
                                      : static_cast<double>(stored);
    if (std::isinf(values[i]))
      throw DataError("data, value " + std::to_string(i + 1) + ": infinite");
  }
  return values;
}

// A missing point is NaN, or the number an integer type can best do without; 8 bits spare none.
std::vector<double> read_binary_values(std::string_view bytes, const Header& header) {
  const std::size_t count = header.points * header.profiles;
  switch (header.type) {
    case 0:
      return decode<std::uint8_t>(bytes, count, {});
    case 1:
      return decode<std::uint16_t>(bytes, count, std::numeric_limits<std::uint16_t>::max());
    case 2:
      return decode<std::uint32_t>(bytes, count, std::numeric_limits<std::uint32_t>::max());
    case 3:
      return decode<float>(bytes, count, {});
    case 4:
      return decode<std::int8_t>(bytes, count, {});
    case 5:
      return decode<std::int16_t>(bytes, count, std::numeric_limits<std::int16_t>::min());
    case 6:
      return decode<std::int32_t>(bytes, count, std::numeric_limits<std::int32_t>::min());
    default:
      return decode<double>(bytes, count, {});
  }
}

class Sdf final : public Format {
 public:
  [[nodiscard]] std::string_view name() const override { return "SDF"; }
  [[nodiscard]] std::span<const std::string_view> endings() const override {
    static constexpr std::string_view kEndings[] = {".sdf"};
    return kEndings;
  }
  [[nodiscard]] bool recognises(std::string_view bytes) const override {
    return is_version(version_of(bytes));
  }
  [[nodiscard]] Trace read(std::string_view bytes, const TraceRequest& request) const override;
  [[nodiscard]] std::string write(const Trace& trace) const override;
};

Trace Sdf::read(std::string_view bytes, const TraceRequest& request) const {
  if (!recognises(bytes))
    throw DataError("version '" + printable(version_of(bytes)) +
                    "'; accepted: as aISO-1.0 (text) or bISO-1.0 (binary)");
  Header header;
  std::vector<double> heights;
  if (bytes.starts_with('b')) {
    header = read_binary_header(bytes);
    std::string_view rest = bytes.substr(kBinaryHeaderSize);
    if (has_longer_header(rest, header.points * header.profiles * kTypeSizes[header.type]))
      rest.remove_prefix(8);
    heights = read_binary_values(rest, header);
  } else {
    const std::size_t end = bytes.find('*');
    if (end == std::string_view::npos)
      throw DataError("header: no '*' behind it; is the file cut off?");
    header = read_text_header(bytes.substr(0, end));
    heights = read_text_values(bytes.substr(end + 1), header);
  }
  multiply(heights, header.z_scale, "header: Zscale");
  const Grid grid{even_positions(header.points, 0.0, header.x_scale),
                  even_positions(header.profiles, 0.0, header.y_scale), std::move(heights)};
  Trace trace = line_of(grid, request, "m");
  trace.decisions.insert(trace.decisions.begin(),
                         "version " + printable(version_of(bytes)) + ", lengths in m");
  return trace;
}

std::string Sdf::write(const Trace& trace) const {
  check_lengths(trace, "SDF");
  const double spacing = spacing_from_zero(trace, "SDF");
  std::string text =
      "aISO-1.0\nManufacID = slideway\nCreateDate = 010119700000\nModDate = 010119700000\n"
      "NumPoints = " +
      std::to_string(trace.values.size()) +
      "\nNumProfiles = 1\nXscale = " + shortest(converted(spacing, trace.position_unit, "m")) +
      "\nYscale = 0\nZscale = 1\nZresolution = -1\nCompression = 0\nDataType = 7\n"
      "CheckType = 0\n*\n";
  for (const double value : trace.values)
    text += (std::isnan(value) ? "BAD" : shortest(converted(value, trace.value_unit, "m"))) + "\n";
  return text + "*\n*";
}

}  // namespace

const Format& sdf_format() {
  static const Sdf kFormat;
  return kFormat;
}

}  // namespace slideway
