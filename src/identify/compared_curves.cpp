#include "compared_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/low_band_lines.hpp"
#include "slideway/identify/straightness.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kCurvePoints = 101;

/// Where both profiles have readings of the slide, a bridge from foot to foot.
SlideRange common_travel(const Model& model, const Profile& a, const Profile& b) {
  SlideRange out{-INFINITY, INFINITY};
  for (const Profile* profile : {&a, &b}) {
    const SlideRange own = slide_range(*profile, model.machine);
    const double foot = profile->setup.base_mm.value_or(0.0) / 2.0;
    out.least = std::max(out.least, own.least - foot);
    out.greatest = std::min(out.greatest, own.greatest + foot);
  }
  return out;
}

/// Low band of an effect in one profile, as far as levelling leaves it, at most kCurvePoints rows.
Eigen::MatrixXd levelled_curve(const Linearisation& linear, std::size_t i, const ModelTerm& term) {
  const Eigen::MatrixXd columns =
      linear.columns[i].middleCols(term.first_amplitude, term.effect->amplitudes());
  Eigen::MatrixXd all = levelled(*linear.observations[i], columns);
  clear_rounding(all, columns.colwise().norm());
  const Eigen::Index count = std::min(kCurvePoints, all.rows());
  Eigen::MatrixXd out(count, all.cols());
  for (Eigen::Index row = 0; row < count; ++row) out.row(row) = all.row(row * all.rows() / count);
  return out;
}

/// Whether each cut has its own size of an effect, so that it cannot be compared: the marks of the
/// tool, and waves too fine for the low band of one of these profiles. The nose of the tool takes
/// off their crests, more of them the smaller the feed.
bool is_of_each_cut(const Model& model, const Solution& fit, const ModelTerm& term,
                    std::span<const Observation* const> observations) {
  return term.effect->description().kinematic ||
         is_too_fine(model, term, shapes_of(term, fit.estimate.shapes), observations);
}

}  // namespace

std::vector<Eigen::Index> columns_of_each_cut(const Model& model, const Solution& fit) {
  const Eigen::Index amplitudes = fit.estimate.amplitudes.size();
  std::vector<Eigen::Index> out;
  for (const ModelTerm& term : model.terms) {
    if (!is_of_each_cut(model, fit, term, fit.linear.observations)) continue;
    for (int a = 0; a < term.effect->amplitudes(); ++a) out.push_back(term.first_amplitude + a);
    for (Eigen::Index s = 0; s < std::ssize(term.effect->shapes()); ++s)
      out.push_back(amplitudes + term.first_shape + s);
  }
  return out;
}

std::vector<ComparedCurve> compared_curves(const Model& model, const Solution& fit, std::size_t a,
                                           std::size_t b) {
  std::vector<ComparedCurve> out;
  const auto& observations = fit.linear.observations;
  for (const ModelTerm& term : model.terms) {
    if (is_of_each_cut(model, fit, term, std::array{observations[a], observations[b]})) continue;
    const bool of_slide = term.effect->description().motion == MotionError::straightness;
    const Eigen::MatrixXd own =
        of_slide ? deviations_from_ends(
                       model, term, fit,
                       common_travel(model, *observations[a]->profile, *observations[b]->profile),
                       kCurvePoints - 2)
                 : levelled_curve(fit.linear, a, term);
    if (own.size() == 0 || own.cwiseAbs().maxCoeff() == 0.0) continue;
    ComparedCurve curve{term.name, Eigen::MatrixXd::Zero(own.rows(), fit.linear.prior_rows.cols()),
                        of_slide};
    curve.rows.middleCols(term.first_amplitude, own.cols()) = own;
    out.push_back(std::move(curve));
  }
  return out;
}

}  // namespace slideway
