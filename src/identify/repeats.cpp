#include "repeats.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>

#include "slideway/base/units.hpp"
#include "slideway/identify/agreement.hpp"
#include "slideway/identify/lack_of_fit.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/noise_model.hpp"
#include "slideway/identify/profile_bases.hpp"

namespace slideway {
namespace {

constexpr double kAsWritten = 1e-6;  // of a number that was typed in twice

double extent(const Observation& observation) {
  return observation.profile->setup.last_mm - observation.profile->setup.first_mm;
}

bool near(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }

bool near(const std::optional<double>& a, const std::optional<double>& b, double share) {
  if (!a || !b) return a.has_value() == b.has_value();
  return near(*a, *b, share * std::max(std::abs(*a), std::abs(*b)));
}

/// Whether two cuts are one, as far as the setups tell, lengths to a part of a station; wherever
/// they were traced.
bool is_one_cut(const Setup& s, const Setup& t, double length_mm) {
  return s.kind == t.kind && s.quantity == t.quantity && s.reversed == t.reversed &&
         near(s.base_mm, t.base_mm, kAsWritten) &&
         near(s.spindle_position_mm, t.spindle_position_mm, length_mm) &&
         near(s.z_mm, t.z_mm, length_mm) && near(s.overhang_mm, t.overhang_mm, length_mm) &&
         near(s.feed_mm_per_min, t.feed_mm_per_min, kAsWritten) &&
         near(s.spindle_rpm, t.spindle_rpm, kAsWritten) && s.cut_direction == t.cut_direction &&
         near(s.start_s, t.start_s, kAsWritten * std::max(1.0, std::abs(s.start_s)));
}

/// Whether two traces run along one line of the surface; where either does not say, they may.
bool is_one_line(const std::optional<Line>& a, const std::optional<Line>& b, double length_mm) {
  if (!a || !b) return true;
  for (std::size_t i = 0; i < 2; ++i)
    if (!near(a->from_mm[i], b->from_mm[i], length_mm) ||
        !near(a->to_mm[i], b->to_mm[i], length_mm))
      return false;
  return true;
}

}  // namespace

std::vector<double> stations_from_axis(const Observation& observation) {
  const Setup& setup = observation.profile->setup;
  std::vector<double> out = observation.low_band.positions(observation.profile->positions);
  if (setup.kind == Kind::face)
    for (double& each : out) each -= setup.center_mm;
  return out;
}

bool are_of_one_surface(const Observation& a, const Observation& b, const Gates& gates) {
  const double station = gates.same_place * extent(a) / static_cast<double>(a.values.size());
  return a.profile->surface == b.profile->surface &&
         is_one_cut(a.profile->setup, b.profile->setup, station);
}

namespace {

/// What another profile has at the stations matched to it, in rows; 0 at those it lacks.
Eigen::MatrixXd at_stations(const std::vector<Eigen::Index>& match, const Eigen::MatrixXd& values) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(std::ssize(match), values.cols());
  for (Eigen::Index row = 0; row < out.rows(); ++row)
    if (match[row] >= 0) out.row(row) = values.row(match[row]);
  return out;
}

/// Sum of the residuals of a group at the stations of one observation, and how many have each.
struct StationSums {
  Eigen::VectorXd sum, count;

  StationSums(const Linearisation& all, const std::vector<std::size_t>& group,
              const Observation& observation, const Gates& gates)
      : sum(Eigen::VectorXd::Zero(observation.values.size())), count(sum) {
    for (const std::size_t i : group) {
      const auto match = matched_values(observation, *all.observations[i], gates);
      sum += at_stations(match, all.residuals[i]);
      count += at_stations(match, Eigen::VectorXd::Ones(all.residuals[i].size()));
    }
  }
  [[nodiscard]] Eigen::VectorXd mean() const { return sum.cwiseQuotient(count); }
};

/// Mean of a group's residuals at the stations of its first profile, a trace of its own.
Linearisation common_trace(const Linearisation& all, const std::vector<std::size_t>& group,
                           const Gates& gates) {
  const Observation& first = *all.observations[group.front()];
  Linearisation out;
  out.observations = {&first};
  out.columns = {all.columns[group.front()]};
  out.residuals = {StationSums(all, group, first, gates).mean()};
  out.prior_rows.resize(0, all.prior_rows.cols());
  out.prior_residuals.resize(0);
  return out;
}

/// Of a slide, at so few stations that they tell no texture and may be all form.
bool is_of_few(const Observation& observation, const Gates& gates) {
  return observation.profile->setup.kind == Kind::slide &&
         static_cast<double>(observation.values.size()) < gates.values_for_memory;
}

/// Noise of the mean of each group: see check_repeats(). That of few stations is what repeats
/// differ by, alone.
std::vector<Noise> noises_of_means(const Linearisation& all,
                                   const std::vector<std::vector<std::size_t>>& groups,
                                   const std::vector<Linearisation>& common,
                                   const std::vector<OddRepeat>& odd, const Gates& gates) {
  Linearisation together = common.front();
  for (const Linearisation& each : std::span(common).subspan(1)) {
    together.observations.push_back(each.observations.front());
    together.columns.push_back(each.columns.front());
    together.residuals.push_back(each.residuals.front());
  }
  std::vector<Noise> out = noise_beside(together, gates);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::vector<Noise> allowed;
    for (const std::size_t i : groups[g])
      if (const auto deviation = deviation_from_repeats(all, i, odd, gates))
        allowed.push_back(estimate_noise({&*deviation, 1}, Eigen::MatrixXd(0, 0), gates)
                              .front()
                              .scaled(1.0 / static_cast<double>(groups[g].size())));
    if (allowed.empty() || !is_of_few(*common[g].observations.front(), gates)) {
      allowed.push_back(std::move(out[g]));
      allowed.push_back(noise_beside(common[g], gates).front());
    }
    out[g] = std::move(*std::ranges::max_element(allowed, {}, &Noise::long_run_deviation));
  }
  return out;
}

/// Rms of the slow part of low-band values, in µm or µrad.
void set_rms(const Observation& observation, const Eigen::VectorXd& values, const Gates& gates,
             std::optional<double>& um, std::optional<double>& urad) {
  const Eigen::MatrixXd slow =
      orthonormal(slow_cosines(values.size(), slow_cosine_count(values.size(), gates)));
  const double rms = (slow.transpose() * values).norm() /
                     std::sqrt(static_cast<double>(observation.low_band.samples()));
  const bool height = observation.profile->setup.quantity == Quantity::height;
  (height ? um : urad) = rms / (height ? kMicrometre : kMicroradian);
}

}  // namespace

std::vector<Eigen::Index> matched_values(const Observation& a, const Observation& b,
                                         const Gates& gates) {
  const std::vector<double> of_a = stations_from_axis(a), of_b = stations_from_axis(b);
  const double tolerance = gates.same_place * extent(a) / static_cast<double>(of_a.size());
  std::vector<Eigen::Index> out(of_a.size(), -1);
  std::size_t j = 0;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    while (j + 1 < of_b.size() && std::abs(of_b[j + 1] - of_a[i]) <= std::abs(of_b[j] - of_a[i]))
      ++j;
    if (near(of_a[i], of_b[j], tolerance)) out[i] = static_cast<Eigen::Index>(j);
  }
  return out;
}

bool are_repeats(const Observation& a, const Observation& b, const Gates& gates) {
  if (&a == &b) return true;
  const double station = gates.same_place * extent(a) / static_cast<double>(a.values.size());
  if (!are_of_one_surface(a, b, gates) ||
      !near(a.profile->setup.azimuth_deg, b.profile->setup.azimuth_deg, kAsWritten) ||
      !is_one_line(a.profile->line, b.profile->line, station))
    return false;
  const auto match = matched_values(a, b, gates);
  const auto shared = std::ranges::count_if(match, [](Eigen::Index j) { return j >= 0; });
  return 2 * shared >= std::max(a.values.size(), b.values.size());
}

std::vector<std::vector<std::size_t>> repeat_groups(const Linearisation& linear,
                                                    const Gates& gates) {
  auto out = grouped(
      linear, [&](const Observation& a, const Observation& b) { return are_repeats(a, b, gates); });
  std::erase_if(out, [](const std::vector<std::size_t>& group) { return group.size() < 2; });
  return out;
}

std::optional<LinearProfile> deviation_from_repeats(const Linearisation& linear, std::size_t i,
                                                    const std::vector<OddRepeat>& odd,
                                                    const Gates& gates,
                                                    const std::vector<Eigen::MatrixXd>& suspect) {
  const auto is_odd = [&](std::size_t j) {
    return std::ranges::count(odd, j, &OddRepeat::profile) > 0;
  };
  if (is_odd(i)) return std::nullopt;
  const Observation& observation = *linear.observations[i];
  std::vector<std::size_t> group;
  for (std::size_t j = 0; j < linear.observations.size(); ++j)
    if (!is_odd(j) && are_repeats(observation, *linear.observations[j], gates)) group.push_back(j);
  const StationSums repeats(linear, group, observation, gates);
  const Eigen::VectorXd& count = repeats.count;
  std::vector<Eigen::Index> alone;
  for (Eigen::Index row = 0; row < count.size(); ++row)
    if (count[row] < 2.0) alone.push_back(row);
  if (2 * std::ssize(alone) > count.size()) return std::nullopt;
  constexpr double kCopy = 1e-9;  // of the values: one file given twice is no repeat
  const Eigen::VectorXd scale = (count.array() / (count.array() - 1.0).max(1.0)).sqrt();
  Eigen::VectorXd deviation = scale.cwiseProduct(linear.residuals[i] - repeats.mean());
  if (deviation.norm() <= kCopy * observation.values.norm()) return std::nullopt;
  Eigen::MatrixXd free = observation.nuisances;
  for (const std::size_t j : group) {
    if (suspect.empty() || suspect[j].cols() == 0) continue;
    const Eigen::ArrayXd part = (i == j ? 1.0 : 0.0) - count.array().inverse();
    const auto match = matched_values(observation, *linear.observations[j], gates);
    append_columns(free,
                   (scale.array() * part).matrix().asDiagonal() * at_stations(match, suspect[j]));
  }
  append_columns(free, unit_columns(alone, count.size()));
  Eigen::MatrixXd basis = orthonormal(std::move(free));
  project_out(basis, deviation);
  return LinearProfile{std::move(basis), Eigen::MatrixXd(deviation.size(), 0), std::move(deviation),
                       observation.profile->standard_uncertainty};
}

std::vector<PureErrorCheck> check_repeats(const Linearisation& linear, const Gates& gates) {
  Gates finer = gates;
  finer.values_per_cosine = gates.values_per_repeated_cosine;
  finer.longest_memory = gates.longest_texture;  // texture of several lengths, no memory,
  finer.memory_odds = 1.0;                       // where the fine band asks for it
  Gates whole = finer;  // few stations of a slide tell no texture, and may be all form
  whole.values_per_cosine = 1.0;
  std::vector<std::vector<std::size_t>> groups = repeat_groups(linear, gates);
  const std::vector<OddRepeat> odd = odd_repeats(linear, gates);
  for (const OddRepeat& each : odd)
    for (std::vector<std::size_t>& group : groups) std::erase(group, each.profile);
  std::vector<PureErrorCheck> out;
  if (groups.empty()) return out;
  std::vector<Linearisation> common;
  for (const std::vector<std::size_t>& group : groups)
    common.push_back(common_trace(linear, group, gates));
  const std::vector<Noise> noises = noises_of_means(linear, groups, common, odd, finer);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const LackOfFit found = lack_of_fit(
        common[g], {noises[g]}, is_of_few(*common[g].observations.front(), gates) ? whole : finer);
    PureErrorCheck check;
    for (const std::size_t i : groups[g])
      check.profiles.push_back(linear.observations[i]->profile->name);
    check.F = found.ratio;
    check.p_value = found.p_value;
    if (found.significant(gates)) check.verdict = RepeatFit::lack_of_fit;
    const Observation& first = *common[g].observations.front();
    set_rms(first, common[g].residuals.front(), finer, check.common_um, check.common_urad);
    if (const auto deviation = deviation_from_repeats(linear, groups[g].front(), odd, gates))
      set_rms(first, deviation->residual, finer, check.apart_um, check.apart_urad);
    out.push_back(std::move(check));
  }
  return out;
}

}  // namespace slideway
