#include "local_forms.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "search.hpp"
#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

constexpr int kForms = 3;          // one after the other
constexpr int kPlacesOfForm = 40;  // over the travel
constexpr int kWidths = 5;         // from a place's distance to a third of the travel
constexpr int kRefinements = 2;    // each about the best form found so far, four times finer

struct LocalForm {
  enum class Kind { kink, bump, step } kind = Kind::kink;
  double place = 0.0, width = 1.0;

  [[nodiscard]] int unknowns() const { return kind == Kind::kink ? 2 : 3; }
  [[nodiscard]] double at(double x) const {
    const double u = (x - place) / width;
    switch (kind) {
      case Kind::kink:
        return std::max(x - place, 0.0);
      case Kind::bump:
        return std::exp(-0.5 * u * u);
      case Kind::step:
        return 0.5 * (1.0 + std::tanh(u));
    }
    return 0.0;
  }
};

std::vector<LocalForm> coarse_grid(double low, double high) {
  std::vector<LocalForm> out;
  const double range = high - low, widest = range / 3.0, narrowest = range / kPlacesOfForm;
  for (int i = 0; i < kPlacesOfForm; ++i) {
    const double place = low + range * (i + 0.5) / kPlacesOfForm;
    out.push_back({LocalForm::Kind::kink, place, 1.0});
    for (int w = 0; w < kWidths; ++w) {
      const double width = narrowest * std::pow(widest / narrowest, double(w) / (kWidths - 1));
      out.push_back({LocalForm::Kind::bump, place, width});
      out.push_back({LocalForm::Kind::step, place, width});
    }
  }
  return out;
}

/// Forms of the same kind about one, `spacing` apart in place and by a factor in width.
std::vector<LocalForm> about(const LocalForm& best, double spacing, double factor) {
  std::vector<LocalForm> out;
  const int widths = best.kind == LocalForm::Kind::kink ? 0 : 2;
  for (int i = -4; i <= 4; ++i)
    for (int w = -widths; w <= widths; ++w)
      out.push_back({best.kind, best.place + i * spacing, best.width * std::pow(factor, w)});
  return out;
}

/// A form held against the residual.
struct Fitted {
  LocalForm form;
  double gain = -INFINITY;  // nats
  Eigen::VectorXd unit;     // what it takes, of length 1
};

class LocalFormSearch {
 public:
  LocalFormSearch(const std::vector<Eigen::VectorXd>& x, const Whitened& data,
                  const Linearisation& linear)
      : data_(data), linear_(linear), x_(x) {
    low_ = high_ = x_.front()[0];
    for (const Eigen::VectorXd& each : x_)
      low_ = std::min(low_, each.minCoeff()), high_ = std::max(high_, each.maxCoeff());
  }

  double run() {
    if (!(low_ < high_)) return 0.0;
    const std::vector<LocalForm> grid = coarse_grid(low_, high_);
    Eigen::MatrixXd columns = columns_of(grid);
    Eigen::VectorXd residual = data_.residual();
    double total = 0.0, best_total = 0.0;
    for (int found = 0; found < kForms; ++found) {
      Fitted best = refined(best_of(grid, columns, residual), residual);
      if (!std::isfinite(best.gain)) break;
      total += best.gain;
      best_total = std::max(best_total, total);
      residual -= best.unit * best.unit.dot(residual);
      project_out(best.unit, columns);
      taken_.conservativeResize(data_.rows(), taken_.cols() + 1);
      taken_.rightCols(1) = best.unit;
    }
    return best_total;
  }

 private:
  /// White columns of forms outside the model and what was found before.
  [[nodiscard]] Eigen::MatrixXd columns_of(std::span<const LocalForm> forms) const {
    constexpr std::size_t kAtATime = 64;  // forms: what is put aside for them stays small
    Eigen::MatrixXd out(data_.rows(), std::ssize(forms));
    for (std::size_t first = 0; first < forms.size(); first += kAtATime) {
      const auto some = forms.subspan(first, std::min(kAtATime, forms.size() - first));
      out.middleCols(static_cast<Eigen::Index>(first), std::ssize(some)) = some_columns_of(some);
    }
    return out;
  }

  [[nodiscard]] Eigen::MatrixXd some_columns_of(std::span<const LocalForm> forms) const {
    Eigen::MatrixXd out = data_.outside(stack(linear_, std::ssize(forms), [&](std::size_t i) {
      Eigen::MatrixXd rows(x_[i].size(), std::ssize(forms));
      for (Eigen::Index j = 0; j < rows.cols(); ++j)
        rows.col(j) =
            x_[i].unaryExpr([&](double x) { return forms[static_cast<std::size_t>(j)].at(x); });
      rows *= low_band_scale(*linear_.observations[i]);
      return rows;
    }));
    if (taken_.cols() > 0) project_out(taken_, out);
    return out;
  }

  [[nodiscard]] Fitted best_of(std::span<const LocalForm> forms, const Eigen::MatrixXd& columns,
                               const Eigen::VectorXd& residual) const {
    constexpr double kOwn = 1e-6;  // of the largest column: less is rounding
    const Eigen::VectorXd squares = columns.colwise().squaredNorm();
    const Eigen::VectorXd products = columns.transpose() * residual;
    const double least = kOwn * kOwn * squares.maxCoeff();
    Fitted best;
    for (std::size_t j = 0; j < forms.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      if (!(squares[column] > least)) continue;
      const double gain = 0.5 * (products[column] * products[column] / squares[column] -
                                 penalty(data_, forms[j].unknowns()));
      if (gain > best.gain)
        best = {forms[j], gain, columns.col(column) / std::sqrt(squares[column])};
    }
    return best;
  }

  [[nodiscard]] Fitted refined(Fitted best, const Eigen::VectorXd& residual) const {
    double spacing = (high_ - low_) / kPlacesOfForm, factor = 1.5;
    for (int pass = 0; pass < kRefinements && std::isfinite(best.gain); ++pass) {
      spacing /= 4.0;
      factor = std::sqrt(factor);
      const std::vector<LocalForm> forms = about(best.form, spacing, factor);
      if (Fitted finer = best_of(forms, columns_of(forms), residual); finer.gain > best.gain)
        best = std::move(finer);
    }
    return best;
  }

  const Whitened& data_;
  const Linearisation& linear_;
  const std::vector<Eigen::VectorXd>& x_;
  Eigen::MatrixXd taken_;
  double low_ = 0.0, high_ = 0.0;
};

}  // namespace

double local_forms(const std::vector<Eigen::VectorXd>& x, const Whitened& data,
                   const Linearisation& linear) {
  return LocalFormSearch(x, data, linear).run();
}

}  // namespace slideway
