#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The files profiles arrive in: one format a file under src/format/, all behind Format.
namespace slideway {

/// What an areal file holds, in its own units.
struct Areal {
  std::vector<double> x;  // of the columns
  std::vector<double> y;  // of the rows
  std::size_t missing = 0;
  std::optional<std::pair<double, double>> heights;  // smallest and largest
};

/// One line of points out of a file, as the file has it.
struct Trace {
  std::vector<double> positions;
  std::vector<double> values;          // as many; NaN where the file says that the point is missing
  std::string position_unit;           // of kLengthUnits, or "s"; empty if the file does not say
  std::string value_unit;              // the same, or one of kSlopeUnits
  std::vector<std::string> decisions;  // what the reader found or had to decide, a sentence each
  std::optional<Areal> areal;          // of an areal file if no line is chosen; no points then
};

/// Points of a trace that follow one another.
struct TracePart {
  const std::string &position_unit, &value_unit;  // as in Trace
  bool states_units;                              // the format always does
  std::span<const double> positions, values;
  double share;  // of the file, read with this part
};
using TakePoints = std::function<void(const TracePart&)>;

/// What a caller may say of a file; whatever is left out is found in the file.
struct TraceRequest {
  std::string position_column = "1";  // text: header name or 1-based number
  std::string value_column = "2";
  std::string delimiter;            // text: "," ";" "tab" "blank"
  std::string decimal;              // text: "." ","
  std::string encoding;             // text: "utf-8" "utf-16" "latin-1"
  std::optional<int> header_lines;  // text: lines before the first row of numbers
  std::string line;  // areal files: "row:12" "column:3" (1-based) "diameter:30" (degrees)
  bool areal_without_line = false;  // what such a file holds, or an error
  bool ignore_checksum = false;
};

/// A kind of file. Readers get the whole file, trust nothing in it, and need memory in proportion
/// to what it really holds.
class Format {
 public:
  virtual ~Format() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;                      // "X3P"
  [[nodiscard]] virtual std::span<const std::string_view> endings() const = 0;  // ".x3p"

  /// Whether the content is of this format, whatever the file is called. Exactly one format
  /// recognises a file; delimited text takes what no other does.
  [[nodiscard]] virtual bool recognises(std::string_view bytes) const = 0;

  /// Whether a file of this format always states its units. Delimited text does not.
  [[nodiscard]] virtual bool states_units() const { return true; }

  /// Whether write() can do anything at all.
  [[nodiscard]] virtual bool is_writable() const { return true; }

  /// @throws DataError   "place in the file: what is wrong, what is accepted"
  /// @throws UsageError  the request asks for what this file has not
  [[nodiscard]] virtual Trace read(std::string_view bytes, const TraceRequest& request) const = 0;

  /// The same, a part at a time where the format can: `take` is called with all points in their
  /// order, which the trace that comes back does without.
  [[nodiscard]] virtual Trace read_in_parts(std::string_view bytes, const TraceRequest& request,
                                            const TakePoints& take) const;

  /// Bytes from which read() gives the same trace back.
  /// @throws UsageError  if the trace holds what the format cannot
  [[nodiscard]] virtual std::string write(const Trace& trace) const = 0;
};

/// All of them, delimited text last.
std::span<const Format* const> formats();

/// A file with everything the caller has to know of it.
struct TraceFile {
  std::string format;
  bool states_units = false;
  std::string sha256;  // of its bytes
  Trace trace;
};

/// The format of a file's content.
const Format& recognised_format(std::string_view bytes);

/// The format that is written into a file of this name.
/// @throws UsageError  its ending is none of those that can be written
const Format& format_to_write(const std::filesystem::path& path);

/// A file with its points, or with none if `take` gets them: memory then does not grow with
/// delimited text.
/// @throws DataError   "path: place: what is wrong"
/// @throws UsageError  "path: ..." the request asks for what this file has not
TraceFile read_trace(const std::filesystem::path& path, const TraceRequest& request,
                     const TakePoints& take = {});

}  // namespace slideway
