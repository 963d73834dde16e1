#include "slideway/identify/simulate.hpp"

#include <algorithm>
#include <cmath>

#include "face_slope.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/model.hpp"

namespace slideway {
namespace {

void set_ends(Profile& profile) {
  Setup& setup = profile.setup;
  setup.first_mm = profile.positions.front();
  setup.last_mm = profile.positions.back();
  if (setup.kind == Kind::face && !setup.cut_radius_mm)
    setup.cut_radius_mm = std::max(std::abs(setup.first_mm - setup.center_mm),
                                   std::abs(setup.last_mm - setup.center_mm));
}

/// Positions of a profile whose file is not there: its window, else the face it lies on.
std::vector<double> made_positions(const ProfileEntry& entry, std::size_t samples) {
  const Setup& setup = entry.profile.setup;
  double first = 0.0, last = 0.0;
  if (entry.source.window) {
    const auto unit = length_unit(entry.source.position_unit);  // or s
    const UnitScale scale = unit ? *unit : UnitScale{*setup.feed_mm_per_min, kMinute};
    first = scale(entry.source.window->first);
    last = scale(entry.source.window->second);
  } else if (setup.kind == Kind::face && setup.cut_radius_mm) {
    first = setup.center_mm > 0.0 ? setup.center_mm - *setup.cut_radius_mm : setup.center_mm;
    last = setup.center_mm + *setup.cut_radius_mm;
  } else {
    throw UsageError("profile '" + entry.profile.name +
                     "': nothing tells the positions to simulate; accepted: an existing file, "
                     "window, or cut_radius_mm of a face");
  }
  std::vector<double> positions(samples);
  for (std::size_t i = 0; i < samples; ++i)
    positions[i] =
        first + (last - first) * static_cast<double>(i) / static_cast<double>(samples - 1);
  return positions;
}

std::vector<Profile> empty_profiles(const Problem& problem) {
  std::vector<Profile> profiles;
  for (const ProfileEntry& entry : problem.profiles) {
    Profile profile = entry.profile;
    if (std::filesystem::exists(entry.source.path)) {
      read_profile(entry.source, profile);
    } else {
      if (!entry.source.time_unit.empty())
        throw UsageError("profile '" + profile.name +
                         "': nothing tells the reading times to simulate; accepted: an existing "
                         "file, or no time_column");
      profile.positions = made_positions(entry, problem.truth->samples);
      set_ends(profile);
    }
    std::fill(profile.values.begin(), profile.values.end(), 0.0);
    profile.values.resize(profile.positions.size(), 0.0);
    profiles.push_back(std::move(profile));
  }
  return profiles;
}

/// Amplitudes and shapes of an effect with given parameter values, 0 where none is.
Eigen::VectorXd inner_of(const ModelTerm& term, const std::map<std::string, double>& parameters) {
  const std::vector<Parameter>& known = term.effect->parameters();
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(known.size()));
  for (std::size_t p = 0; p < known.size(); ++p) {
    const auto given = parameters.find(known[p].name);
    if (given != parameters.end()) values[static_cast<Eigen::Index>(p)] = given->second;
  }
  for (const Shape& shape : term.effect->shapes())
    if (!parameters.contains(known[shape.parameter].name))
      throw UsageError("truth: effect '" + term.name + "' needs " + known[shape.parameter].name);
  return term.effect->from_parameters(values);
}

/// Adds an effect to every profile.
void add_effect(const Model& model, const ModelTerm& term, const Eigen::VectorXd& inner,
                std::vector<Profile>& profiles) {
  const Eigen::VectorXd amplitudes = inner.head(term.effect->amplitudes());
  const std::vector<double> shape(inner.data() + amplitudes.size(), inner.data() + inner.size());
  for (Profile& profile : profiles) {
    const Eigen::VectorXd signal = effect_signal(model, term, profile, amplitudes, shape);
    if (!signal.allFinite())
      throw UsageError("truth: effect '" + term.name + "' is not finite on profile '" +
                       profile.name + "'");
    for (std::size_t i = 0; i < profile.values.size(); ++i) profile.values[i] += signal[i];
  }
}

/// White noise, or noise with autocorrelation exp(-|Δs| / length), exact for any spacing.
void add_noise(const Truth& truth, Profile& profile) {
  if (truth.noise_um <= 0.0) return;
  RandomStream random(truth.seed, profile.name);
  const double size = profile.setup.quantity == Quantity::height ? truth.noise_um * kMicrometre
                                                                 : truth.noise_um * 1e-6;
  double state = random.normal();
  for (std::size_t i = 0; i < profile.values.size(); ++i) {
    if (i > 0) {
      const double gap = profile.positions[i] - profile.positions[i - 1];
      const double kept =
          truth.noise_correlation_mm > 0.0 ? std::exp(-gap / truth.noise_correlation_mm) : 0.0;
      state = kept * state + std::sqrt(1.0 - kept * kept) * random.normal();
    }
    profile.values[i] += size * state;
  }
}

std::map<std::string, double> parameters_of(const Truth& truth, const std::string& effect) {
  std::map<std::string, double> out;
  for (const auto& [name, value] : truth.parameters)
    if (name.starts_with(effect + ".")) out[name.substr(effect.size() + 1)] = value;
  return out;
}

/// A directory with the problem or a file it names in it is none to simulate into.
void keep_inputs(const Problem& problem, const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> inputs{problem.path}, outputs{"problem.toml"};
  for (const ProfileEntry& entry : problem.profiles) {
    inputs.push_back(entry.source.path);
    outputs.emplace_back(entry.profile.name + ".csv");
  }
  for (const std::filesystem::path& path : problem.beside) {
    inputs.push_back(path);
    outputs.push_back(path.filename());
  }
  for (const std::filesystem::path& name : outputs)
    for (const std::filesystem::path& input : inputs) {
      std::error_code ignored;
      if (std::filesystem::equivalent(input, directory / name, ignored))
        throw UsageError((directory / name).string() +
                         ": is an input, which would be lost; accepted: another directory");
    }
}

std::string table_of(const Profile& profile) {
  const bool slope = profile.setup.quantity == Quantity::slope;
  const ReadingTimes* times = profile.setup.reading_times.get();
  std::string text = slope ? "x_mm,slope_urad" : "x_mm,z_um";
  text += times ? ",t_s\n" : "\n";
  text.reserve(40 * profile.values.size());
  for (std::size_t i = 0; i < profile.values.size(); ++i) {
    text += shortest(profile.positions[i]);
    text += ',';
    text += significant(slope ? profile.values[i] * 1e6 : profile.values[i] / kMicrometre, 12);
    if (times) text += ',' + shortest(times->at(profile.positions[i]));
    text += '\n';
  }
  return text;
}

/// The files a problem names beside its profiles, put beside the simulated ones.
void copy_beside(const Problem& problem, const std::filesystem::path& directory) {
  std::vector<std::string> taken{"problem.toml"};
  for (const ProfileEntry& entry : problem.profiles) taken.push_back(entry.profile.name + ".csv");
  for (const std::filesystem::path& path : problem.beside) {
    const std::string name = path.filename().string();
    if (std::ranges::count(taken, name) > 0)
      throw UsageError(path.string() +
                       ": another file that is written has its name; accepted: "
                       "files with names of their own");
    taken.push_back(name);
    write_file(directory / name, std::string(FileBytes::of_regular_file(path).text()));
  }
}

}  // namespace

std::vector<Profile> simulate(const Problem& problem) {
  if (!problem.truth)
    throw UsageError(problem.path.string() +
                     ": no [truth]; simulate needs the parameters to simulate");
  std::vector<Profile> profiles = empty_profiles(problem);
  std::vector<Profile> frame = profiles;
  for (Profile& profile : frame)
    profile.low_band = LowBandOptions{.level = 0};  // effects are wanted here
  Model model = build_model(problem, frame);
  std::vector<std::map<std::string, double>> values;
  for (const ModelTerm& term : model.terms)
    values.push_back(parameters_of(*problem.truth, term.name));
  for (const Truth::HiddenEffect& hidden : problem.truth->effects) {
    append_term(model, {hidden.name, hidden.options, {}}, model.range);
    values.push_back(hidden.parameters);
  }
  Estimate truth{Eigen::VectorXd(model.amplitudes()), Eigen::VectorXd(model.shapes()), {}, {}};
  std::vector<Eigen::VectorXd> inner;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const ModelTerm& term = model.terms[i];
    inner.push_back(inner_of(term, values[i]));
    truth.amplitudes.segment(term.first_amplitude, term.effect->amplitudes()) =
        inner.back().head(term.effect->amplitudes());
    truth.shapes.segment(term.first_shape, std::ssize(term.effect->shapes())) =
        inner.back().tail(std::ssize(term.effect->shapes()));
  }
  model.range.face_slope = face_slope(model, truth);
  follow_face(model);
  for (std::size_t i = 0; i < inner.size(); ++i)
    add_effect(model, model.terms[i], inner[i], profiles);
  for (Profile& profile : profiles) {
    add_noise(*problem.truth, profile);
    if (std::ranges::any_of(profile.values, [](double each) { return !std::isfinite(each); }))
      throw UsageError(problem.path.string() + ": [truth] makes values of profile '" +
                       profile.name +
                       "' that are no finite numbers; accepted: smaller parameters and noise_um");
  }
  return profiles;
}

void write_simulation(const Problem& problem, const std::filesystem::path& directory) {
  keep_inputs(problem, directory);
  const std::vector<Profile> profiles = simulate(problem);
  make_directory(directory);
  copy_beside(problem, directory);
  std::vector<std::string> files;
  for (const Profile& profile : profiles) {
    files.push_back(profile.name + ".csv");
    write_file(directory / files.back(), table_of(profile));
  }
  write_file(directory / "problem.toml", simulated_problem_text(problem, files));
}

}  // namespace slideway
