#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slideway/effects/effect.hpp"
#include "slideway/identify/assumption.hpp"
#include "slideway/identify/fault.hpp"
#include "slideway/identify/gates.hpp"
#include "slideway/profile/profile.hpp"
#include "slideway/signal/low_band.hpp"

namespace slideway {

struct DeclaredEffect {
  std::string name;
  EffectOptions options;
  std::vector<Prior> priors;
};

/// The run-out measurement of Eq. (21): θ = (r + p) / L.
struct Runout {
  double r_um = 0.0;
  double p_um = 0.0;
  double diameter_mm = 0.0;
  double standard_uncertainty_um = 0.0;
};

struct TraceOptions {
  std::vector<std::string> candidates;  // of the catalogue; "all" is written out
  std::vector<DeclaredEffect> own;      // besides: the user's own, and those with options
  int max_effects = 3;
  std::optional<double> time_limit_s;  // of the loop; none: as long as it needs
  Gates gates;
};

/// Limits of a workpiece, for its conformity.
struct Tolerance {
  std::optional<double> flatness_um, straightness_um, squareness_um_per_m;
};

/// What `simulate` makes profiles from.
struct Truth {
  std::uint64_t seed = 1;
  double noise_um = 0.0;              // standard deviation of one sample (slope profiles: µrad)
  double noise_correlation_mm = 0.0;  // 0: white; else exponential autocorrelation exp(-|Δs| / it)
  std::size_t samples = 20000;        // of a profile whose file is not there yet
  std::map<std::string, double> parameters;  // "squareness.dbeta_xz" -> value
  struct HiddenEffect {                      // one the model does not declare
    std::string name;
    EffectOptions options;
    std::map<std::string, double> parameters;
  };
  std::vector<HiddenEffect> effects;
};

/// One [[profile]] of the problem file: where the data are, and everything but the data.
struct ProfileEntry {
  ProfileSource source;
  Profile profile;                   // name, file, setup, role, ...; positions and values empty
  std::map<std::string, int> lines;  // of its keys in the problem file, and of "", the table
};

/// One [[plan.cut]]: a cut or trace that can be made next.
struct PlannedCut {
  ProfileEntry entry;       // without a file; a key it leaves out is that of `like`
  std::string like;         // a profile, else the first of its kind and quantity; empty: none is
  std::size_t samples = 0;  // evenly spaced in the window; 0: as close as those of `like`
  std::optional<double> cost, time_min;
};

/// A problem file, checked.
struct Problem {
  std::filesystem::path path;
  std::string title;
  std::map<std::string, std::string> about;  // [about] as it stands
  Tolerance tolerance;
  std::vector<Body> bodies;  // the paper's lathe unless the file lists its own
  Lever lever = Lever::paper;
  double beam_span_mm = 0.0;  // between the supports of the cross-beam (gantry_sag); 0: unknown
  LowBandOptions low_band;    // of profiles without one of their own
  std::vector<ProfileEntry> profiles;
  std::vector<DeclaredEffect> effects;
  std::vector<DeclaredEffect> own_effects;    // all that are not of the catalogue, by their names
  std::vector<std::filesystem::path> beside;  // files it names that hold no profile
  std::vector<std::string> remarks;           // on what those hold
  std::optional<Runout> runout;
  TraceOptions trace;
  std::optional<Truth> truth;
  std::vector<PlannedCut> planned;
  std::vector<Assumption> assumed;  // values that the data give are empty: assumptions()

  [[nodiscard]] Machine machine() const { return {bodies, lever}; }
  [[nodiscard]] const LowBandOptions& low_band_of(const Profile& profile) const {
    return profile.low_band ? *profile.low_band : low_band;
  }
};

/// Reads a problem file (TOML). `data_dir` replaces ${SLIDEWAY_DATA} in paths; without it such a
/// path is refused.
/// @throws UsageError  "file:line: key: what is wrong; accepted: ..." for an unknown key, a missing
///                     unit, a wrong type, a value out of range; a file that is not there or is no
///                     TOML
Problem read_problem(const std::filesystem::path& path,
                     const std::optional<std::filesystem::path>& data_dir = std::nullopt);

/// The same, with every fault added to `faults` instead of the first one thrown; nothing if there
/// are any.
std::optional<Problem> read_problem(const std::filesystem::path& path,
                                    const std::optional<std::filesystem::path>& data_dir,
                                    Faults& faults);

/// The same of a file that may do without [[effect]], for what looks at its profiles alone.
Problem read_profiles_of_problem(
    const std::filesystem::path& path,
    const std::optional<std::filesystem::path>& data_dir = std::nullopt);

/// Reads all profiles of a problem, in order, and tells which part of their bytes has been read.
/// @throws DataError, UsageError
std::vector<Profile> read_profiles(const Problem& problem, const ReadProgress& progress = {});

/// The profiles that can be read; why the others cannot is added to `faults`.
std::vector<Profile> read_profiles(const Problem& problem, Faults& faults);

/// Adds an effect that is not in the catalogue to those that the loop looks for.
/// @throws UsageError  if another effect of the problem or of the catalogue has its name
void look_for(DeclaredEffect effect, Problem& problem);

/// The effects of a file that problems share (`effects = ["our-lathes.toml"]`): [[effect]] tables,
/// each a formula with cause, source and typical size.
/// @throws UsageError  as read_problem()
std::vector<DeclaredEffect> read_effect_file(const std::filesystem::path& path);

/// What was assumed because the problem file leaves it out, with what the profiles say.
/// REQUIRES one profile per entry.
std::vector<Assumption> assumptions(const Problem& problem, const std::vector<Profile>& profiles);

/// The problem file without its [truth], each profile's `file` replaced by one of `files` with the
/// columns x_mm, z_um (slopes: slope_urad) and, with a time column, t_s; no window and no
/// leave_out. The same text on every machine. REQUIRES one file per profile.
/// @throws UsageError  the problem file can no longer be read
std::string simulated_problem_text(const Problem& problem, const std::vector<std::string>& files);

/// The problem file without [plan] and [truth], to be put into another directory: relative paths
/// lead from there to where they lead now.
/// @throws UsageError  the problem file can no longer be read
std::string moved_problem_text(const Problem& problem, const std::filesystem::path& directory);

}  // namespace slideway
