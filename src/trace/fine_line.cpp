#include "fine_line.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/text.hpp"
#include "slideway/signal/spectrum.hpp"
#include "slideway/signal/view.hpp"

namespace slideway {
namespace {

constexpr double kEven = 0.01;      // of a distance
constexpr std::size_t kFewest = 8;  // ordinates that tell the level of a spectrum

bool is_even(const std::vector<double>& positions) {
  const double step =
      (positions.back() - positions.front()) / static_cast<double>(positions.size() - 1);
  return std::ranges::adjacent_find(positions, [&](double a, double b) {
           return std::abs(b - a - step) > kEven * step;
         }) == positions.end();
}

/// Of one reading.
std::optional<FineLine> line_of(const Observation& observation, Eigen::VectorXd residual,
                                const Noise& noise, const Gates& gates) {
  const Profile& profile = *observation.profile;
  const auto n = static_cast<double>(residual.size());
  if (profile.setup.kind != Kind::slide || observation.low_band.options().level > 0 ||
      observation.low_band.resampled() || profile.positions.size() < 2 ||
      !is_even(profile.positions))
    return std::nullopt;
  noise.whiten(residual);
  const std::vector<double> whole = power_spectrum(view(residual));
  const auto first = static_cast<std::size_t>(n / gates.values_per_cycle) + 1;
  if (whole.size() < first + kFewest) return std::nullopt;
  const std::size_t last = residual.size() % 2 == 0 ? whole.size() - 1 : whole.size();  // a half
  const std::span<const double> fine = std::span(whole).subspan(first, last - first);
  double sum = 0.0, pair = 0.0, cycles = 0.0;
  for (std::size_t k = 0; k < fine.size(); ++k) {
    sum += fine[k];
    if (k == 0 || fine[k - 1] + fine[k] <= pair) continue;
    pair = fine[k - 1] + fine[k];
    cycles = static_cast<double>(first + k) - fine[k - 1] / pair;
  }
  if (!(sum > gates.lack_of_fit_ratio * (sum - pair))) return std::nullopt;
  const auto m = static_cast<double>(fine.size());
  const double share = std::min(pair / sum, 1.0), rest = 1.0 - share;
  const double p_value = (m - 1.0) * std::pow(rest, m - 2.0) * (rest + (m - 1.0) * share);
  const double length = (profile.positions.back() - profile.positions.front()) * n / (n - 1.0);
  return FineLine{&profile, length / cycles, std::min(1.0, p_value)};
}

}  // namespace

std::optional<FineLine> fine_line(const Linearisation& linear, const std::vector<Noise>& noise,
                                  const Gates& gates) {
  std::optional<FineLine> out;
  for (std::size_t i = 0; i < linear.observations.size(); ++i)
    if (const auto own = line_of(*linear.observations[i], linear.residuals[i], noise[i], gates);
        own && (!out || own->p_value < out->p_value))
      out = own;
  if (!out) return out;
  out->p_value = std::min(1.0, out->p_value * static_cast<double>(linear.observations.size()));
  return out->p_value < gates.lack_of_fit_p ? out : std::nullopt;
}

std::string fine_line_advice(const FineLine& line) {
  return "profile " + line.profile->name + " has a wave of " + significant(line.period_mm, 3) +
         " mm, with too few readings a cycle to tell it from the image of a finer one: read it "
         "again at half the distance";
}

}  // namespace slideway
