#include <array>
#include <cstdint>

#include "areal.hpp"
#include "numbers.hpp"
#include "registry.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "writable.hpp"

// SMD (ISO 5436-2, softgauges of type F1): four records of text, each closed by ETX: header,
// description, heights, checksum; then SUB. Fields end with NUL or a blank. Supported: profiles
// (PRF) with an incremental CX and an absolute CZ, as NPL and PTB document them.
namespace slideway {
namespace {

constexpr char kEndOfRecord = '\x03';
constexpr char kEndOfFile = '\x1a';
constexpr std::string_view kAxisForm = " TYPE COUNT UNIT SCALE DATATYPE";

struct SmdAxis {
  std::string place;
  std::vector<std::string_view> fields;  // CX I 22401 mm 1.0e0 D 2.5e-4
  [[nodiscard]] std::size_t count() const { return read_count(fields[2], place + ", count"); }
  [[nodiscard]] double scale() const { return read_positive(fields[4], place + ", scale"); }
  [[nodiscard]] std::string unit() const {
    if (!length_unit(fields[3]))
      throw DataError(place + ": the unit '" + printable(fields[3]) +
                      "' is no length; accepted: " + std::string(kLengthUnits));
    return std::string(fields[3]);
  }
};

SmdAxis read_smd_axis(std::string_view line, std::string_view name, std::string_view type,
                      std::size_t size) {
  SmdAxis axis{"record 1, " + std::string(name), words(line.substr(0, 400))};
  if (axis.fields.size() < size || axis.fields[0] != name)
    throw DataError(axis.place + ": '" + printable(line) + "'; accepted: " + std::string(name) +
                    std::string(kAxisForm) + (size > 6 ? " INCREMENT" : ""));
  if (axis.fields[1] != type)
    throw DataError(axis.place + ": axis type '" + printable(axis.fields[1]) +
                    "'; accepted: " + std::string(type));
  if (axis.fields[5].size() != 1 || axis.fields[5].find_first_of("ILFD") != 0)
    throw DataError(axis.place + ": data type '" + printable(axis.fields[5]) +
                    "'; accepted: I L F D");
  return axis;
}

// Sum of the bytes of the first three records with their ends; programs take it modulo 65535 or
// 65536.
std::array<std::uint64_t, 2> checksums(std::string_view bytes) {
  std::uint64_t sum = 0;
  for (const char c : bytes) sum += static_cast<unsigned char>(c);
  return {sum % 65536, sum % 65535};
}

class Smd final : public Format {
 public:
  [[nodiscard]] std::string_view name() const override { return "SMD"; }
  [[nodiscard]] std::span<const std::string_view> endings() const override {
    static constexpr std::string_view kEndings[] = {".smd"};
    return kEndings;
  }
  [[nodiscard]] bool recognises(std::string_view bytes) const override {
    return bytes.starts_with("ISO 5436");
  }
  [[nodiscard]] Trace read(std::string_view bytes, const TraceRequest& request) const override;
  [[nodiscard]] std::string write(const Trace& trace) const override;
};

// The four records, each without its ETX and the line end behind that.
std::array<std::string_view, 4> read_records(std::string_view bytes) {
  std::array<std::string_view, 4> records;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const std::size_t end = bytes.find(kEndOfRecord);
    if (end == std::string_view::npos)
      throw DataError("record " + std::to_string(i + 1) +
                      ": no ETX (byte 3) at its end; is the file cut off?");
    records[i] = bytes.substr(0, end);
    bytes.remove_prefix(end + 1);
    for (const char c : {'\r', '\n'})
      if (bytes.starts_with(c)) bytes.remove_prefix(1);
  }
  if (!bytes.starts_with(kEndOfFile))
    throw DataError("behind record 4: no SUB (byte 26); is the file cut off?");
  return records;
}

void check_sum(std::string_view bytes, std::string_view record, bool ignore, Trace& trace) {
  const auto sums = checksums(bytes);
  const std::string_view given = Words(record).next().value_or("");
  if (given == std::to_string(sums[0]) || given == std::to_string(sums[1])) return;
  const std::string wrong = "record 4: the checksum is " + std::to_string(sums[0]) +
                            ", the file says '" + printable(given) + "'";
  if (!ignore) throw DataError(wrong + "; to read it nevertheless, ignore the checksum");
  trace.decisions.push_back(wrong + "; read nevertheless, as asked");
}

Trace Smd::read(std::string_view bytes, const TraceRequest& request) const {
  refuse_line(request, name());
  const auto records = read_records(bytes);
  std::string_view header = records[0];
  if (const std::string_view first = take_line(header); !recognises(first))
    throw DataError("line 1: '" + printable(first) + "'; accepted: ISO 5436 ...");
  const std::string_view feature = Words(take_line(header)).next().value_or("");
  if (feature != "PRF")
    throw DataError("line 2: feature type '" + printable(feature) + "'; accepted: PRF");
  const SmdAxis x = read_smd_axis(take_line(header), "CX", "I", 7);
  const SmdAxis z = read_smd_axis(take_line(header), "CZ", "A", 6);
  if (x.count() != z.count())
    throw DataError("record 1: CX has " + std::to_string(x.count()) + " points, CZ " +
                    std::to_string(z.count()));

  Trace trace;
  const auto summed = static_cast<std::size_t>(records[3].data() - bytes.data());
  check_sum(bytes.substr(0, summed), records[3], request.ignore_checksum, trace);
  const double spacing = read_positive(x.fields[6], x.place + ", increment") * x.scale();
  trace.position_unit = x.unit();
  trace.value_unit = z.unit();
  trace.values = read_numbers(records[2], z.count(), "record 3");
  multiply(trace.values, z.scale(), z.place + ", scale");
  trace.positions = even_positions(trace.values.size(), 0.0, spacing);
  return trace;
}

std::string Smd::write(const Trace& trace) const {
  using namespace std::string_literals;
  check_lengths(trace, name());
  check_complete(trace, name());
  const std::string count = std::to_string(trace.values.size());
  const std::string end_of_record = kEndOfRecord + "\r\n"s;
  std::string text = "ISO 5436-2:2012\0 slideway\0\r\nPRF\0 1 ISO5436\0\r\n"s;
  text += "CX\0 I\0 "s + count + " " + trace.position_unit + "\0 1.0e0 D\0 "s +
          shortest(spacing_from_zero(trace, name())) + "\r\n";
  text += "CZ\0 A\0 "s + count + " " + trace.value_unit + "\0 1.0e0 D\0\r\n"s + end_of_record;
  text += "CREATED_BY slideway\0\r\n"s + end_of_record;
  for (const double value : trace.values) text += shortest(value) + "\r\n";
  text += end_of_record;
  text += std::to_string(checksums(text)[0]) + "\r\n" + end_of_record;
  return text + kEndOfFile;
}

}  // namespace

const Format& smd_format() {
  static const Smd kFormat;
  return kFormat;
}

}  // namespace slideway
