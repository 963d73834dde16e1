#include "slideway/identify/agreement.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "compared_curves.hpp"
#include "reported.hpp"
#include "slideway/base/distribution.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/noise_model.hpp"
#include "slideway/identify/subset_estimate.hpp"
#include "slideway/identify/uncertainty.hpp"
#include "tube_formula.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostPairwise = 8;  // profiles: 28 pairs a reader still reads
constexpr double kOutside = 1e-6;         // of a row: less along a null direction is rounding
constexpr const char* kAllOthers = "all others";
constexpr const char* kTogether = "effects taken together";

using Profiles = std::vector<std::size_t>;  // of the fitted ones

/// A side of a comparison, with what is known of its noise.
struct Alone : SubsetEstimate {
  Profiles profiles;
  Eigen::MatrixXd of_priors;  // #priors by #basis: their rows along the basis
  double freedom = 0.0;       // of the noise
  DataFit of_data;            // without the priors

  /// @param of_others  columns that take what they can of the rows: they say nothing of another
  /// side
  Alone(const Linearisation& linear, const std::vector<Noise>& noise, const Compressed& all,
        const Profiles& which, const std::vector<Eigen::Index>& of_others, double tolerance)
      : SubsetEstimate(linear, all, which, tolerance),
        profiles(which),
        of_priors(linear.prior_rows * basis) {
    const auto free =
        static_cast<double>(std::max(basis.cols() - of_priors.rows(), Eigen::Index{0}));
    double known = 0.0;
    for (std::size_t i = 0; i < noise.size(); ++i) {
      const bool is_sister = std::ranges::any_of(
          which, [&](std::size_t own) { return noise[own].pool == noise[i].pool; });
      if (is_sister) known += std::max(0.0, noise[i].effective_values() - free);
    }
    for (const std::size_t i : which) {
      const double spread = noise[i].log_long_run_variance();
      freedom += spread > 0.0 ? 2.0 / spread : HUGE_VAL;
    }
    if (std::isfinite(freedom)) freedom = std::clamp(freedom, 1.0, std::max(1.0, known));
    const Eigen::MatrixXd taken = orthonormal(rows(Eigen::all, of_others));
    project_out(taken, rows);
    of_data = DataFit(rows.bottomRows(rows.rows() - of_priors.rows()), scale, tolerance);
  }

  [[nodiscard]] bool determines(const Eigen::MatrixXd& curve) const {
    const Eigen::MatrixXd open = curve * null_space;
    for (Eigen::Index d = 0; d < open.cols(); ++d)
      if (open.col(d).norm() > kOutside * curve.norm() * null_space.col(d).norm()) return false;
    return true;
  }
};

/// Two sides of a comparison, and what they are called.
struct Pair {
  const Alone& a;
  const Alone& b;
  std::vector<std::string> names;
  std::vector<ComparedCurve> curves;  // that both determine
};

/// Rows whose products are the covariance of the difference of two sides along a curve. With the
/// covariances A Aᵀ and B Bᵀ under the priors R, that is A Aᵀ + B Bᵀ less A (R A)ᵀ (R B) Bᵀ and its
/// transpose: what both have from the priors does not differ.
Eigen::MatrixXd difference_root(const Pair& pair, const Eigen::MatrixXd& of_a,
                                const Eigen::MatrixXd& of_b) {
  Eigen::MatrixXd both(of_a.rows(), of_a.cols() + of_b.cols());
  both << of_a, of_b;
  if (pair.a.of_priors.rows() == 0) return both;
  const Eigen::MatrixXd common =
      of_a * (pair.a.of_priors.transpose() * pair.b.of_priors) * of_b.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(both * both.transpose() - common -
                                                             common.transpose());
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// The largest difference along a curve, in standard uncertainties, with what its limit depends on.
struct Largest {
  double difference = 0.0, freedom = 0.0, length = 0.0;
};

/// None where the two sides cannot differ: both have the curve from the same priors.
std::optional<Largest> largest_difference(const Pair& pair, const ComparedCurve& curve) {
  constexpr double kNothing = 1e-12;  // of the largest variance: the ends of a levelled curve
  const Eigen::MatrixXd of_a = curve.rows * pair.a.basis, of_b = curve.rows * pair.b.basis,
                        both = difference_root(pair, of_a, of_b);
  const Eigen::VectorXd variance_a = of_a.rowwise().squaredNorm(),
                        variance_b = of_b.rowwise().squaredNorm(),
                        variance = both.rowwise().squaredNorm();
  if (!(variance.maxCoeff() > kNothing * (variance_a + variance_b).maxCoeff())) return std::nullopt;
  const double least = kNothing * variance.maxCoeff();
  const Eigen::VectorXd difference = curve.rows * (pair.a.change - pair.b.change);
  Eigen::Index at = 0;
  Largest out;
  out.difference =
      std::sqrt(difference.cwiseAbs2().cwiseQuotient(variance.cwiseMax(least)).maxCoeff(&at));
  out.freedom =
      std::pow(variance_a[at] + variance_b[at], 2) /
      (std::pow(variance_a[at], 2) / pair.a.freedom + std::pow(variance_b[at], 2) / pair.b.freedom);
  out.length = path_length(both, variance, least);
  return out;
}

/// Appends the end-point straightness of a slide as one side has it, and its U.
/// @param joint  (amplitudes, shapes) of the fit of all profiles
void add_straightness(const ComparedCurve& curve, const Alone& side, const Eigen::VectorXd& joint,
                      ProfileCheck& out) {
  const Eigen::VectorXd deviations = curve.rows * (joint + side.change);
  Eigen::RowVectorXd range = Eigen::RowVectorXd::Zero(curve.rows.cols());
  Eigen::Index at = 0;  // at the ends of the travel the deviation is 0
  if (deviations.maxCoeff(&at) > 0.0) range += curve.rows.row(at);
  if (deviations.minCoeff(&at) < 0.0) range -= curve.rows.row(at);
  const std::optional<double> freedom =
      std::isfinite(side.freedom) ? std::optional(side.freedom) : std::nullopt;
  out.value_um.push_back(range.dot(joint + side.change) / kMicrometre);
  out.U_um.push_back(coverage_factor(freedom) * (range * side.basis).norm() / kMicrometre);
}

/// Variance of the logarithm of the size of the noise of some profiles together: pools err
/// independently.
double log_variance(const std::vector<Noise>& noise, const std::vector<const Alone*>& sides) {
  std::map<std::size_t, double> of_pools;  // the sums over their profiles
  double count = 0.0;
  for (const Alone* side : sides)
    for (const std::size_t i : side->profiles) {
      of_pools[noise[i].pool] += std::sqrt(noise[i].log_long_run_variance());
      count += 1.0;
    }
  double out = 0.0;
  for (const auto& [pool, sum] : of_pools) out += std::pow(sum / count, 2);
  return out;
}

/// χ² of the data of several sides being one, near a gamma variable as in LackOfFit.
struct Oneness {
  double chi2 = 0.0, count = 0.0;   // over its degrees of freedom
  double shape = 0.0, scale = 1.0;  // of the gamma variable

  Oneness(const std::vector<Noise>& noise, const std::vector<const Alone*>& sides,
          double rank_tolerance) {
    Eigen::Index size = 0;
    for (const Alone* side : sides) size += side->of_data.rows.rows();
    Eigen::MatrixXd rows(size, sides.front()->rows.cols());
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(rows.cols() - 1);
    double apart = 0.0;
    for (Eigen::Index first = 0; const Alone* side : sides) {
      const DataFit& own = side->of_data;
      rows.middleRows(first, own.rows.rows()) = own.rows;
      first += own.rows.rows();
      apart += own.left;
      squares += side->scale.cwiseAbs2();
      count += static_cast<double>(own.rank);
    }
    const DataFit together(rows, squares.cwiseSqrt(), rank_tolerance);
    count -= static_cast<double>(together.rank);
    if (count < 1.0) return;
    chi2 = std::max(0.0, together.left - apart) / count;
    const double spread = std::min(log_variance(noise, sides), 1.0);
    const double mean = std::exp(0.5 * spread);
    const double variance = mean * mean * (2.0 / count + std::expm1(spread));
    shape = mean * mean / variance;
    scale = variance / mean;
  }

  [[nodiscard]] double p_value() const { return gamma_tail(shape, chi2 / scale); }

  /// E_n where noise is to exceed 1 with a given probability.
  [[nodiscard]] double en(double outside) const {
    return std::sqrt(2.0 * chi2 / (scale * chi_squared_quantile(2.0 * shape, 1.0 - outside)));
  }
};

void set_chi_square(const Oneness& oneness, ProfileCheck& out) {
  if (oneness.count < 1.0) return;
  out.chi2 = oneness.chi2;
  out.p_value = oneness.p_value();
}

/// The pairs to be compared, with the curves that both sides determine. The noise is that of
/// each by itself: what profiles disagree by is not in it.
class ProfileComparison {
 public:
  ProfileComparison(const Model& model, const Solution& fit, const std::vector<Noise>& noise)
      : model_(model), fit_(fit), noise_(noise) {
    const Compressed compressed = compress(fit.linear, noise);
    const std::size_t count = fit.linear.observations.size();
    const bool pairwise = count <= kMostPairwise;
    const std::vector<Eigen::Index> of_each_cut = columns_of_each_cut(model, fit);
    const auto side = [&](const Profiles& which) {
      return Alone(fit.linear, noise, compressed, which, of_each_cut, model.gates.rank_tolerance);
    };
    for (std::size_t i = 0; i < count; ++i) alone_.push_back(side({i}));
    if (!pairwise) others_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i + 1; pairwise && j < count; ++j)
        add(i, j, alone_[j], fit.linear.observations[j]->profile->name);
      if (pairwise) continue;
      Profiles rest;
      for (std::size_t j = 0; j < count; ++j)
        if (j != i) rest.push_back(j);
      others_.push_back(side(rest));
      add(i, rest.front(), others_.back(), kAllOthers);
    }
  }

  [[nodiscard]] std::vector<ProfileCheck> checks() const {
    const std::optional<Oneness> all = of_all();
    std::vector<std::pair<ProfileCheck, Largest>> compared;
    Eigen::VectorXd joint(fit_.estimate.amplitudes.size() + fit_.estimate.shapes.size());
    joint << fit_.estimate.amplitudes, fit_.estimate.shapes;
    const Gates& gates = model_.gates;
    for (const Pair& pair : pairs_) {
      const Oneness oneness(noise_, {&pair.a, &pair.b}, gates.rank_tolerance);
      for (const ComparedCurve& curve : pair.curves) {
        const std::optional<Largest> largest = largest_difference(pair, curve);
        if (!largest) continue;
        ProfileCheck check{pair.names, curve.what};
        set_chi_square(oneness, check);
        if (curve.of_slide)
          for (const Alone* side : {&pair.a, &pair.b}) add_straightness(curve, *side, joint, check);
        compared.emplace_back(std::move(check), *largest);
      }
    }
    const auto comparisons = static_cast<double>(compared.size() + (all ? 1 : 0));
    const double outside = -std::expm1(std::log1p(-gates.false_disagreement) / comparisons);
    const auto judge = [&](double en, ProfileCheck& check) {
      check.En = en;
      check.verdict = en <= gates.en_limit ? Consistency::consistent : Consistency::inconsistent;
    };
    std::vector<ProfileCheck> out;
    for (auto& [check, largest] : compared) {
      judge(largest.difference / simultaneous_factor(largest.length, largest.freedom, outside),
            check);
      out.push_back(std::move(check));
    }
    if (!all) return out;
    ProfileCheck& together = out.emplace_back();
    for (const Observation* each : fit_.linear.observations)
      together.profiles.push_back(each->profile->name);
    together.what = kTogether;
    judge(all->en(outside), together);
    set_chi_square(*all, together);
    return out;
  }

 private:
  /// Of three profiles or more at once: small differences of each pair add up.
  [[nodiscard]] std::optional<Oneness> of_all() const {
    if (alone_.size() < 3 || pairs_.empty()) return std::nullopt;
    std::vector<const Alone*> sides;
    for (const Alone& side : alone_) sides.push_back(&side);
    Oneness out(noise_, sides, model_.gates.rank_tolerance);
    return out.count < 1.0 ? std::nullopt : std::optional(out);
  }

  void add(std::size_t i, std::size_t j, const Alone& other, const std::string& name) {
    Pair pair{alone_[i], other, {fit_.linear.observations[i]->profile->name, name}, {}};
    for (ComparedCurve& curve : compared_curves(model_, fit_, i, j))
      if (alone_[i].determines(curve.rows) && other.determines(curve.rows))
        pair.curves.push_back(std::move(curve));
    if (!pair.curves.empty()) pairs_.push_back(std::move(pair));
  }

  const Model& model_;
  const Solution& fit_;
  const std::vector<Noise>& noise_;
  std::vector<Alone> alone_, others_;
  std::vector<Pair> pairs_;
};

}  // namespace

std::vector<ProfileCheck> check_profiles(const Model& model, const Solution& fit,
                                         const std::vector<Noise>& of_each) {
  if (fit.linear.observations.size() < 2 || fit.linear.prior_rows.cols() == 0) return {};
  return ProfileComparison(model, fit, of_each).checks();
}

std::string odd_profile(std::set<std::vector<std::string>> pairs) {
  std::erase_if(pairs, [](const std::vector<std::string>& names) { return names.size() > 2; });
  std::vector<std::string> common = pairs.empty() ? std::vector<std::string>() : *pairs.begin();
  std::erase(common, kAllOthers);
  for (const std::vector<std::string>& names : pairs)
    std::erase_if(common, [&](const auto& each) { return std::ranges::count(names, each) == 0; });
  return common.size() == 1 ? common.front() : "";
}

Eigen::MatrixXd scatter_of_profiles(const Solution& fit, const Gates& gates) {
  const Compressed compressed = compress(fit.linear, fit.noise);
  const std::size_t count = fit.linear.observations.size();
  Eigen::MatrixXd out(fit.linear.prior_rows.cols(), static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    Profiles others;
    for (std::size_t j = 0; j < count; ++j)
      if (j != i) others.push_back(j);
    out.col(static_cast<Eigen::Index>(i)) =
        SubsetEstimate(fit.linear, compressed, others, gates.rank_tolerance).change;
  }
  out.colwise() -= out.rowwise().mean().eval();
  const auto n = static_cast<double>(count);
  return std::sqrt((n - 1.0) / n) * out;
}

std::optional<std::string> conflict_of_priors(const Model& model, const Solution& fit) {
  constexpr double kUnlikely = 0.01;
  constexpr double kTold = 1e-6;  // of a prior's variance, by the profiles and the other priors
  const Eigen::Index count = fit.linear.prior_residuals.size() - fit.linear.curve_rows;
  if (count == 0) return std::nullopt;
  const Eigen::MatrixXd rows = fit.linear.prior_rows.topRows(count) * fit.uncertainty.basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(
      Eigen::MatrixXd::Identity(count, count) -
      rows * fit.uncertainty.covariance * rows.transpose());
  const Eigen::VectorXd along =
      parts.eigenvectors().transpose() * fit.linear.prior_residuals.head(count);
  double chi_square = 0.0, freedom = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!(parts.eigenvalues()[i] > kTold)) continue;
    chi_square += along[i] * along[i] / parts.eigenvalues()[i];
    freedom += 1.0;
  }
  if (freedom == 0.0 || chi_squared_tail(freedom, chi_square) >= kUnlikely) return std::nullopt;
  std::vector<std::string> names;
  for (const ModelTerm& term : model.terms)
    for (const Prior& prior : term.priors)
      if (const std::string name = term.name + "." + prior.parameter;
          std::ranges::count(names, name) == 0)
        names.push_back(name);
  return "the priors (" + joined(names) + ") contradict the data or one another: chi-square " +
         significant(chi_square, 2) + " for " + significant(freedom, 3) +
         "; U holds only if all of them are right";
}

}  // namespace slideway
