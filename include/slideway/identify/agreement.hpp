#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// The same quantity from each of two fitted profiles, for every effect that either determines by
/// itself; of more than eight profiles, from each and from all others together.
///
/// Each profile is fitted alone under the noise it has alone, levelling free, shapes as the
/// joint fit has them. An effect is compared as a curve: straightness as the deviation from the
/// line through the ends of the common travel, others in the low band of the first profile. E_n is
/// the largest |difference| / sqrt(U_a² + U_b²) along it, with U such that all comparisons of the
/// report hold together (Gates::false_disagreement): Šidák's share for each, and for a curve the
/// quantile of its largest standardised deviation by the tube formula (Sun and Loader 1994).
/// `p_value`: χ² of the data of the pair over all effects, near a gamma variable as in LackOfFit.
/// Of three profiles or more, that of all at once is a comparison, too: its E_n is
/// sqrt(χ² / its quantile).
/// @param of_each  noise_of_each() fitted profile
std::vector<ProfileCheck> check_profiles(const Model& model, const Solution& fit,
                                         const std::vector<Noise>& of_each);

/// The profile that is in every one of some pairs of ProfileCheck::profiles; "" where none is, or
/// two.
std::string odd_profile(std::set<std::vector<std::string>> pairs);

/// Square root of the covariance of (amplitudes, shapes) that the estimates without one profile
/// each show (delete-one jackknife): a column each.
Eigen::MatrixXd scatter_of_profiles(const Solution& fit, const Gates& gates);

/// One of three repeats or more that is unlike the others.
struct OddRepeat {
  std::size_t profile = 0;  // index of the fitted one
  double p_value = 1.0;     // that noise makes any of the group differ as much
};

/// Repeats whose difference from the others of their group is larger than those' differences from
/// one another, in the slow band, with a probability by chance below Gates::disagreement_p. No
/// model of the noise is asked: the others show it.
std::vector<OddRepeat> odd_repeats(const Linearisation& linear, const Gates& gates);

/// Probability that noise makes a profile differ as much from those that repeat it, as in
/// odd_repeats(); 1 where fewer than two do.
double probability_beside_repeats(const Linearisation& linear, std::size_t profile,
                                  const Gates& gates);

/// One of three repeats or more that agrees with the others where its values are multiplied.
struct ScaledRepeat {
  std::size_t profile = 0;  // index of the fitted one
  std::size_t factor = 0;   // index
  double delta_bic = 0.0;   // against a noise of its own size
  double left = 0.0;        // of the square of its difference from the others
};

/// Those that pass Gates::blunder_bic and Gates::blunder_left. No model is asked: the others show
/// what each should read.
std::vector<ScaledRepeat> scaled_repeats(const Linearisation& linear,
                                         std::span<const double> factors, const Gates& gates);

/// What the repeats of each group have in common and the model lacks; not the odd ones.
///
/// Texture repeats; it may have several lengths, up to Gates::longest_texture. The mean residual of
/// a group has the largest, in the long run, of three noises: that of its own fine band, that of
/// the fine bands of all groups, and that of the deviations from it. Its slow band is tested
/// against that as lack_of_fit() does. F is the square found over the square expected.
std::vector<PureErrorCheck> check_repeats(const Linearisation& linear, const Gates& gates);

/// Whether the priors contradict the profiles or one another, in words: χ² of how far each lies
/// from what all else says (residual r, variance 1 - h with the leverage h, in its own unit). None
/// where they do not, with 99 %, or nothing else tells of them.
std::optional<std::string> conflict_of_priors(const Model& model, const Solution& fit);

}  // namespace slideway
