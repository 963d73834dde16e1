#include "memory_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "slideway/base/parallel.hpp"

namespace slideway {
namespace {

// Finest steps: an eighth of a decade of g and h, a quarter of an octave of L, an eighth of α.
constexpr int kSizes = 37;                // 10^-2.5 ... 100
constexpr int kLengths = 25;              // 1 ... 64 values
constexpr int kSlopes = 17;               // 1 (1/f noise) ... 3 (more than a random walk, 2)
constexpr int kSteepestAlone = 4;         // 1.5: alone, no profile goes to the unit root
constexpr int kCoarse = 4;                // finest steps of the first search
constexpr double kPlausible = 6.0;        // of -2 ln probability: 5 % of the best
constexpr double kAllowed = 14.0;         // of the same: 0.1 % of the best
constexpr double kWorthNeighbours = 2.5;  // of the same: 30 % of the best

double size_at(int index) { return std::pow(10.0, 0.125 * (index - 1) - 2.5); }
double length_at(int index) { return std::exp2(0.25 * index); }
double slope_at(int index) { return 1.0 + 0.125 * index; }

/// -2 ln of the prior: a texture of any kind is as probable as none, a long memory of any kind is
/// Gates::memory_odds times as probable as none.
double prior_cost(const MemoryPlace& place, double memory_odds) {
  const auto coarse = [](int count) {
    const int steps = (count - 1) / kCoarse;
    return static_cast<double>(steps + 1);
  };
  double places = 1.0;
  if (place.texture > 0) places *= coarse(kSizes) * coarse(kLengths);
  if (place.memory > 0) places *= coarse(kSizes) * coarse(kSlopes) / memory_odds;
  return 2.0 * std::log(places);
}

std::vector<MemoryPlace> with_texture(MemoryPlace place) {
  std::vector<MemoryPlace> out;
  for (const int size : {21, kSizes})  // 1, 100
    for (const int length : {4, 12}) {
      place.texture = size, place.length = length;
      out.push_back(place);
    }
  return out;
}

std::vector<MemoryPlace> with_memory(MemoryPlace place) {
  std::vector<MemoryPlace> out;
  for (const int size : {9, 21, kSizes})  // 0.03, 1, 100
    for (const int slope : {0, kSteepestAlone, 8}) {
      place.memory = size, place.slope = slope;
      out.push_back(place);
    }
  return out;
}

std::vector<MemoryPlace> neighbours(const MemoryPlace& place, int step) {
  std::vector<MemoryPlace> out;
  const auto add = [&](int MemoryPlace::*index, int least, int most) {
    for (const int change : {-step, step}) {
      MemoryPlace other = place;
      other.*index += change;
      if (other.*index >= least && other.*index <= most) out.push_back(other);
    }
  };
  if (place.texture > 0) {
    add(&MemoryPlace::texture, 1, kSizes);
    add(&MemoryPlace::length, 0, kLengths - 1);
  }
  if (place.memory > 0) {
    add(&MemoryPlace::memory, 1, kSizes);
    add(&MemoryPlace::slope, 0, kSlopes - 1);
  }
  return out;
}

bool of_one_kind(const MemoryPlace& a, const MemoryPlace& b) {
  return (a.texture > 0) == (b.texture > 0) && (a.memory > 0) == (b.memory > 0);
}

}  // namespace

ExponentialMixture memory_at(const MemoryPlace& place, double n, double traces) {
  constexpr int kLong = ExponentialMixture::kTerms - 1;
  constexpr double kShortest = 2.0;  // values: a shorter memory looks white
  const auto step = [](const ExponentialMixture& part) {
    return part.variance() - part.white - part.covariance(1.0);
  };
  ExponentialMixture texture, memory;
  if (place.texture > 0) {
    texture.lengths[0] = length_at(place.length);
    texture.variances[0] = 1.0;
    texture.variances[0] = size_at(place.texture) / step(texture);
  }
  if (place.memory > 0) {
    const double factor = std::pow(traces * n / kShortest, 1.0 / (kLong - 1));
    for (int k = 0; k < kLong; ++k) memory.lengths[k + 1] = kShortest * std::pow(factor, k);
    memory.variances.tail(kLong) = memory.lengths.tail(kLong).pow(slope_at(place.slope) - 1.0);
    memory.variances *= size_at(place.memory) / step(memory);
  }
  memory.lengths[0] = texture.lengths[0];
  memory.variances[0] = texture.variances[0];
  return memory;
}

PoolMemory::PoolMemory(std::vector<const ProfileLikelihood*> profiles, const Eigen::MatrixXd& rest,
                       const Gates& gates)
    : profiles_(std::move(profiles)), rest_(rest), gates_(gates) {
  Eigen::VectorXd start(std::ssize(profiles_));
  for (std::size_t i = 0; i < profiles_.size(); ++i) {
    const LinearProfile& profile = profiles_[i]->profile();
    values_ = std::max(values_, profile.extent());
    const auto own = static_cast<double>(profile.residual.size() - profile.nuisances.cols());
    start[static_cast<Eigen::Index>(i)] =
        0.5 * std::log(std::max(profile.residual.squaredNorm(), 1e-300) / std::max(own, 1.0));
  }
  is_near_ = std::ranges::any_of(profiles_, &ProfileLikelihood::is_thinned);
  visit({MemoryPlace{}}, start);
  if (visited_.begin()->second.freedom.sum() >= gates.values_for_memory) search();
  if (is_near_) judge_in_full();
  const double best = std::ranges::min_element(visited_, {}, [](const auto& each) {
                        return each.second.cost;
                      })->second.cost;
  double sum = 0.0;
  for (auto& [place, sizes] : visited_) {
    if (sizes.cost > best + kAllowed) continue;
    const double probability = std::isfinite(best) ? std::exp(-0.5 * (sizes.cost - best)) : 1.0;
    allowed_.push_back({probability, memory_at(place, values_, gates_.longest_memory), sizes});
    sum += probability;
  }
  for (Allowed& each : allowed_) each.probability /= sum;
}

FittedSizes PoolMemory::evaluate(const MemoryPlace& place, const Eigen::VectorXd& from) const {
  const ExponentialMixture covariance = memory_at(place, values_, gates_.longest_memory);
  std::vector<ProfileInformation> information;
  for (const ProfileLikelihood* profile : profiles_)
    information.push_back(is_near_ ? profile->nearly_under(covariance)
                                   : profile->under(covariance));
  FittedSizes out = fit_sizes(information, rest_, gates_.noise_likeness, from);
  out.cost += prior_cost(place, gates_.memory_odds);
  if (std::isnan(out.cost)) out.cost = INFINITY;  // more digits than the information has
  return out;
}

void PoolMemory::visit(const std::vector<MemoryPlace>& places, const Eigen::VectorXd& from) {
  std::set<MemoryPlace> unique(places.begin(), places.end());
  std::erase_if(unique,
                [&](const MemoryPlace& place) { return visited_.contains(place) || !fits(place); });
  const std::vector<MemoryPlace> fresh(unique.begin(), unique.end());
  std::vector<FittedSizes> found(fresh.size());
  parallel_for(fresh.size(), [&](std::size_t i) { found[i] = evaluate(fresh[i], from); });
  for (std::size_t i = 0; i < fresh.size(); ++i) visited_.emplace(fresh[i], std::move(found[i]));
}

bool PoolMemory::fits(const MemoryPlace& place) const {
  if (profiles_.size() == 1 && place.slope > kSteepestAlone) return false;
  return place.texture == 0 || length_at(place.length) <= gates_.longest_texture * values_;
}

MemoryPlace PoolMemory::most_probable() const {
  return std::ranges::min_element(visited_, {}, [](const auto& each) { return each.second.cost; })
      ->first;
}

/// Whether the plausible places are many enough to show how wide the likelihood is.
bool PoolMemory::is_resolved() const {
  const MemoryPlace best = most_probable();
  const double most = visited_.at(best).cost + kPlausible;
  const int parts = (best.texture > 0 ? 1 : 0) + (best.memory > 0 ? 1 : 0);
  const auto plausible =
      std::ranges::count_if(visited_, [&](const auto& each) { return each.second.cost <= most; });
  return plausible > 4 * parts;
}

/// To all that is plausible from where the search is, the best first.
void PoolMemory::explore(int step) {
  step_ = step;
  std::set<MemoryPlace> expanded;
  while (true) {
    const auto next = std::ranges::min_element(visited_, {}, [&](const auto& each) {
      return expanded.contains(each.first) ? INFINITY : each.second.cost;
    });
    if (!(next->second.cost <= visited_.at(most_probable()).cost + kWorthNeighbours) ||
        !expanded.insert(next->first).second)
      return;
    visit(neighbours(next->first, step), next->second.log_sizes);
  }
}

/// On finer lattices, as fine as the data resolve.
void PoolMemory::refine() {
  for (int step = kCoarse / 2; step > 0 && !is_resolved(); step /= 2) {
    const MemoryPlace best = most_probable();
    std::erase_if(visited_, [&](const auto& each) {
      return each.first != best && of_one_kind(each.first, best);
    });
    explore(step);
  }
}

/// From white noise, textures and long memories; then what the best lacks is added to it.
void PoolMemory::search() {
  const Eigen::VectorXd start = visited_.begin()->second.log_sizes;
  visit(with_texture({}), start);
  visit(with_memory({}), start);
  explore(kCoarse);
  refine();
  const MemoryPlace best = most_probable();
  const Eigen::VectorXd sizes = visited_.at(best).log_sizes;
  if (best.texture == 0) visit(with_texture(best), sizes);
  if (best.memory == 0) visit(with_memory(best), sizes);
  explore(kCoarse);
  refine();
}

void PoolMemory::judge_in_full() {
  const std::map<MemoryPlace, FittedSizes> near = std::exchange(visited_, {});
  is_near_ = false;
  std::vector<MemoryPlace> places;  // the best of each kind, and all that are allowed
  double best = INFINITY;
  for (const auto& [place, sizes] : near) best = std::min(best, sizes.cost);
  for (const auto& each : near) {
    const auto is_better = [&](const auto& other) {
      return of_one_kind(other.first, each.first) && other.second.cost < each.second.cost;
    };
    if (each.second.cost <= best + kAllowed || std::ranges::none_of(near, is_better))
      places.push_back(each.first);
  }
  visit(places, near.at(places.front()).log_sizes);
  explore(step_);
  refine();
}

const PoolMemory::Allowed& PoolMemory::best() const {
  return *std::ranges::max_element(allowed_, {}, &Allowed::probability);
}

}  // namespace slideway
