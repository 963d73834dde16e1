#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slideway/base/error.hpp"
#include "slideway/format/format.hpp"
#include "slideway/profile/outliers.hpp"
#include "slideway/profile/setup.hpp"
#include "slideway/signal/low_band.hpp"

namespace slideway {

enum class Role {
  fit,
  holdout  // never fitted, only predicted
};

/// What a residual costs: its square; beyond a few standard uncertainties its size (Huber) or the
/// logarithm of its square (Cauchy), for traces with dirt.
enum class Loss { none, huber, cauchy };

/// An outlier by its data row, counted from 1 as the file has them; mm or rad.
struct OutlierRow {
  std::size_t row = 0;
  double value = 0.0, expected = 0.0;
  OutlierKind kind = OutlierKind::spike;
};

/// Where a profile lies on the surface: [x, y] of its ends, missing samples included. A slope over
/// a base ends at the outer feet.
struct Line {
  std::array<double, 2> from_mm{}, to_mm{};
  double first_mm = 0.0, last_mm = 0.0;  // smallest and largest position: at from_mm, at to_mm
};

/// One measured profile, ready for use: positions in mm, strictly increasing; values in mm
/// (heights) or rad (slopes). The two have the same length.
struct Profile {
  std::string name;
  std::string file;    // as the problem names it
  std::string format;  // "text", "X3P", ...
  std::string sha256;  // of the file's bytes
  Setup setup;
  Role role = Role::fit;
  std::optional<std::string> surface;     // traces of one surface share its form; none: its own
  std::optional<std::string> instrument;  // traces of one share its errors; none: one for each kind
                                          // and quantity
  std::optional<Line> line;
  std::vector<double> positions;
  std::vector<double> values;
  std::size_t missing = 0;           // points of the file that have no value, left out here
  std::vector<OutlierRow> outliers;  // what find_outliers() says, left out or not
  std::size_t left_out = 0;          // samples that are, as the problem asks
  bool free_offset = true;           // what levelling left undetermined: nuisances of this profile
  bool free_tilt = true;
  std::optional<double> standard_uncertainty;  // of one sample, mm or rad
  double resolution =
      0.0;  // of the readings, mm or rad: they differ by multiples of it; 0: not seen
  std::optional<LowBandOptions> low_band;  // its own; none: that of the problem
  Loss loss = Loss::none;
  std::vector<std::string> notes;   // what was done to the data on the way in
  std::vector<std::string> doubts;  // what is more likely a slip in the problem than so

  [[nodiscard]] Stations stations(const Machine& machine) const {
    return {positions, setup, machine};
  }
};

/// Names of profiles by the instrument that read them: of one name, or of none and of one kind;
/// always of one quantity.
std::vector<std::vector<std::string>> by_instrument(const std::vector<const Profile*>& profiles);

/// How to get a profile out of a file: what the problem file says of it. A unit is empty only if
/// the file states it.
struct ProfileSource {
  std::filesystem::path path;
  TraceRequest request;
  std::string position_unit;                        // of kLengthUnits; "s": time * feed_mm_per_min
  std::string value_unit;                           // of kLengthUnits or kSlopeUnits
  std::string time_unit;                            // of kTimeUnits; of a time column
  std::optional<std::pair<double, double>> window;  // in position_unit
  std::vector<std::pair<double, double>> mask;      // parts treated as missing, in position_unit
  std::vector<std::size_t> left_out_rows;           // data rows treated as missing, from 1
  bool leave_out_spikes = false;                    // outliers treated as missing
  std::size_t most_samples = 10'000'000;            // more are kept as means of 2, 4, 8, ...; even
};

/// A key of a [[profile]] that does not fit the data.
struct KeyError : UsageError {
  KeyError(std::string name, const std::string& what) : UsageError(what), key(std::move(name)) {}
  std::string key;  // "center_mm"
};

/// Told which part of what is to be read has been, 0 to 1, in the thread that reads.
using ReadProgress = std::function<void(double done)>;

/// Reads, converts and sorts out one profile: window applied, missing points left out, a trace that
/// runs backwards reversed, outliers listed, and left out if asked, cut_radius_mm completed. Notes
/// tell what was decided, and of sizes that a wrong unit makes. A file that states its units is
/// converted from those.
/// @param progress  is told which part of the file has been read
/// @throws DataError   what read_trace() refuses; a unit in the header that is not the source's;
///                     naming file and row: unsorted or repeated positions, positions of a slide
///                     that differ in their last digits only, too few rows, a time column without
///                     a time
/// @throws UsageError  no unit, no feed where the positions are times, a row to leave out that is
///                     not there
/// @throws KeyError    a cut smaller than the trace; a centre so far away that the radius is one
///                     number along it
void read_profile(const ProfileSource& source, Profile& profile, const ReadProgress& progress = {});

/// Of a profile with its positions, read or planned: both ends, the radius of its cut, and doubts
/// of sizes in its setup that no workshop has.
/// @throws KeyError  as read_profile()
void complete_setup(Profile& profile);

}  // namespace slideway
