#pragma once

#include <optional>
#include <span>

#include "refine.hpp"

namespace slideway {

/// The lowest harmonic of the feed marks that sampling folds to a line of so many cycles along a
/// trace, nearer than the gate folded_widths; none does, or the feed is not known.
/// @param samples_a_value  1 of the samples; of a low band how many each of its values stands for
std::optional<int> mark_at(const Profile& profile, double cycles, const Gates& gates,
                           double samples_a_value = 1.0);

/// What has folded a line to where it is: sampling, or the low band one that the samples have.
enum class Folding { by_sampling, by_low_band };

/// Whether an effect is a wave in a fitted profile: it makes lines.
bool is_wave(const Model& model, const ModelTerm& term, std::span<const double> shape);

/// What the line of an effect is of a line in the model instead of one of its own: "a modulation
/// of" it, where in every fitted profile all of its lines lie beside those of that effect, nearer
/// than the gates modulation_widths (in resolutions of the profile's spectrum, one cycle a profile)
/// and modulation_share (of the line's own rate); "a harmonic of" it, where it lies so beside
/// twice, three times, a half or a third of their rate: a wave that is no sine has them. Empty:
/// neither.
std::string part_of_a_line(const Model& model, const Eigen::VectorXd& shapes,
                           const Refined& refined);

/// Whether harmonics of the feed marks that can be as large are folded to where the lines of an
/// effect of faces are: in all of them but those that together do not show it for certain
/// (Gates::size). Not where one wave serves cuts of different feeds: their marks are of different
/// depths.
/// @param fitted  what the effect takes of the white residual
bool is_of_feed_marks(const Model& model, const Whitened& data, const Refined& refined,
                      const Eigen::VectorXd& fitted, Folding folding);

}  // namespace slideway
