#include "process.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "slideway/base/parallel.hpp"
#include "slideway/identify/isotropic_prior.hpp"

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
      {"X", "mm", [](const Stations& s, Eigen::Index i) { return s.trace(i); }, std::nullopt},
      {"t_read", "s", [](const Stations& s, Eigen::Index i) { return s.reading_time(i); },
       IndependentVariable::reading_time}};
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

/// A process of its own in each of the profiles, none in the others.
ProcessVariable own_processes(const Linearisation& linear, std::vector<std::size_t> profiles,
                              std::string symbol) {
  const Eigen::Index count = cosine_count(
      linear, std::min(kMostCosines, kMostColumns / static_cast<Eigen::Index>(profiles.size())));
  ProcessVariable out{std::move(symbol), "mm", 0.0, std::move(profiles), {}, true};
  for (const std::size_t i : out.profiles) {
    const Observation& observation = *linear.observations[i];
    const auto own = observation.low_band.positions(observation.profile->positions);
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(own.data(), std::ssize(own));
    const double low = x.minCoeff(), high = x.maxCoeff();
    out.cosines.push_back(low < high ? cosines_of(observation, x, low, high, count)
                                     : Eigen::MatrixXd::Zero(x.size(), count));
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

/// What white data say of a process: a block for each process of its own.
struct ProcessData {
  std::vector<Eigen::MatrixXd> blocks;
  Eigen::MatrixXd shared;
  Eigen::VectorXd products;
  double unit = 0.0;  // of the columns outside the model
};

ProcessData data_of(const Whitened& data, const ProcessVariable& variable) {
  const Eigen::Index count = variable.cosines.front().cols();
  const Eigen::Index copies = variable.of_each ? std::ssize(variable.cosines) : 1;
  ProcessData out;
  out.blocks.assign(static_cast<std::size_t>(copies), Eigen::MatrixXd::Zero(count, count));
  out.products = Eigen::VectorXd::Zero(copies * count);
  for (std::size_t k = 0; k < variable.cosines.size(); ++k) {
    const Whitened::Shown shown = data.shown_in(variable.profiles[k], variable.cosines[k]);
    if (k == 0) out.shared = Eigen::MatrixXd::Zero(shown.shared.rows(), copies * count);
    const std::size_t block = variable.of_each ? k : 0;
    const Eigen::Index first = static_cast<Eigen::Index>(block) * count;
    out.blocks[block] += shown.gram;
    out.shared.middleCols(first, count) += shown.shared;
    out.products.segment(first, count) += shown.products;
  }
  double square = -out.shared.squaredNorm();
  for (const Eigen::MatrixXd& block : out.blocks) square += block.trace();
  out.unit = std::sqrt(std::max(square, 0.0) / static_cast<double>(data.rows()));
  return out;
}

/// Every size of a process whose coefficients have relative standard deviations `root`, the same
/// in each block.
void try_sizes(const ProcessData& data, const Eigen::VectorXd& root, double length, Process& best) {
  const Eigen::VectorXd scale = root / data.unit;
  std::vector<Eigen::MatrixXd> blocks;
  for (const Eigen::MatrixXd& block : data.blocks)
    blocks.emplace_back(scale.asDiagonal() * block * scale.asDiagonal());
  const Eigen::VectorXd all = scale.replicate(std::ssize(blocks), 1);
  const IsotropicPrior prior(blocks, data.shared * all.asDiagonal(),
                             all.cwiseProduct(data.products));
  double size_of_best = 0.0;
  for (int k = 0; k < kSizes; ++k) {
    const double size =
        kLeastSize * std::pow(kLargestSize / kLeastSize, static_cast<double>(k) / (kSizes - 1));
    const double log_evidence = prior.log_evidence(size * size);
    if (!(log_evidence > best.log_evidence)) continue;
    best.log_evidence = log_evidence;
    size_of_best = size;
  }
  if (size_of_best == 0.0) return;
  best.length = length;
  best.sizes = size_of_best * all;
  best.coefficients = all.cwiseProduct(prior.mean(size_of_best * size_of_best));
}

}  // namespace

std::vector<Eigen::MatrixXd> ProcessVariable::columns(const Linearisation& linear) const {
  const Eigen::Index count = cosines.front().cols();
  std::vector<Eigen::MatrixXd> out;
  for (const Observation* observation : linear.observations)
    out.emplace_back(Eigen::MatrixXd::Zero(observation->values.size(),
                                           of_each ? count * std::ssize(cosines) : count));
  for (std::size_t k = 0; k < cosines.size(); ++k)
    out[profiles[k]].middleCols(of_each ? static_cast<Eigen::Index>(k) * count : 0, count) =
        cosines[k];
  return out;
}

std::vector<Eigen::VectorXd> slide_positions(const Model& model, const Linearisation& linear) {
  return readings(model, linear, variables().front());
}

std::vector<Eigen::VectorXd> readings_of(const Model& model, const Linearisation& linear,
                                         const std::string& symbol) {
  const std::vector<Variable>& all = variables();
  auto found = std::ranges::find(all, symbol, &Variable::symbol);
  if (found == all.end()) found = std::ranges::find(all, "X", &Variable::symbol);
  return readings(model, linear, *found);
}

std::vector<ProcessVariable> shared_variables(const Model& model, const Linearisation& linear) {
  std::vector<ProcessVariable> out;
  std::vector<std::size_t> all(linear.observations.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
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
        out.emplace_back(ProcessVariable{variable.symbol, variable.unit, high - low, all, {}});
    for (const std::size_t i : all)
      added.cosines.push_back(cosines_of(*linear.observations[i], values[i], low, high,
                                         cosine_count(linear, kMostCosines)));
  }
  return out;
}

std::vector<ProcessVariable> process_variables(const Model& model, const Linearisation& linear) {
  std::vector<ProcessVariable> out = shared_variables(model, linear);
  std::vector<std::size_t> all(linear.observations.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (all.size() < 2) return out;
  out.push_back(own_processes(linear, all, kOfEachProfile));
  for (const std::size_t i : all)
    out.push_back(own_processes(linear, {i}, linear.observations[i]->profile->name + " alone"));
  return out;
}

Process best_process(const Whitened& data, const ProcessVariable& variable) {
  Process best;
  const ProcessData known = data_of(data, variable);
  if (!(known.unit > 0.0)) return best;
  const Eigen::Index count = variable.cosines.front().cols();
  for (const double smoothness : kSmoothness)
    for (const double length : kLengths)
      try_sizes(known, weights(count, smoothness, length).cwiseSqrt(), length, best);
  return best;
}

std::vector<Process> best_processes(const Whitened& data,
                                    const std::vector<ProcessVariable>& variables) {
  std::vector<Process> out(variables.size());
  parallel_for(out.size(), [&](std::size_t i) { out[i] = best_process(data, variables[i]); });
  return out;
}

}  // namespace slideway
