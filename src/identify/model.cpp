#include "slideway/identify/model.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/other_level.hpp"
#include "slideway/signal/low_band_parts.hpp"

namespace slideway {
namespace {

// The samples between which the slide coordinate of all others lies: the ends of the trace and the
// two next to the spindle axis.
std::array<Eigen::Index, 4> extreme_samples(const Profile& profile) {
  const std::vector<double>& s = profile.positions;
  const Eigen::Index last = std::ssize(s) - 1;
  const Eigen::Index axis = std::ranges::lower_bound(s, profile.setup.center_mm) - s.begin();
  return {0, std::clamp<Eigen::Index>(axis - 1, 0, last), std::min(axis, last), last};
}

}  // namespace

bool ModelTerm::acts_on(const Profile& profile) const {
  return (profiles.empty() || std::ranges::count(profiles, profile.name) > 0) &&
         effect->applies_to(profile.setup);
}

std::string term_name(const std::string& effect, const std::vector<std::string>& profiles) {
  return profiles.empty() ? effect : effect + "[" + joined(profiles, ",") + "]";
}

std::vector<EffectOptions> of_each_instrument(const EffectOptions& options,
                                              const std::vector<const Profile*>& profiles) {
  const std::vector<std::vector<std::string>> instruments = by_instrument(profiles);
  if (instruments.size() < 2) return {options};
  std::vector<EffectOptions> out(instruments.size(), options);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].profiles = instruments[i];
  return out;
}

SlideRange slide_range(const Profile& profile, const Machine& machine) {
  const Stations stations = profile.stations(machine);
  SlideRange range{INFINITY, -INFINITY};
  for (const Eigen::Index i : extreme_samples(profile)) {
    range.least = std::min(range.least, stations.slide(i));
    range.greatest = std::max(range.greatest, stations.slide(i));
  }
  return range;
}

SlideRange measured_travel(const Model& model, const ModelTerm* term) {
  SlideRange out{INFINITY, -INFINITY};
  for (const Observation& observation : model.observations) {
    const Profile& profile = *observation.profile;
    if (profile.role != Role::fit || (term && !term->acts_on(profile))) continue;
    const SlideRange own = slide_range(profile, model.machine);
    const double foot = profile.setup.base_mm.value_or(0.0) / 2.0;
    out.least = std::min(out.least, own.least - foot);
    out.greatest = std::max(out.greatest, own.greatest + foot);
  }
  return out;
}

std::vector<Eigen::Index> left_out_values(const Observation& observation) {
  std::vector<Eigen::Index> out;
  for (Eigen::Index j = std::ssize(observation.nuisance_names); j < observation.nuisances.cols();
       ++j) {
    out.emplace_back();
    observation.nuisances.col(j).maxCoeff(&out.back());
  }
  std::ranges::sort(out);
  return out;
}

bool leave_out(Observation& observation, const std::vector<Eigen::Index>& values) {
  std::vector<Eigen::Index> fresh;
  std::ranges::set_difference(values, left_out_values(observation), std::back_inserter(fresh));
  Eigen::MatrixXd& nuisances = observation.nuisances;
  const Eigen::Index known = nuisances.cols();
  nuisances.conservativeResize(observation.values.size(), known + std::ssize(fresh));
  nuisances.rightCols(std::ssize(fresh)).setZero();
  for (std::size_t j = 0; j < fresh.size(); ++j)
    nuisances(fresh[j], known + static_cast<Eigen::Index>(j)) = 1.0;
  return !fresh.empty();
}

namespace {

TravelRange travel_range(const std::vector<Profile>& profiles, const Machine& machine) {
  TravelRange range{INFINITY, -INFINITY, INFINITY, -INFINITY};
  for (const Profile& profile : profiles) {
    const SlideRange own = slide_range(profile, machine);
    const double foot = profile.setup.base_mm.value_or(0.0) / 2.0;  // beyond the centre of a bridge
    range.slide_min = std::min(range.slide_min, own.least - foot);
    range.slide_max = std::max(range.slide_max, own.greatest + foot);
    range.coarsest_feed_mm =
        std::max(range.coarsest_feed_mm, profile.setup.feed_per_revolution().value_or(0.0));
    range.z_min = std::min(range.z_min, profile.setup.z_mm);
    range.z_max = std::max(range.z_max, profile.setup.z_mm);
    if (!profile.setup.reading_times) continue;
    const auto [first, last] = std::ranges::minmax(profile.setup.reading_times->times_s);
    range.read.push_back({profile.name, first, last});
  }
  return range;
}

/// Offset and tilt of the trace. A slope reading knows no offset of height, and a tilt of the line
/// is the zero of the reading: one constant column.
Eigen::MatrixXd nuisance_columns(const Profile& profile, const LowBand& low_band,
                                 std::vector<std::string>& names) {
  const auto n = static_cast<Eigen::Index>(profile.positions.size());
  const bool slope = profile.setup.quantity == Quantity::slope;
  if (slope ? (profile.free_offset || profile.free_tilt) : profile.free_offset)
    names.emplace_back(slope ? "zero" : "offset");
  if (!slope && profile.free_tilt) names.emplace_back("tilt");
  const double middle = 0.5 * (profile.setup.first_mm + profile.setup.last_mm);
  const auto fill = [&](Eigen::Index first, Eigen::Ref<Eigen::MatrixXd> rows) {
    const Eigen::Map<const Eigen::ArrayXd> s(profile.positions.data() + first, rows.rows());
    for (Eigen::Index j = 0; j < rows.cols(); ++j) {
      if (names[static_cast<std::size_t>(j)] == "tilt")
        rows.col(j) = s - middle;
      else
        rows.col(j).setOnes();
    }
  };
  return apply_in_parts(low_band, n, std::ssize(names), fill);
}

Observation observe(const Profile& profile, const LowBandOptions& options,
                    std::size_t most_values) {
  LowBand low_band(with_at_most(options, profile.positions.size(), most_values), profile.positions);
  if (std::ssize(low_band.unmeasured()) == low_band.values())
    throw DataError("low band: " + std::to_string(profile.positions.size()) + " samples, " +
                    options.wavelet + " at level " + std::to_string(low_band.options().level) +
                    " leave no value inside the trace; accepted: a lower level, a shorter wavelet "
                    "or more samples");
  const auto fill = [&](Eigen::Index first, Eigen::Ref<Eigen::MatrixXd> rows) {
    rows = Eigen::Map<const Eigen::VectorXd>(profile.values.data() + first, rows.rows());
  };
  Eigen::VectorXd values = apply_in_parts(low_band, std::ssize(profile.values), 1, fill);
  Observation out{&profile, std::move(low_band), std::move(values), {}, {}};
  out.nuisances = nuisance_columns(profile, out.low_band, out.nuisance_names);
  leave_out(out, out.low_band.unmeasured());
  return out;
}

/// Left out there if it stands where a value of the other level is left out.
void leave_out_where(const Observation& other, Observation& observation) {
  const std::vector<double>& samples = observation.profile->positions;
  const std::vector<double> known = other.low_band.positions(samples),
                            places = observation.low_band.positions(samples);
  const double reach = 0.5 * (samples.back() - samples.front()) /
                       static_cast<double>(std::min(known.size(), places.size()));
  std::vector<Eigen::Index> gone;
  for (const Eigen::Index left : left_out_values(other))
    for (Eigen::Index i = 0; i < std::ssize(places); ++i)
      if (std::abs(places[static_cast<std::size_t>(i)] - known[static_cast<std::size_t>(left)]) <
          reach)
        gone.push_back(i);
  std::ranges::sort(gone);
  gone.erase(std::unique(gone.begin(), gone.end()), gone.end());
  leave_out(observation, gone);
}

}  // namespace

std::optional<Model> at_other_level(const Model& model, int by, Eigen::Index least) {
  Model out = model;
  for (Observation& observation : out.observations) {
    LowBandOptions options = observation.low_band.options();
    options.level += by;
    const std::size_t samples = observation.profile->positions.size();
    if (options.level < 0 || (samples >> options.level) < static_cast<std::size_t>(least))
      return std::nullopt;
    Observation other = observe(*observation.profile, options, samples);
    leave_out_where(observation, other);
    observation = std::move(other);
  }
  return out;
}

Eigen::MatrixXd levelled(const Observation& observation, Eigen::MatrixXd columns) {
  const Eigen::Index named = std::ssize(observation.nuisance_names);
  Eigen::MatrixXd free(columns.rows(), named + 1);
  free.leftCols(named) = observation.nuisances.leftCols(named);
  free.col(named).setOnes();
  for (Eigen::Index j = named; j < observation.nuisances.cols(); ++j)
    for (Eigen::Index i = 0; i < columns.rows(); ++i)
      if (observation.nuisances(i, j) != 0.0) free.row(i).setZero(), columns.row(i).setZero();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(free);
  const Eigen::MatrixXd basis =
      qr.householderQ() * Eigen::MatrixXd::Identity(free.rows(), qr.rank());
  columns -= basis * (basis.transpose() * columns);
  return columns;
}

namespace {

void require_metadata(const ModelTerm& term, const Profile& profile) {
  if (!term.acts_on(profile)) return;
  const std::vector<std::string> lacking = term.effect->lacking(profile.setup);
  if (!lacking.empty())
    throw UsageError("effect '" + term.name + "' needs " + joined(lacking) + " of profile '" +
                     profile.name + "'");
}

/// Refuses an effect of the user's own that no profile can have.
void require_profile(const Model& model, const DeclaredEffect& declared, const ModelTerm& term) {
  if (!declared.options.own || std::ranges::any_of(model.observations, [&](const auto& each) {
        return term.acts_on(*each.profile) && term.effect->applies_to(each.profile->setup);
      }))
    return;
  throw UsageError(
      "effect '" + term.name +
      "' is in no profile; accepted: a size in um for heights, in urad for slopes, and "
      "variables that the profiles have");
}

/// Of a profile that lacks metadata, or that does not show the effect, nothing is known.
void require_columns(const Model& model, const ModelTerm& term, const Profile& profile) {
  if (!term.acts_on(profile) || !term.effect->lacking(profile.setup).empty()) return;
  const std::string fault = term.effect->fault(profile.stations(model.machine));
  if (!fault.empty())
    throw UsageError("profile '" + profile.name + "': effect '" + term.name + "': " + fault);
}

/// Refuses declared effects and candidates that are not finite on a profile, and candidates that no
/// profile can have of those they name: others may be a shop's, for other problems.
void require_columns(const Model& model, const std::vector<DeclaredEffect>& candidates) {
  std::vector<ModelTerm> terms = model.terms;
  for (const DeclaredEffect& own : candidates) {
    ModelTerm& term = terms.emplace_back();
    term.name = own.name;
    term.effect = make_effect(own.name, own.options, model.machine, model.range);
    term.profiles = own.options.profiles;
    if (!own.options.profiles.empty()) require_profile(model, own, term);
  }
  for (const ModelTerm& term : terms)
    for (const Observation& observation : model.observations)
      require_columns(model, term, *observation.profile);
}

}  // namespace

Eigen::Index Model::amplitudes() const {
  return terms.empty() ? 0 : terms.back().first_amplitude + terms.back().effect->amplitudes();
}

Eigen::Index Model::shapes() const {
  return terms.empty() ? 0
                       : terms.back().first_shape +
                             static_cast<Eigen::Index>(terms.back().effect->shapes().size());
}

Eigen::Index Model::parameters() const {
  return terms.empty() ? 0
                       : terms.back().first_parameter +
                             static_cast<Eigen::Index>(terms.back().effect->parameters().size());
}

std::vector<std::string> Model::parameter_names() const {
  std::vector<std::string> names;
  for (const ModelTerm& term : terms)
    for (const Parameter& parameter : term.effect->parameters())
      names.push_back(term.name + "." + parameter.name);
  return names;
}

const ModelTerm* Model::find_term(MotionError error) const {
  const auto found = std::ranges::find_if(
      terms, [&](const ModelTerm& term) { return term.effect->description().motion == error; });
  return found == terms.end() ? nullptr : &*found;
}

void append_term(Model& model, const DeclaredEffect& declared, const TravelRange& range) {
  ModelTerm term{term_name(declared.name, declared.options.profiles),
                 make_effect(declared.name, declared.options, model.machine, range),
                 declared.priors,
                 model.amplitudes(),
                 model.shapes(),
                 model.parameters(),
                 declared.options.profiles};
  const bool taken = std::any_of(model.terms.begin(), model.terms.end(),
                                 [&](const ModelTerm& other) { return other.name == term.name; });
  if (taken) term.name.append("[").append(declared.options.body.value_or("")).append("]");
  for (const Observation& observation : model.observations)
    require_metadata(term, *observation.profile);
  require_profile(model, declared, term);
  model.terms.push_back(std::move(term));
}

void remake_term(Model& model, const std::string& name, const EffectOptions& options) {
  const auto term = std::find_if(model.terms.begin(), model.terms.end(),
                                 [&](const ModelTerm& each) { return each.name == name; });
  const std::string& effect = term->effect->description().name;
  term->effect = make_effect(effect, options, model.machine, model.range);
  for (auto next = std::next(term); next != model.terms.end(); ++next) {
    const ModelTerm& before = *std::prev(next);
    next->first_shape = before.first_shape + std::ssize(before.effect->shapes());
    next->first_amplitude = before.first_amplitude + before.effect->amplitudes();
    next->first_parameter = before.first_parameter + std::ssize(before.effect->parameters());
  }
}

Model build_model(const Problem& problem, const std::vector<Profile>& profiles,
                  std::size_t most_values) {
  Model model{
      problem.machine(), travel_range(profiles, problem.machine()), {}, {}, problem.trace.gates};
  model.range.beam_span_mm = problem.beam_span_mm;
  for (const Profile& profile : profiles) {
    try {
      model.observations.push_back(observe(profile, problem.low_band_of(profile), most_values));
    } catch (const DataError& error) {
      throw DataError("profile '" + profile.name + "': " + error.what());
    }
  }
  for (const DeclaredEffect& declared : problem.effects) append_term(model, declared, model.range);
  require_columns(model, problem.trace.own);
  return model;
}

}  // namespace slideway
