#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// File formats of profiles: one source file per format under src/format/, with the interface
/// Format.
namespace slideway {

/// Contents of an areal file, in its own units.
struct Areal {
  std::vector<double> x;  // of the columns
  std::vector<double> y;  // of the rows
  std::size_t missing = 0;
  std::optional<std::pair<double, double>> heights;  // smallest and largest
};

/// One line of points of a file, in its own units.
struct Trace {
  std::vector<double> positions;
  std::vector<double> values;          // as many; NaN where the file says that the point is missing
  std::string position_unit;           // of kLengthUnits, or "s"; empty if the file does not say
  std::string value_unit;              // the same, or one of kSlopeUnits
  std::vector<std::string> decisions;  // what the reader detected or decided, one sentence each
  std::optional<Areal> areal;          // of an areal file if no line is chosen; no points then
  std::vector<double> times;           // as many if the request names a time column, else none
};

/// Consecutive points of a trace.
struct TracePart {
  const std::string &position_unit, &value_unit;  // as in Trace
  bool states_units;                              // the format always does
  std::span<const double> positions, values;
  double share;                        // of the file, read with this part
  std::span<const double> times = {};  // as in Trace
  std::string_view time_unit = {};     // "s"; empty if the file does not say
};
using TakePoints = std::function<void(const TracePart&)>;

/// What a caller may specify of a file; the rest is detected.
struct TraceRequest {
  std::string position_column = "1";  // text: header name or 1-based number
  std::string value_column = "2";
  std::string time_column;           // text: when each point was read; empty: not asked for
  bool positions_are_times = false;  // text: of a log
  std::string delimiter;             // text: "," ";" "tab" "blank"
  std::string decimal;               // text: "." ","
  std::string encoding;              // text: "utf-8" "utf-16" "latin-1"
  std::optional<int> header_lines;   // text: lines before the first row of numbers
  std::string line;  // areal files: "row:12" "column:3" (1-based) "diameter:30" (degrees)
  bool areal_without_line = false;  // what such a file holds, or an error
  bool ignore_checksum = false;
};

/// Whether a file says what its positions and its values are in.
struct StatedUnits {
  bool position = false, value = false;
};

/// A file format. A reader gets the whole file, trusts nothing in it, and needs memory in
/// proportion to its actual contents.
class Format {
 public:
  virtual ~Format() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;                      // "X3P"
  [[nodiscard]] virtual std::span<const std::string_view> endings() const = 0;  // ".x3p"

  /// Whether the content has this format; the name of the file does not matter. Exactly one format
  /// recognises a file; delimited text takes what no other does.
  [[nodiscard]] virtual bool recognises(std::string_view bytes) const = 0;

  /// Whether a file of this format always states its units. Delimited text does not.
  [[nodiscard]] virtual bool states_units() const { return true; }

  /// Whether this content states the units of the two columns asked for.
  [[nodiscard]] virtual StatedUnits stated_units(std::string_view bytes,
                                                 const TraceRequest& request) const;

  /// Whether write() is supported.
  [[nodiscard]] virtual bool is_writable() const { return true; }

  /// @throws DataError   "place in the file: what is wrong, what is accepted"
  /// @throws UsageError  the request does not fit this file
  [[nodiscard]] virtual Trace read(std::string_view bytes, const TraceRequest& request) const = 0;

  /// read() in parts, if the format supports it: `take` is called with all points in order; the
  /// returned trace has none.
  [[nodiscard]] virtual Trace read_in_parts(std::string_view bytes, const TraceRequest& request,
                                            const TakePoints& take) const;

  /// Bytes from which read() returns the same trace.
  /// @throws UsageError  if the format cannot represent the trace
  [[nodiscard]] virtual std::string write(const Trace& trace) const = 0;
};

/// All formats, delimited text last.
std::span<const Format* const> formats();

/// A trace file that was read.
struct TraceFile {
  std::string format;
  bool states_units = false;
  std::string sha256;  // of its bytes
  Trace trace;
};

/// The format that recognises a file's content.
const Format& recognised_format(std::string_view bytes);

/// Which units a file states, as far as can be told without reading its points: none of a file that
/// is not there, both of one that read_trace() will refuse.
StatedUnits stated_units(const std::filesystem::path& path, const TraceRequest& request);

/// The format to write, by the ending of a file name.
/// @throws UsageError  no writable format has this ending
const Format& format_to_write(const std::filesystem::path& path);

/// Reads a regular file. With `take`, the points go there and not into the result; the memory for
/// delimited text is then bounded.
/// @throws DataError   "path: place: what is wrong"
/// @throws UsageError  "path: ..." the request asks for what this file has not
TraceFile read_trace(const std::filesystem::path& path, const TraceRequest& request,
                     const TakePoints& take = {});

}  // namespace slideway
