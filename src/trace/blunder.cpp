#include "blunder.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "blunder_hypotheses.hpp"
#include "prediction.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/agreement.hpp"
#include "slideway/identify/left_out.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/noise_model.hpp"
#include "slideway/identify/subset_estimate.hpp"

namespace slideway {
namespace {

constexpr int kHalvings = 6;  // of the step in which the best start of a cut is moved

Profile multiplied(Profile profile, double factor) {
  for (double& value : profile.values) value *= factor;
  return profile;
}

/// Most likely first, those within Gates::tie_bic of it.
std::vector<Blunder> likeliest(std::vector<Blunder> found, const Gates& gates) {
  std::ranges::stable_sort(found, {}, &Blunder::delta_bic);
  std::erase_if(found, [&](const Blunder& each) {
    return each.delta_bic > found.front().delta_bic + gates.tie_bic;
  });
  return found;
}

/// Repeats say by themselves which of them is wrong, whatever the model makes of it: a curve
/// follows the one that was recorded in too large a unit, and takes the others for noise.
std::vector<Blunder> among_repeats(const Linearisation& linear, const Gates& gates) {
  std::vector<double> factors;
  for (const auto& [kind, factor] : kFactors) factors.push_back(factor);
  std::vector<Blunder> out;
  for (const ScaledRepeat& each : scaled_repeats(linear, factors, gates)) {
    const Profile& profile = *linear.observations[each.profile]->profile;
    const BlunderKind kind = kFactors[each.factor].first;
    if (is_possible(kind, profile.setup))
      out.push_back({profile.name, kind, each.delta_bic, each.left});
  }
  return likeliest(std::move(out), gates);
}

class Finder {
 public:
  explicit Finder(const FittedModel& fitted)
      : model_(fitted.model),
        fit_(fitted.fit),
        noise_(noise_of_each(fitted.fit.linear, fitted.fit.noise, fitted.model.gates)),
        in_long_run_(long_run_deviations(noise_)),
        compressed_(compress(fitted.fit.linear, alike())) {}

  [[nodiscard]] std::vector<Blunder> find() const {
    std::vector<std::vector<Blunder>> of_each(noise_.size());
    parallel_for(noise_.size(), [&](std::size_t i) {
      try_profile(i, hypotheses_of(i), [&](const Blunder& each, const BlunderHypothesis&) {
        if (each.left <= model_.gates.blunder_left) of_each[i].push_back(each);
      });
    });
    std::vector<Blunder> out;
    for (const std::vector<Blunder>& each : of_each)
      out.insert(out.end(), each.begin(), each.end());
    if (noise_.size() > 2) return likeliest(std::move(out), model_.gates);
    std::ranges::stable_sort(out, {}, &Blunder::delta_bic);
    return out;  // two that disagree do not say which of them is wrong
  }

  [[nodiscard]] std::vector<CorrectedBlunder> find_in(const std::string& profile) const {
    std::vector<CorrectedBlunder> out;
    for (std::size_t i = 0; i < noise_.size(); ++i) {
      const Profile& own = *fit_.linear.observations[i]->profile;
      if (own.name != profile) continue;
      std::vector<BlunderHypothesis> list = hypotheses_of(i);
      std::erase_if(list, [](const BlunderHypothesis& each) { return is_of_positions(each.kind); });
      std::optional<CorrectedBlunder> start;
      const auto tell = [&](const Blunder& each, const BlunderHypothesis& by) {
        if (each.what == BlunderKind::clock) {  // it may come nearer once it is moved
          if (!start || each.delta_bic < start->blunder.delta_bic) start = {each, *by.profile};
        } else if (each.left <= model_.gates.blunder_left) {
          out.push_back({each, by.profile ? *by.profile : multiplied(own, by.factor), by.factor});
        }
      };
      try_profile(i, list, tell);
      if (!start) continue;
      double step = 0.5 * (start->meant.setup.start_s - own.setup.start_s);
      for (int halving = 0; halving < kHalvings; ++halving, step *= 0.5) {
        Profile earlier = start->meant, later = start->meant;
        earlier.setup.start_s -= step;
        later.setup.start_s += step;
        try_profile(i, {{BlunderKind::clock, 1.0, earlier}, {BlunderKind::clock, 1.0, later}},
                    tell);
      }
      if (start->blunder.left <= model_.gates.blunder_left) out.push_back(*std::move(start));
    }
    keep_unit(out);
    return out;
  }

 private:
  /// Another unit alone, where it is likelier than all else: only that changes the noise.
  void keep_unit(std::vector<CorrectedBlunder>& found) const {
    const auto cost = [](const CorrectedBlunder& each) { return each.blunder.delta_bic; };
    const auto best = std::ranges::min_element(found, {}, cost);
    if (best == found.end() || std::abs(best->factor) == 1.0) return;
    const double most = cost(*best) + model_.gates.tie_bic;
    std::erase_if(found, [&](const CorrectedBlunder& each) { return cost(each) > most; });
  }

  [[nodiscard]] std::vector<BlunderHypothesis> hypotheses_of(std::size_t i) const {
    const Profile& profile = *fit_.linear.observations[i]->profile;
    const bool is_reversal =
        std::ranges::any_of(fit_.linear.observations, [&](const Observation* each) {
          return each->profile->setup.kind == Kind::slide &&
                 each->profile->setup.reversed != profile.setup.reversed;
        });
    return hypotheses(profile, other_lengths(i), is_reversal);
  }

  [[nodiscard]] static std::vector<double> long_run_deviations(const std::vector<Noise>& noise) {
    std::vector<double> out;
    std::ranges::transform(noise, std::back_inserter(out), &Noise::long_run_deviation);
    return out;
  }

  /// The profile most like this one: of its sisters the one whose noise is the middle in the long
  /// run.
  [[nodiscard]] std::optional<std::size_t> sister(std::size_t i) const {
    const auto key = [&](std::size_t j) {
      const Setup& setup = fit_.linear.observations[j]->profile->setup;
      return std::tuple(setup.kind, setup.quantity, setup.base_mm);
    };
    std::vector<std::size_t> sisters;
    for (std::size_t j = 0; j < noise_.size(); ++j)
      if (j != i && key(j) == key(i)) sisters.push_back(j);
    if (sisters.empty()) return std::nullopt;
    std::ranges::stable_sort(sisters, {}, [&](std::size_t j) { return in_long_run_[j]; });
    return sisters[(sisters.size() - 1) / 2];
  }

  /// Sisters weigh alike: one recorded in too large a unit would else outweigh all the others.
  [[nodiscard]] std::vector<Noise> alike() const {
    std::vector<Noise> out;
    for (std::size_t i = 0; i < noise_.size(); ++i) {
      const std::optional<std::size_t> other = sister(i);
      const bool smaller = other && in_long_run_[i] < in_long_run_[*other];
      out.push_back(noise_[smaller ? *other : i]);
    }
    return out;
  }

  /// Lengths of the other traces, mm.
  [[nodiscard]] std::vector<double> other_lengths(std::size_t i) const {
    std::vector<double> out;
    for (std::size_t j = 0; j < noise_.size(); ++j)
      if (j != i) out.push_back(length_of(*fit_.linear.observations[j]->profile));
    return out;
  }

  /// A profile's values as all its hypotheses are held against: where another unit is one of them,
  /// what lies at the spindle axis is left out by the positions in that unit.
  [[nodiscard]] Observation recorded(std::size_t i,
                                     const std::vector<BlunderHypothesis>& list) const {
    Observation out = *fit_.linear.observations[i];
    const Profile& own = *out.profile;
    const auto rescaled = std::ranges::find_if(list, [&](const BlunderHypothesis& each) {
      return each.profile && each.profile->positions != own.positions;
    });
    if (rescaled == list.end()) return out;
    out.profile = &*rescaled->profile;
    out.nuisances.conservativeResize(Eigen::NoChange, std::ssize(out.nuisance_names));
    leave_out(out, out.low_band.unmeasured());
    leave_out(out, values_at_axis(out, model_.machine));
    out.profile = &own;
    return out;
  }

  [[nodiscard]] ProfileTriangle triangle_of(const Observation& observation,
                                            const Noise& noise) const {
    return {observation, noise, linear_columns(model_, fit_.estimate, observation),
            observation.values};
  }

  [[nodiscard]] Expected expected_by(const SubsetEstimate& others) const {
    Expected out{others.change, others.basis, others.null_space};
    out.mean.head(model_.amplitudes()) += fit_.estimate.amplitudes;
    return out;
  }

  /// The same, where a profile is meant in a unit `factor` times as large: so is what its samples
  /// say of the effects that it alone has.
  [[nodiscard]] Expected in_unit(Expected expected, const std::string& profile,
                                 double factor) const {
    for (const ModelTerm& term : model_.terms) {
      if (!is_shown_by(term, profile)) continue;
      const auto count = std::ssize(term.priors);
      Eigen::VectorXd values(count), uncertainties(count);
      for (Eigen::Index k = 0; k < count; ++k) {
        const Prior& prior = term.priors[static_cast<std::size_t>(k)];
        const Eigen::Index p = parameter_index(term, prior.parameter);
        values[p] = prior.value;
        uncertainties[p] = prior.standard_uncertainty;
      }
      const auto own = [&](auto& all) { return all.middleRows(term.first_amplitude, count); };
      own(expected.mean) = factor * term.effect->from_parameters(values);
      own(expected.open).setZero();
      append_columns(expected.basis, Eigen::MatrixXd::Zero(expected.basis.rows(), count));
      own(expected.basis).rightCols(count) =
          (factor * term.effect->from_parameters(uncertainties)).asDiagonal();
    }
    return expected;
  }

  static bool is_of_one(const ModelTerm& term, const std::string& profile) {
    return term.profiles == std::vector<std::string>{profile};
  }

  /// Whether the samples of a profile say what the effect is, which it alone has.
  static bool is_shown_by(const ModelTerm& term, const std::string& profile) {
    return is_of_one(term, profile) && !term.priors.empty() &&
           std::ssize(term.priors) == term.effect->amplitudes();
  }

  /// The priors but those of effects of one profile.
  [[nodiscard]] Linearisation priors_beside(const std::string& profile) const {
    std::vector<Eigen::Index> kept;
    Eigen::Index row = 0;
    for (const ModelTerm& term : model_.terms)
      for (std::size_t k = 0; k < term.priors.size(); ++k, ++row)
        if (!is_of_one(term, profile)) kept.push_back(row);
    for (; row < fit_.linear.prior_rows.rows(); ++row) kept.push_back(row);
    Linearisation out;
    out.prior_rows = fit_.linear.prior_rows(kept, Eigen::all);
    out.prior_residuals = fit_.linear.prior_residuals(kept);
    return out;
  }

  /// Tells each hypothesis that lowers the BIC. In another unit the noise of a profile is like its
  /// sisters', or half as unlike, in ln, as it was recorded; that of its own fine band is enough.
  /// Where that was like its sisters' as recorded, the unit is right.
  template <typename Told>
  void try_profile(std::size_t i, const std::vector<BlunderHypothesis>& list,
                   const Told& tell) const {
    const Gates& gates = model_.gates;
    const std::optional<std::size_t> of_sister = sister(i);
    const Noise& noise = noise_[of_sister.value_or(i)];
    const double factor = of_sister ? gates.sister_factor : kAnyFactor;
    std::vector<std::size_t> all_but_it;
    for (std::size_t j = 0; j < noise_.size(); ++j)
      if (j != i) all_but_it.push_back(j);
    const Profile& profile = *fit_.linear.observations[i]->profile;
    if (is_a_surface_alone(profile)) return;
    const Expected expected =
        expected_by({priors_beside(profile.name), compressed_, all_but_it, gates.rank_tolerance});
    if (expected.basis.cols() == 0) return;
    Observation observation = recorded(i, list);
    const ProfileTriangle triangle = triangle_of(observation, noise);
    const auto count = static_cast<double>(observation.values.size() - observation.left_out());
    const AsItIs in_another_setup({triangle, expected, count});
    const bool shows_own = std::ranges::any_of(
        model_.terms, [&](const ModelTerm& term) { return is_shown_by(term, profile.name); });
    const auto in = [&](double unit) {
      return shows_own ? Prediction(triangle, in_unit(expected, profile.name, unit), count)
                       : in_another_setup.prediction;
    };
    const AsItIs in_another_unit = shows_own ? AsItIs(in(1.0)) : in_another_setup;
    const double own = in_long_run_[i] / in_long_run_[of_sister.value_or(i)];
    for (const BlunderHypothesis& each : list) {
      observation.profile = each.profile ? &*each.profile : &profile;
      const AsItIs& as_it_is = each.profile ? in_another_setup : in_another_unit;
      const Prediction meant = each.profile
                                   ? Prediction(triangle_of(observation, noise), expected, count)
                                   : in(each.factor);
      const auto [before, size_before] = as_it_is.best;
      const auto [after, size] = meant.best(each.factor, factor);
      if (as_it_is.prediction.directions() == 0 || after > before - gates.blunder_bic) continue;
      const bool is_like_sisters =
          std::abs(std::log(size)) <=
              std::max(2.0 * std::log(factor), 0.5 * std::log(size_before)) ||
          std::abs(std::log(std::abs(each.factor) * own)) <= 2.0 * std::log(factor);
      const bool was_like_sisters = std::abs(std::log(own)) <= 2.0 * std::log(factor);
      if (std::abs(each.factor) != 1.0 && (was_like_sisters || !is_like_sisters)) continue;
      tell({profile.name, each.kind, after - before,
            meant.disagreement(each.factor) / as_it_is.prediction.disagreement(1.0)},
           each);
    }
  }

  /// Whether a reading along the slide is the only one of its declared surface: no other needs to
  /// agree with it.
  [[nodiscard]] bool is_a_surface_alone(const Profile& profile) const {
    return profile.setup.kind == Kind::slide && profile.surface &&
           std::ranges::none_of(fit_.linear.observations, [&](const Observation* each) {
             const Profile& other = *each->profile;
             return &other != &profile && (!other.surface || other.surface == profile.surface);
           });
  }

  static constexpr double kAnyFactor = 1e3;  // between noises of unlike profiles

  struct AsItIs {
    Prediction prediction;
    Prediction::Best best;
    explicit AsItIs(Prediction of)
        : prediction(std::move(of)), best(prediction.best(1.0, kAnyFactor)) {}
  };

  const Model& model_;
  const Solution& fit_;
  std::vector<Noise> noise_;
  std::vector<double> in_long_run_;  // deviations of the noises
  Compressed compressed_;
};

}  // namespace

std::vector<Blunder> find_blunders(const FittedModel& fitted) {
  const Linearisation& linear = fitted.fit.linear;
  if (linear.observations.size() < 2 || linear.prior_rows.cols() == 0) return {};
  std::vector<Blunder> out = among_repeats(linear, fitted.model.gates);
  return out.empty() ? Finder(fitted).find() : out;
}

std::vector<CorrectedBlunder> find_blunders_in(const FittedModel& fitted,
                                               const std::string& profile) {
  return Finder(fitted).find_in(profile);
}

std::string blunder_advice(const std::vector<Blunder>& blunders) {
  std::vector<std::string> parts;
  for (const Blunder& each : blunders)
    parts.push_back("profile " + each.profile + ": " + std::string(text_of(each.what)));
  return joined(parts, ", or ") +
         "; correct it and run again: the profiles then agree (difference " + "in BIC " +
         significant(-blunders.front().delta_bic, 2) + ")";
}

}  // namespace slideway
