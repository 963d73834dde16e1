#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace slideway {

enum class OutlierKind {
  spike,           // dust, a stylus that flew, a wrong digit
  lost_minus_sign  // the value fits its neighbours with the other sign
};

/// "spike", "lost minus sign"
std::string_view name(OutlierKind kind);

/// A sample that its neighbours on both sides contradict.
struct Outlier {
  std::size_t index = 0;
  double value = 0.0;
  double expected = 0.0;  // on the line between the nearest samples that are none
  double size = 0.0;      // |value - expected| in robust standard deviations of such a prediction
  OutlierKind kind = OutlierKind::spike;
};

/// Finds single samples, and runs of up to 32, that stand out of a profile; by index.
///
/// The profile itself and its means of 2, 4, 8 and 16 samples are predicted from their neighbours
/// on both sides, so that whatever correlates samples (form, waviness, noise of any spectrum) makes
/// the prediction's error smaller or the scale it is judged by larger. A sample is reported if
///   - its error is above what the largest of so many normal ones reaches in 1 of 1000 profiles,
///     in robust standard deviations (MAD) of all errors and of the nearest 32 on either side;
///   - the line from either side alone misses it alike: a step, or the ridge between two feed
///     marks, is foretold by one of them;
///   - few others (4, or 1 in 1000 samples; 3 in short profiles) are even half as large: what
///     recurs is structure.
/// Fewer than 64 samples are held against second differences, with a larger limit for so few.
///
/// Not judged: fewer than 10 samples, the two at either end, what lies beside a gap. REQUIRES
/// positions that strictly increase, as many as values; finite numbers. Units: any.
std::vector<Outlier> find_outliers(std::span<const double> positions,
                                   std::span<const double> values);

}  // namespace slideway
