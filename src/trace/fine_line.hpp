#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// A wave of a reading along the slide with fewer than Gates::values_per_cycle readings a cycle: it
/// may be the image of one that is finer still.
struct FineLine {
  const Profile* profile = nullptr;
  double period_mm = 0.0;
  double p_value = 1.0;  // that noise makes one as strong in any of the readings
};

/// The one that noise makes with the smallest probability, if that is below Gates::lack_of_fit_p
/// and what is so fine has more than Gates::lack_of_fit_ratio times the square that it has beside.
/// Asked of readings without a low band at even distances, for it takes such a wave off, or the
/// samples show it. The residual is white; of m ordinates of its periodogram, the two neighbours
/// that hold most, for a wave may lie between them, have the share g of the sum of all or more with
/// the probability (m - 1) (1 - g)^(m - 2) (1 - g + (m - 1) g) at most (Fisher 1929 has it of one).
/// @param noise  per fitted observation
std::optional<FineLine> fine_line(const Linearisation& linear, const std::vector<Noise>& noise,
                                  const Gates& gates);

/// What to do about it, in a sentence.
std::string fine_line_advice(const FineLine& line);

}  // namespace slideway
