#include "structure.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "slideway/identify/linear_algebra.hpp"
#include "slideway/signal/spectrum.hpp"
#include "slideway/signal/view.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kCosines = 24;
constexpr double kLengths[] = {0.03, 0.05, 0.1, 0.2, 0.4, 0.8};  // of the clock's range
constexpr double kSizes[] = {0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0};  // of the noise

struct ClockOf {
  std::string symbol, unit;
  double (*read)(const Stations&, Eigen::Index);
  std::optional<IndependentVariable> needs;
};

const std::vector<ClockOf>& clocks() {
  static const std::vector<ClockOf> kAll{
      {"r", "mm", [](const Stations& s, Eigen::Index i) { return s.slide(i); }, std::nullopt},
      {"t", "s", [](const Stations& s, Eigen::Index i) { return s.time(i); },
       IndependentVariable::time},
      {"s", "mm", [](const Stations& s, Eigen::Index i) { return s.distance(i); },
       IndependentVariable::distance},
      {"X", "mm", [](const Stations& s, Eigen::Index i) { return s.trace(i); }, std::nullopt}};
  return kAll;
}

/// Readings of a clock at the low-band values of every fitted profile, or nothing.
std::vector<Eigen::VectorXd> readings(const Model& model, const Linearisation& linear,
                                      const ClockOf& clock) {
  std::vector<Eigen::VectorXd> out;
  for (const Observation* observation : linear.observations) {
    const Setup& setup = observation->profile->setup;
    if (clock.needs && !missing_for(*clock.needs, setup).empty()) return {};
    if (clock.symbol == "s" && setup.kind != Kind::face) return {};
    const std::vector<double> positions =
        observation->low_band.positions(observation->profile->positions);
    const Stations stations(positions, setup, model.machine);
    Eigen::VectorXd values(stations.size());
    for (Eigen::Index i = 0; i < stations.size(); ++i) values[i] = clock.read(stations, i);
    out.push_back(std::move(values));
  }
  return out;
}

Eigen::MatrixXd cosines_of(const Eigen::VectorXd& clock, double low, double high) {
  Eigen::MatrixXd out(clock.size(), kCosines);
  for (Eigen::Index j = 0; j < kCosines; ++j)
    out.col(j) = (kPi * static_cast<double>(j) * (clock.array() - low) / (high - low)).cos();
  return out;
}

/// Matérn 3/2 spectral weights of the cosines for a length in units of the range; they sum to 1.
Eigen::VectorXd weights(double length) {
  Eigen::VectorXd out(kCosines);
  for (Eigen::Index j = 0; j < kCosines; ++j) {
    const double w = kPi * static_cast<double>(j);
    out[j] = std::pow(3.0 / (length * length) + w * w, -2.0);
  }
  return out / out.sum();
}

struct Process {
  double log_evidence = -INFINITY;
  double length = 0.0;
  Eigen::VectorXd sizes, coefficients;
};

/// Best length and size by evidence. @param copies  how many sets of cosines stand side by side
Process best_process(const Whitened& data, Eigen::MatrixXd columns, Eigen::Index copies) {
  columns = data.outside(std::move(columns));
  const double unit = std::sqrt(columns.squaredNorm() / static_cast<double>(data.rows()));
  if (!(unit > 0.0)) return {};
  columns /= unit;
  const Eigen::MatrixXd gram = columns.transpose() * columns;
  const Eigen::VectorXd products = columns.transpose() * data.residual();
  Process best;
  for (const double length : kLengths)
    for (const double size : kSizes) {
      const Eigen::VectorXd root = size * weights(length).cwiseSqrt().replicate(copies, 1);
      const Eigen::MatrixXd inner = Eigen::MatrixXd::Identity(root.size(), root.size()) +
                                    root.asDiagonal() * gram * root.asDiagonal();
      const Eigen::LLT<Eigen::MatrixXd> llt(inner);
      const Eigen::VectorXd scaled = root.asDiagonal() * products;
      const Eigen::VectorXd solved = llt.solve(scaled);
      const double log_evidence =
          0.5 * scaled.dot(solved) - llt.matrixLLT().diagonal().array().log().sum();
      if (log_evidence > best.log_evidence)
        best = {log_evidence, length, root / unit, root.asDiagonal() * solved / unit};
    }
  return best;
}

double per_sample(const Observation& observation) {
  return std::sqrt(static_cast<double>(observation.values.size()) /
                   static_cast<double>(observation.low_band.samples()));
}

/// Share of the square that is odd about the spindle axis, for a trace over (nearly) a diameter.
std::optional<double> odd_share(const Profile& profile, const Eigen::VectorXd& values) {
  const Setup& setup = profile.setup;
  const double left = setup.center_mm - setup.first_mm, right = setup.last_mm - setup.center_mm;
  if (setup.kind != Kind::face || std::min(left, right) < 0.8 * std::max(left, right))
    return std::nullopt;
  double odd = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double part = 0.5 * (values[i] - values[values.size() - 1 - i]);
    odd += part * part;
  }
  return odd / std::max(values.squaredNorm(), 1e-300);
}

/// Period with most power if it holds a third of it, over at least two cycles.
std::optional<double> dominant_period(const Profile& profile, const Eigen::VectorXd& values) {
  const std::vector<double> spectrum = power_spectrum(view(values));
  double best = 0.0, total = 0.0;
  std::size_t cycles = 0;
  for (std::size_t k = 1; k < spectrum.size(); ++k) {
    total += spectrum[k];
    if (spectrum[k] > best) best = spectrum[k], cycles = k;
  }
  if (cycles < 2 || best < total / 3.0) return std::nullopt;
  return (profile.setup.last_mm - profile.setup.first_mm) / static_cast<double>(cycles);
}

void locate(const Profile& profile, const std::vector<double>& positions,
            const Eigen::VectorXd& values, Unnamed& out) {
  Eigen::Index peak = 0;
  const double largest = values.cwiseAbs().maxCoeff(&peak);
  Eigen::Index first = peak, last = peak;
  while (first > 0 && std::abs(values[first - 1]) > 0.5 * largest) --first;
  while (last + 1 < values.size() && std::abs(values[last + 1]) > 0.5 * largest) ++last;
  out.profile = profile.name;
  out.from_mm = positions[static_cast<std::size_t>(first)];
  out.to_mm = positions[static_cast<std::size_t>(last)];
  out.odd_share = odd_share(profile, values);
  out.dominant_period_mm = dominant_period(profile, values);
}

}  // namespace

Structure find_structure(const Model& model, const Whitened& data, const Linearisation& linear) {
  Structure found;
  Unnamed& out = found.description;
  double& best_evidence = found.log_evidence;
  const auto consider = [&](const std::string& symbol, const std::string& unit, double range,
                            const std::vector<Eigen::MatrixXd>& columns, Eigen::Index copies) {
    const Process process = best_process(
        data, stack(linear, columns[0].cols(), [&](std::size_t i) { return columns[i]; }), copies);
    out.log_evidence.emplace_back(symbol, process.log_evidence);
    if (!(process.log_evidence > best_evidence)) return;
    best_evidence = process.log_evidence;
    found.columns = columns;
    found.sizes = process.sizes;
    found.coefficients = process.coefficients;
    out.clock = symbol;
    out.correlation_length = process.length * range;
    out.correlation_unit = unit;
  };
  for (const ClockOf& clock : clocks()) {
    const std::vector<Eigen::VectorXd> values = readings(model, linear, clock);
    if (values.empty()) continue;
    double low = INFINITY, high = -INFINITY;
    for (const Eigen::VectorXd& one : values) {
      low = std::min(low, one.minCoeff());
      high = std::max(high, one.maxCoeff());
    }
    if (!(low < high)) continue;
    std::vector<Eigen::MatrixXd> columns;
    for (const Eigen::VectorXd& one : values) columns.push_back(cosines_of(one, low, high));
    consider(clock.symbol, clock.unit, high - low, columns, 1);
  }
  if (const auto count = static_cast<Eigen::Index>(linear.observations.size()); count > 1) {
    std::vector<Eigen::MatrixXd> columns;
    double range = 0.0;
    for (Eigen::Index p = 0; p < count; ++p) {
      const Observation& observation = *linear.observations[static_cast<std::size_t>(p)];
      const auto own = observation.low_band.positions(observation.profile->positions);
      const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(own.data(), std::ssize(own));
      Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(x.size(), count * kCosines);
      rows.middleCols(p * kCosines, kCosines) = cosines_of(x, x.minCoeff(), x.maxCoeff());
      range = std::max(range, x.maxCoeff() - x.minCoeff());
      columns.push_back(std::move(rows));
    }
    consider("per profile", "mm", range, columns, count);
  }
  for (auto& [symbol, evidence] : out.log_evidence) evidence -= best_evidence;
  return found;
}

Unnamed describe(const Structure& found, const Whitened& data, const Linearisation& linear) {
  Unnamed out = found.description;
  double largest = -1.0;
  Eigen::VectorXd process =
      stack(linear, 1, [&](std::size_t i) { return found.columns[i] * found.coefficients; });
  const Eigen::MatrixXd span = model_span(linear);
  process -= span * least_squares(span, process).values;  // that part shows as parameters
  for (std::size_t i = 0; i < found.columns.size(); ++i) {
    const Observation& observation = *linear.observations[i];
    Eigen::VectorXd values = process.segment(data.first_row(i), data.count(i));
    const double standing_out = values.norm() / std::sqrt(static_cast<double>(values.size())) /
                                data.noise()[i].standard_deviation();
    if (standing_out <= largest) continue;
    largest = standing_out;
    const bool slope = observation.profile->setup.quantity == Quantity::slope;
    values *= per_sample(observation) / (slope ? kMicroradian : kMicrometre);
    const double rms = values.norm() / std::sqrt(static_cast<double>(values.size()));
    const double pv = values.maxCoeff() - values.minCoeff();
    out.rms_um = slope ? std::nullopt : std::optional(rms);
    out.pv_um = slope ? std::nullopt : std::optional(pv);
    out.rms_urad = slope ? std::optional(rms) : std::nullopt;
    out.pv_urad = slope ? std::optional(pv) : std::nullopt;
    locate(*observation.profile, observation.low_band.positions(observation.profile->positions),
           values, out);
  }
  return out;
}

}  // namespace slideway
