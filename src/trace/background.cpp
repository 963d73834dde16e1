#include "background.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "linear_algebra.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kSlowCosines = 16;  // to 8 cycles a profile
constexpr Eigen::Index kValuesPerCosine = 10;
constexpr Eigen::Index kLeastSpare = 6;  // values beyond what is free, else the fit's noise
constexpr double kRounding = 1e-13;      // of the values: no noise, only rounding
constexpr int kLeastOrder = 1;           // BIC on the fine band alone overlooks a short correlation
constexpr int kMostLines = 12;
constexpr double kFalseLine = 1e-3;       // chance that a spectrum of noise is given one line
constexpr Eigen::Index kNeighbours = 15;  // on either side, for the level of a spectrum
constexpr double kNoseRadius = 2.0;       // mm, of a large finishing tool
constexpr double kMostLost = 0.1;         // of the radius of the face

bool same_cut(const Observation& a, const Observation& b) {
  const Setup &s = a.profile->setup, &t = b.profile->setup;
  return a.values.size() == b.values.size() && a.profile->positions == b.profile->positions &&
         s.kind == t.kind && s.quantity == t.quantity && s.base_mm == t.base_mm &&
         s.center_mm == t.center_mm && s.spindle_position_mm == t.spindle_position_mm &&
         s.z_mm == t.z_mm && s.overhang_mm == t.overhang_mm &&
         s.feed_mm_per_min == t.feed_mm_per_min && s.spindle_rpm == t.spindle_rpm &&
         s.cut_direction == t.cut_direction && s.cut_radius_mm == t.cut_radius_mm &&
         s.start_s == t.start_s && s.traverse_mm_per_s == t.traverse_mm_per_s;
}

Eigen::MatrixXd line(Eigen::Index n, double cycles_per_value) {
  Eigen::MatrixXd out(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double angle = 2.0 * kPi * cycles_per_value * static_cast<double>(i);
    out.row(i) << std::cos(angle), std::sin(angle);
  }
  return out;
}

/// Spectral power of the values, of each half of a diameter by itself: what the cut has laid down
/// runs there and back. Of one half if `middle` is 0.
double power(const Eigen::VectorXd& values, Eigen::Index middle, double cycles_per_value) {
  const std::complex<double> turn = std::polar(1.0, -2.0 * kPi * cycles_per_value);
  std::complex<double> phase = 1.0, far = 0.0, near = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    (i < middle ? far : near) += values[i] * phase;
    phase *= turn;
  }
  return std::norm(far) + std::norm(near);
}

/// Frequency near `frequency` where the power is largest, to a thousandth of a cycle a profile.
double sharpened(const Eigen::VectorXd& values, Eigen::Index middle, double frequency) {
  const auto n = static_cast<double>(values.size());
  for (double step = 0.1; step > 5e-4; step /= 10.0) {
    const double centre = frequency;
    double largest = -1.0;
    for (int i = -10; i <= 10; ++i) {
      const double f = centre + i * step / n, size = power(values, middle, f);
      if (size > largest) largest = size, frequency = f;
    }
  }
  return frequency;
}

/// Frequency (cycles per value) of a line that stands out of the spectrum around it, or 0. The
/// spectrum of smooth noise over its local level is exponential; the level is the median of the
/// neighbours over ln 2.
/// @param middle  first value of the near half of a diameter, or 0
double outstanding_line(const Eigen::VectorXd& values, Eigen::Index middle) {
  const Eigen::Index n = values.size(), count = (n - 1) / 2;
  if (count < 4 * kNeighbours) return 0.0;
  Eigen::VectorXd spectrum(count);
  for (Eigen::Index k = 0; k < count; ++k)
    spectrum[k] = power(values, 0, static_cast<double>(k + 1) / static_cast<double>(n));
  double best = std::log(static_cast<double>(count) / kFalseLine);
  Eigen::Index peak = -1;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index first =
        std::clamp<Eigen::Index>(k - kNeighbours, 0, count - 2 * kNeighbours - 1);
    std::vector<double> around(spectrum.data() + first,
                               spectrum.data() + first + 2 * kNeighbours + 1);
    std::nth_element(around.begin(), around.begin() + kNeighbours, around.end());
    const double level = around[kNeighbours] / std::log(2.0);
    if (spectrum[k] > best * level) best = spectrum[k] / level, peak = k;
  }
  if (peak < 0) return 0.0;
  return sharpened(values, middle, static_cast<double>(peak + 1) / static_cast<double>(n));
}

/// First low-band value of the near half of a diameter; 0 where there is no far one.
Eigen::Index near_half(const Observation& observation) {
  const Setup& setup = observation.profile->setup;
  if (setup.kind != Kind::face) return 0;
  const std::vector<double> positions =
      observation.low_band.positions(observation.profile->positions);
  return std::ranges::lower_bound(positions, setup.center_mm) - positions.begin();
}

/// The line, each half of a diameter with a phase of its own.
Eigen::MatrixXd line_on(Eigen::Index values, Eigen::Index middle, double cycles_per_value) {
  Eigen::MatrixXd out = line(values, cycles_per_value);
  if (middle == 0) return out;
  out.conservativeResize(Eigen::NoChange, 4);
  out.rightCols(2) = out.leftCols(2);
  out.topRightCorner(middle, 2).setZero();
  return out;
}

void append(Eigen::MatrixXd& columns, const Eigen::MatrixXd& more) {
  Eigen::MatrixXd out(std::max(columns.rows(), more.rows()), columns.cols() + more.cols());
  out << columns, more;
  columns = std::move(out);
}

/// An orthonormal basis of what the columns add to two others.
Eigen::MatrixXd beyond(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& more,
                       Eigen::MatrixXd columns) {
  constexpr double kNew = 1e-6;  // of a column: less is rounding
  const Eigen::RowVectorXd whole = columns.colwise().norm();
  for (int pass = 0; pass < 2; ++pass)
    for (const Eigen::MatrixXd* taken : {&basis, &more})
      columns -= *taken * (taken->transpose() * columns).eval();
  for (Eigen::Index j = 0; j < columns.cols(); ++j)
    if (columns.col(j).norm() <= kNew * whole[j]) columns.col(j).setZero();
  return orthonormal(std::move(columns));
}

/// What the basis leaves of the residual, without the columns and without lines that stand out of
/// the spectrum. Those are not left free as the basis is: noise could then be put into the gaps
/// they make in the spectrum, where nobody would miss it. What they take of the noise's size is
/// given back. Zeros if too little is left to know a noise by.
/// @param middle  as outstanding_line()
Eigen::VectorXd without_lines(const Eigen::VectorXd& residual, const Eigen::MatrixXd& basis,
                              const Eigen::MatrixXd& columns, Eigen::Index middle) {
  const Eigen::Index n = residual.size(), seen = n - basis.cols();
  Eigen::MatrixXd known(n, 0);
  Eigen::VectorXd rest = residual - basis * (basis.transpose() * residual);
  const auto take_out = [&](const Eigen::MatrixXd& more) {
    const Eigen::MatrixXd own = beyond(basis, known, more);
    rest -= own * (own.transpose() * rest);
    append(known, own);
  };
  take_out(columns);
  for (int found = 0; found < kMostLines; ++found) {
    const double frequency = outstanding_line(rest, middle);
    if (frequency == 0.0) break;
    take_out(line_on(n, middle, frequency));
  }
  const Eigen::Index left = seen - known.cols();
  if (left < kLeastSpare) return Eigen::VectorXd::Zero(n);
  return rest * std::sqrt(static_cast<double>(seen) / static_cast<double>(left));
}

/// Columns that lie in the basis for the most part, and those that do not.
std::pair<Eigen::MatrixXd, Eigen::MatrixXd> parted(const Eigen::MatrixXd& basis,
                                                   const Eigen::MatrixXd& columns) {
  std::array<std::vector<Eigen::Index>, 2> parts;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const double inside = (basis.transpose() * columns.col(j)).squaredNorm();
    parts[inside < 0.5 * columns.col(j).squaredNorm() ? 1 : 0].push_back(j);
  }
  return {columns(Eigen::all, parts[0]), columns(Eigen::all, parts[1])};
}

LinearProfile linear_profile(Eigen::MatrixXd basis, Eigen::VectorXd residual,
                             const std::optional<double>& declared) {
  residual -= basis * (basis.transpose() * residual).eval();
  return {std::move(basis), Eigen::MatrixXd(residual.size(), 0), std::move(residual), declared,
          kLeastOrder};
}

/// Deviations of observation i from the mean of those that repeat it, of the size its noise has.
std::optional<LinearProfile> from_repeats(const Linearisation& linear, std::size_t i) {
  const Observation& observation = *linear.observations[i];
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(observation.values.size());
  double count = 0.0;
  for (std::size_t j = 0; j < linear.observations.size(); ++j)
    if (same_cut(observation, *linear.observations[j])) mean += linear.residuals[j], ++count;
  if (count < 2.0) return std::nullopt;
  const Eigen::VectorXd deviation =
      (linear.residuals[i] - mean / count) * std::sqrt(count / (count - 1.0));
  constexpr double kCopy = 1e-9;  // of the values: one file given twice is no repeat
  if (deviation.norm() <= kCopy * observation.values.norm()) return std::nullopt;
  return linear_profile(orthonormal(observation.nuisances), deviation,
                        observation.profile->standard_uncertainty);
}

LinearProfile from_fine_band(const Linearisation& linear, std::size_t i,
                             const Eigen::MatrixXd& loose,
                             const std::vector<Eigen::MatrixXd>& suspect) {
  const Observation& observation = *linear.observations[i];
  const Eigen::Index n = observation.values.size();
  Eigen::MatrixXd free = observation.nuisances, columns = linear.columns[i];
  append(free, slow_cosines(n, slow_cosine_count(n)));
  append(free, loose);
  if (!suspect.empty()) append(columns, suspect[i]);
  const auto [slow, lines] = parted(orthonormal(free), columns);
  append(free, slow);
  Eigen::MatrixXd basis = orthonormal(std::move(free));
  Eigen::VectorXd rest = without_lines(linear.residuals[i], basis, lines, near_half(observation));
  return linear_profile(std::move(basis), std::move(rest),
                        observation.profile->standard_uncertainty);
}

Eigen::MatrixXd unit_columns(Eigen::Index rows, const std::vector<Eigen::Index>& at) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, std::ssize(at));
  for (std::size_t j = 0; j < at.size(); ++j) out(at[j], static_cast<Eigen::Index>(j)) = 1.0;
  return out;
}

/// Radius out to which a nose cuts a curve visibly lower than it is: by ρ z'²/2 to first order. 0
/// if that is no matter of the centre alone.
/// @param curve, noise  of low-band values
double lost_radius(const Model& model, const Observation& observation, const Eigen::VectorXd& curve,
                   double noise) {
  const std::vector<double> positions =
      observation.low_band.positions(observation.profile->positions);
  const Stations stations(positions, observation.profile->setup, model.machine);
  const double height = std::sqrt(static_cast<double>(stations.size()) /
                                  static_cast<double>(observation.low_band.samples()));
  double lost = 0.0, reach = 0.0;
  for (Eigen::Index i = 1; i < curve.size(); ++i) {
    const double r = 0.5 * (stations.radius(i) + stations.radius(i - 1));
    const double slope =
        height * (curve[i] - curve[i - 1]) / (stations.trace(i) - stations.trace(i - 1));
    reach = std::max(reach, r);
    if (0.5 * kNoseRadius * slope * slope > height * noise) lost = std::max(lost, r);
  }
  return lost < kMostLost * reach ? lost : 0.0;
}

/// What the effects of the model that are steep at the centre put into a low band.
Eigen::VectorXd centred_curve(const Model& model, const Solution& fit, std::size_t i) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(fit.linear.residuals[i].size());
  for (const ModelTerm& term : model.terms)
    if (is_centred(*term.effect)) {
      const Eigen::Index first = term.first_amplitude, count = term.effect->amplitudes();
      out += fit.linear.columns[i].middleCols(first, count) *
             fit.estimate.amplitudes.segment(first, count);
    }
  return out;
}

}  // namespace

bool is_centred(const Effect& effect) { return effect.description().steep_at_centre; }

Eigen::Index slow_cosine_count(Eigen::Index n) {
  return std::min(kSlowCosines, n / kValuesPerCosine);
}

Eigen::MatrixXd slow_cosines(Eigen::Index n, Eigen::Index count) {
  Eigen::MatrixXd out(n, count);
  for (Eigen::Index j = 0; j < count; ++j)
    for (Eigen::Index i = 0; i < n; ++i)
      out(i, j) = std::cos(kPi * static_cast<double>(j + 1) * (static_cast<double>(i) + 0.5) /
                           static_cast<double>(n));
  return out;
}

double lost_centre(const Model& model, const Solution& fit) {
  double lost = 0.0;
  for (std::size_t i = 0; i < fit.linear.observations.size(); ++i) {
    const Observation& observation = *fit.linear.observations[i];
    if (observation.profile->setup.kind == Kind::face)
      lost = std::max(lost, lost_radius(model, observation, centred_curve(model, fit, i),
                                        fit.noise[i].standard_deviation()));
  }
  return lost;
}

void leave_out_centre(Model& model, double radius_mm) {
  for (Observation& observation : model.observations) {
    if (observation.profile->setup.kind != Kind::face) continue;
    std::vector<Eigen::Index> rows;
    const std::vector<double> positions =
        observation.low_band.positions(observation.profile->positions);
    const Stations stations(positions, observation.profile->setup, model.machine);
    for (Eigen::Index i = 0; i < stations.size(); ++i)
      if (stations.radius(i) <= radius_mm) rows.push_back(i);
    leave_out(observation, rows);
  }
}

Eigen::MatrixXd loose_values(const Model& model, const Solution& fit,
                             const std::vector<Noise>& noise, const Eigen::VectorXd& suspect) {
  std::vector<Eigen::Index> rows;
  Eigen::Index first = 0;
  for (std::size_t o = 0; o < fit.linear.observations.size(); ++o) {
    const Observation& observation = *fit.linear.observations[o];
    const Setup& setup = observation.profile->setup;
    const std::vector<double> positions =
        observation.low_band.positions(observation.profile->positions);
    const Stations stations(positions, setup, model.machine);
    double reach = (setup.last_mm - setup.first_mm) / static_cast<double>(positions.size());
    if (setup.feed_mm_per_min && setup.spindle_rpm)
      reach = std::max(reach, *setup.feed_mm_per_min / *setup.spindle_rpm);
    if (setup.kind == Kind::face) {
      Eigen::VectorXd curve = centred_curve(model, fit, o);
      if (suspect.size() > 0) curve += suspect.segment(first, curve.size());
      const double lost =
          std::max(reach, lost_radius(model, observation, curve, noise[o].standard_deviation()));
      for (Eigen::Index i = 0; i < stations.size(); ++i)
        if (stations.radius(i) <= lost) rows.push_back(first + i);
    }
    for (const ModelTerm& term : model.terms)
      for (std::size_t s = 0; s < term.effect->shapes().size(); ++s) {
        if (!term.effect->shapes()[s].stepwise || !term.effect->applies_to(setup)) continue;
        const double place = fit.estimate.shapes[term.first_shape + static_cast<Eigen::Index>(s)];
        for (Eigen::Index i = 0; i < stations.size(); ++i)
          if (std::abs(stations.radius(i) - place) <= reach) rows.push_back(first + i);
      }
    first += observation.values.size();
  }
  return unit_columns(first + fit.linear.prior_rows.rows(), rows);
}

std::vector<Noise> background_noise(const Solution& fit, const Eigen::MatrixXd& loose,
                                    const std::vector<Eigen::MatrixXd>& suspect) {
  std::vector<Eigen::Index> first{0};
  for (const Observation* observation : fit.linear.observations)
    first.push_back(first.back() + observation->values.size());
  std::vector<Noise> out(fit.linear.observations.size());
  parallel_for(out.size(), [&](std::size_t i) {
    const std::optional<LinearProfile> repeats = from_repeats(fit.linear, i);
    const Eigen::MatrixXd own = loose.middleRows(first[i], first[i + 1] - first[i]);
    const std::vector<LinearProfile> one{repeats ? *repeats
                                                 : from_fine_band(fit.linear, i, own, suspect)};
    const Eigen::Index spare = one[0].residual.size() - one[0].nuisances.cols();
    const double least = kRounding * fit.linear.observations[i]->values.norm();
    const bool usable = spare >= kLeastSpare && one[0].residual.norm() > least;
    out[i] = usable ? estimate_noise(one, Eigen::MatrixXd(0, 0)).front() : fit.noise[i];
  });
  return out;
}

}  // namespace slideway
