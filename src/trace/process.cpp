#include "process.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>

namespace slideway {
namespace {

constexpr Eigen::Index kMostCosines = 48;
constexpr Eigen::Index kLeastCosines = 8;
constexpr Eigen::Index kMostColumns = 192;                              // of all copies
constexpr double kLengths[] = {0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 2.0};  // of the range
constexpr double kSmoothness[] = {0.5, 1.5, 2.5};                       // ν of Matérn
constexpr double kLeastSize = 0.1, kLargestSize = 1e5;                  // of the noise
constexpr int kSizes = 37;                                              // six a decade

struct Variable {
  std::string symbol, unit;
  double (*read)(const Stations&, Eigen::Index);
  std::optional<IndependentVariable> needs;
  bool of_faces = false;
};

const std::vector<Variable>& variables() {
  static const std::vector<Variable> kAll{
      {kSlideSymbol, "mm", [](const Stations& s, Eigen::Index i) { return s.slide(i); },
       std::nullopt},
      {"t", "s", [](const Stations& s, Eigen::Index i) { return s.time(i); },
       IndependentVariable::time},
      {"s", "mm", [](const Stations& s, Eigen::Index i) { return s.distance(i); },
       IndependentVariable::distance, true},
      {"X", "mm", [](const Stations& s, Eigen::Index i) { return s.trace(i); }, std::nullopt}};
  return kAll;
}

/// Readings of a variable at the low-band values of every fitted profile, or nothing.
std::vector<Eigen::VectorXd> readings(const Model& model, const Linearisation& linear,
                                      const Variable& variable) {
  std::vector<Eigen::VectorXd> out;
  for (const Observation* observation : linear.observations) {
    const Setup& setup = observation->profile->setup;
    if (variable.needs && !missing_for(*variable.needs, setup).empty()) return {};
    if (variable.of_faces && setup.kind != Kind::face) return {};
    const std::vector<double> positions =
        observation->low_band.positions(observation->profile->positions);
    const Stations stations(positions, setup, model.machine);
    Eigen::VectorXd values(stations.size());
    for (Eigen::Index i = 0; i < stations.size(); ++i) values[i] = variable.read(stations, i);
    out.push_back(std::move(values));
  }
  return out;
}

/// cos(π j (v - low) / (high - low)), j = 0 ... count - 1, in low-band values of the observation.
Eigen::MatrixXd cosines_of(const Observation& observation, const Eigen::VectorXd& v, double low,
                           double high, Eigen::Index count) {
  Eigen::MatrixXd out(v.size(), count);
  for (Eigen::Index j = 0; j < count; ++j)
    out.col(j) = low_band_scale(observation) *
                 (kPi * static_cast<double>(j) * (v.array() - low) / (high - low)).cos();
  return out;
}

/// So many that the shortest half wave is two values of the longest profile.
Eigen::Index cosine_count(const Linearisation& linear, Eigen::Index most) {
  Eigen::Index longest = 0;
  for (const Observation* observation : linear.observations)
    longest = std::max(longest, observation->values.size());
  return std::clamp(longest / 2, kLeastCosines, std::max(most, kLeastCosines));
}

/// A process of its own in each of the profiles `which`, none in the others.
ProcessVariable own_processes(const Linearisation& linear, const std::vector<std::size_t>& which,
                              std::string symbol) {
  ProcessVariable out{std::move(symbol), "mm", 0.0, {}, std::ssize(which)};
  const Eigen::Index each = cosine_count(linear, std::min(kMostCosines, kMostColumns / out.copies));
  for (const Observation* observation : linear.observations)
    out.cosines.emplace_back(Eigen::MatrixXd::Zero(observation->values.size(), out.copies * each));
  for (std::size_t k = 0; k < which.size(); ++k) {
    const Observation& observation = *linear.observations[which[k]];
    const auto own = observation.low_band.positions(observation.profile->positions);
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(own.data(), std::ssize(own));
    const double low = x.minCoeff(), high = x.maxCoeff();
    if (!(low < high)) continue;
    out.cosines[which[k]].middleCols(static_cast<Eigen::Index>(k) * each, each) =
        cosines_of(observation, x, low, high, each);
    out.range = std::max(out.range, high - low);
  }
  return out;
}

/// Spectral weights of the cosines, Matérn of smoothness ν and a length in units of the range; they
/// sum to 1.
Eigen::VectorXd weights(Eigen::Index count, double smoothness, double length) {
  Eigen::VectorXd out(count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const double w = kPi * static_cast<double>(j);
    out[j] = std::pow(2.0 * smoothness / (length * length) + w * w, -(smoothness + 0.5));
  }
  return out / out.sum();
}

/// The best size of a process whose coefficients have relative standard deviations `root`.
/// @param gram, products  of the columns in units of `unit`
void try_sizes(const Eigen::MatrixXd& gram, const Eigen::VectorXd& products,
               const Eigen::VectorXd& root, double unit, double length, Process& best) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(root.asDiagonal() * gram *
                                                             root.asDiagonal());
  const Eigen::ArrayXd values = eigen.eigenvalues().array().max(0.0);
  const Eigen::ArrayXd along = eigen.eigenvectors().transpose() * root.cwiseProduct(products);
  for (int k = 0; k < kSizes; ++k) {
    const double size =
        kLeastSize * std::pow(kLargestSize / kLeastSize, static_cast<double>(k) / (kSizes - 1));
    const Eigen::ArrayXd grown = 1.0 + size * size * values;
    const double log_evidence =
        0.5 * (size * size * along.square() / grown).sum() - 0.5 * grown.log().sum();
    if (!(log_evidence > best.log_evidence)) continue;
    best.log_evidence = log_evidence;
    best.length = length;
    best.sizes = size / unit * root;
    best.coefficients = size * size / unit *
                        root.cwiseProduct((eigen.eigenvectors() * (along / grown).matrix()).eval());
  }
}

}  // namespace

double low_band_scale(const Observation& observation) {
  return std::sqrt(static_cast<double>(observation.low_band.samples()) /
                   static_cast<double>(observation.values.size()));
}

std::vector<Eigen::VectorXd> slide_positions(const Model& model, const Linearisation& linear) {
  return readings(model, linear, variables().front());
}

std::vector<ProcessVariable> process_variables(const Model& model, const Linearisation& linear) {
  std::vector<ProcessVariable> out;
  for (const Variable& variable : variables()) {
    const std::vector<Eigen::VectorXd> values = readings(model, linear, variable);
    if (values.empty()) continue;
    double low = INFINITY, high = -INFINITY;
    for (const Eigen::VectorXd& one : values) {
      low = std::min(low, one.minCoeff());
      high = std::max(high, one.maxCoeff());
    }
    if (!(low < high)) continue;
    ProcessVariable& added =
        out.emplace_back(ProcessVariable{variable.symbol, variable.unit, high - low, {}});
    for (std::size_t i = 0; i < values.size(); ++i)
      added.cosines.push_back(cosines_of(*linear.observations[i], values[i], low, high,
                                         cosine_count(linear, kMostCosines)));
  }
  const std::size_t profiles = linear.observations.size();
  if (profiles < 2) return out;
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < profiles; ++i) all.push_back(i);
  out.push_back(own_processes(linear, all, "per profile"));
  for (const std::size_t i : all)
    out.push_back(own_processes(linear, {i}, linear.observations[i]->profile->name + " alone"));
  return out;
}

Process best_process(const Whitened& data, const Linearisation& linear,
                     const ProcessVariable& variable) {
  Process best;
  const Eigen::Index count = variable.cosines.front().cols();
  Eigen::MatrixXd columns =
      data.outside(stack(linear, count, [&](std::size_t i) { return variable.cosines[i]; }));
  const double unit = std::sqrt(columns.squaredNorm() / static_cast<double>(data.rows()));
  if (!(unit > 0.0)) return best;
  columns /= unit;
  const Eigen::MatrixXd gram = columns.transpose() * columns;
  const Eigen::VectorXd products = columns.transpose() * data.residual();
  for (const double smoothness : kSmoothness)
    for (const double length : kLengths) {
      const Eigen::VectorXd root = weights(count / variable.copies, smoothness, length)
                                       .cwiseSqrt()
                                       .replicate(variable.copies, 1);
      try_sizes(gram, products, root, unit, length, best);
    }
  return best;
}

}  // namespace slideway
