#include "form_text.hpp"

#include <algorithm>
#include <cmath>

#include "fit_numbers.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/uncertainty.hpp"

namespace slideway {
namespace {

constexpr double kReach = 6.0;      // standard uncertainties a pasted bound lies off, at least
constexpr double kNearby = 0.125;   // of the range of the search, at least
constexpr double kLogNearby = 3.0;  // the same as a factor, where the search is logarithmic
constexpr int kBoundDigits = 3;

/// What is left in the fitted profiles with a form beside the model, which moves to make room.
class RestWithForm {
 public:
  explicit RestWithForm(const FormAttempt& attempt) : attempt_(attempt) {
    const Whitened& data = view().data();
    const Eigen::MatrixXd span = model_span(view().linear());
    Eigen::MatrixXd all(span.rows(), span.cols() + columns().cols());
    all << span, columns();
    Eigen::MatrixXd target =
        stack(view().linear(), 1, [&](std::size_t i) { return view().linear().residuals[i]; });
    target.bottomRows(data.rows() - data.values()) = view().linear().prior_residuals;
    Eigen::MatrixXd white = all, white_target = target;
    data.whiten(white);
    data.whiten(white_target);
    const Eigen::VectorXd values = least_squares(white, white_target).values;
    rest_ = target - all * values;
    amplitudes_ = values.tail(columns().cols());
    const Eigen::Index shared = view().linear().prior_rows.cols();
    change_ = values.segment(span.cols() - shared, shared);
  }

  [[nodiscard]] std::optional<double> rms(Quantity quantity, double unit) const {
    double squares = 0.0, values = 0.0;
    for (std::size_t i = 0; i < view().data().observations(); ++i) {
      const Observation& observation = *view().linear().observations[i];
      if (observation.profile->setup.quantity != quantity) continue;
      squares += rest_.segment(view().data().first_row(i), view().data().count(i)).squaredNorm();
      values += static_cast<double>(observation.values.size() - observation.left_out());
    }
    if (values == 0.0) return std::nullopt;
    return std::sqrt(squares / values) / unit;
  }

  /// Of the held-out height profiles, each levelled as it comes: as holdout_rms_um(). None where
  /// the form has no finite value in one of them: an exponential far outside of the fitted range.
  [[nodiscard]] std::optional<double> holdout_rms() const {
    const FittedModel& fitted = view().fitted();
    double squares = 0.0;
    int count = 0;
    for (const Observation& each : fitted.model.observations) {
      if (each.profile->role != Role::holdout || each.profile->setup.quantity != Quantity::height)
        continue;
      Eigen::VectorXd rest = each.values - model_values(fitted.model, each, fitted.fit.estimate) -
                             linear_columns(fitted.model, fitted.fit.estimate, each) * change_ -
                             low_band_columns(fitted.model, attempt_.refined.candidate->term, each,
                                              attempt_.refined.shape) *
                                 amplitudes_;
      if (each.nuisances.cols() > 0) rest -= each.nuisances * fitted_nuisances(each, rest);
      squares += rest.squaredNorm() / static_cast<double>(each.low_band.samples());
      ++count;
    }
    if (count == 0 || !std::isfinite(squares)) return std::nullopt;
    return std::sqrt(squares / count) / kMicrometre;
  }

 private:
  [[nodiscard]] const CoarseView& view() const { return *attempt_.view; }
  [[nodiscard]] const Eigen::MatrixXd& columns() const { return attempt_.refined.columns; }

  const FormAttempt& attempt_;
  Eigen::VectorXd rest_, amplitudes_, change_;
};

std::string in_quotes(const std::string& text) { return "\"" + text + "\""; }

/// "bump + step" over x: bump_and_step_of_x.
std::string identifier_of(std::string form, const std::string& variable) {
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = form.find(from, at)) != std::string::npos; at += to.size())
      form.replace(at, from.size(), to);
  };
  replace(" + ", "_and_");
  replace(" * ", "_times_");
  replace(" ", "_");
  return form + "_of_" + variable;
}

/// Bounds about a fitted shape, within those of the search.
std::pair<double, double> bounds_about(double value, double uncertainty, double lower,
                                       double upper) {
  const bool logarithmic = lower > 0.0 && upper > kLogNearby * kLogNearby * lower;
  double low = value - kNearby * (upper - lower), high = value + kNearby * (upper - lower);
  if (logarithmic) low = value / kLogNearby, high = value * kLogNearby;
  return {std::max(lower, std::min(low, value - kReach * uncertainty)),
          std::min(upper, std::max(high, value + kReach * uncertainty))};
}

std::string block(const FormAttempt& attempt, const std::string& name, const std::string& formula,
                  const std::vector<std::string>& profiles) {
  const Refined& refined = attempt.refined;
  const Effect& effect = *refined.candidate->term.effect;
  std::vector<std::string> parameters;
  for (std::size_t p = 0; p < effect.parameters().size(); ++p) {
    const Parameter& parameter = effect.parameters()[p];
    std::string unit = parameter.unit;
    if (unit.starts_with("µ")) unit.replace(0, std::string("µ").size(), "u");
    std::string text = "  { name = " + in_quotes(parameter.name) + ", unit = " + in_quotes(unit);
    if (p >= static_cast<std::size_t>(effect.amplitudes())) {
      const auto index = static_cast<Eigen::Index>(p);
      const auto [low, high] = bounds_about(refined.values[index], refined.uncertainties[index],
                                            parameter.lower, parameter.upper);
      text += ", lower = " + significant(low, kBoundDigits) +
              ", upper = " + significant(high, kBoundDigits);
    }
    parameters.push_back(text + " },\n");
  }
  std::vector<std::string> names;
  for (const std::string& profile : profiles) names.push_back(in_quotes(profile));
  return "[[trace.candidate]]\nname = \"formula\"\nas = " + in_quotes(name) +
         "\nformula = " + in_quotes(formula) + "\nparameters = [\n" + joined(parameters, "") +
         "]\n" + (names.empty() ? "" : "profiles = [" + joined(names) + "]\n") +
         "cause = " + in_quotes(kUnknownCause) + "\n";
}

}  // namespace

UnnamedForm told(const FormAttempt& attempt, const FormVariable& variable,
                 const std::vector<AcceptedEffect>& effects, const ModelResult& before) {
  const Refined& refined = attempt.refined;
  const ModelTerm& term = refined.candidate->term;
  const std::string name = identifier_of(attempt.form, variable.name);
  UnnamedForm out;
  out.form = attempt.form;
  out.formula = term.effect->description().formula;
  out.profiles = term.profiles;
  if (attempt.instead_of) out.instead_of = effects[*attempt.instead_of].name();
  for (std::size_t p = 0; p < term.effect->parameters().size(); ++p) {
    const Parameter& known = term.effect->parameters()[p];
    FittedParameter& parameter = out.parameters.emplace_back();
    parameter.name = name + "." + known.name;
    parameter.symbol = known.symbol;
    parameter.unit = known.unit;
    parameter.value = refined.values[static_cast<Eigen::Index>(p)];
    const double u = refined.uncertainties[static_cast<Eigen::Index>(p)];
    parameter.standard_uncertainty = u;
    parameter.coverage_factor = coverage_factor(std::nullopt);
    parameter.expanded_uncertainty = *parameter.coverage_factor * u;
  }
  out.delta_bic = attempt.delta_bic;
  const RestWithForm rest(attempt);
  out.before_rms_um = before.rms_um;
  out.before_rms_urad = before.rms_urad;
  out.after_rms_um = rest.rms(Quantity::height, kMicrometre);
  out.after_rms_urad = rest.rms(Quantity::slope, kMicroradian);
  if (const std::optional<double> held_out = holdout_rms_um(before)) {
    out.before_holdout_rms_um = held_out;
    out.after_holdout_rms_um = rest.holdout_rms();
  } else if (attempt.held_out) {
    out.before_holdout_rms_um = attempt.held_out->before_um;
    out.after_holdout_rms_um = attempt.held_out->after_um;
  }
  out.candidate = block(attempt, name, out.formula, out.profiles);
  return out;
}

}  // namespace slideway
