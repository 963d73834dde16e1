#include "slideway/report/compensation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/report/document.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {

constexpr double kPieces = 50.0;  // of the travel, where no step is asked for
constexpr double kMost = 5000.0;
constexpr Eigen::Index kSamples = 51;  // of the travel, to see what a parameter changes
constexpr double kRounding = 1e-9;     // of the rise a parameter makes

using Parameters = std::vector<FittedParameter>;

bool is_determined(const FittedParameter& p) { return p.identifiable && p.value; }

/// Parameters of the effect that is this error of the carriages.
Parameters parameters_of(const Parameters& all, MotionError error) {
  Parameters out;
  std::ranges::copy_if(all, std::back_inserter(out),
                       [&](const FittedParameter& p) { return motion_error_of(p.name) == error; });
  return out;
}

std::string effect_name(const FittedParameter& p) { return p.name.substr(0, p.name.find('.')); }

/// The tool tip's deviation in Z that the straightness makes, mm: what the carriage rises minus the
/// lever p_x times what it pitches.
class TipLocus {
 public:
  TipLocus(const Parameters& parameters, const TravelSummary& travel)
      : travel_(travel), parameters_(parameters_of(parameters, MotionError::straightness)) {
    if (parameters_.empty()) return;
    std::vector<std::string> names;
    const std::string name = effect_name(parameters_.front());
    for (const FittedParameter& p : parameters_) names.push_back(p.name.substr(name.size() + 1));
    effect_ =
        make_effect_with(name, names, machine_,
                         {.slide_min = travel.slide_min_mm, .slide_max = travel.slide_max_mm});
    amplitudes_ = Eigen::VectorXd::Zero(effect_->amplitudes());
    for (const FittedParameter& p : parameters_)
      if (is_determined(p)) amplitudes_ += *p.value * unit_of(p);
  }

  [[nodiscard]] bool is_declared() const { return effect_ != nullptr; }

  /// Deviations at slide coordinates.
  [[nodiscard]] Eigen::VectorXd at(const Eigen::VectorXd& x) const { return tip(x, amplitudes_); }

  /// Symbols of what the data do not determine and would change the form, as seen from the line
  /// through its end points, or that line's slope.
  [[nodiscard]] std::vector<std::string> undetermined(bool slope) const {
    const Eigen::VectorXd x =
        Eigen::VectorXd::LinSpaced(kSamples, travel_.slide_min_mm, travel_.slide_max_mm);
    std::vector<std::string> symbols;
    for (const FittedParameter& p : parameters_) {
      if (is_determined(p)) continue;
      const Eigen::VectorXd unit = unit_of(p);
      const double size = (rises(x, Quantity::height) * unit).cwiseAbs().maxCoeff();
      const Eigen::VectorXd z = tip(x, unit);
      const double rise = z[z.size() - 1] - z[0];
      const Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(z.size(), z[0], z[z.size() - 1]);
      const double change = slope ? std::abs(rise) : (z - line).cwiseAbs().maxCoeff();
      if (change > kRounding * size) symbols.push_back(p.symbol);
    }
    return symbols;
  }

 private:
  [[nodiscard]] double lever(double x) const {
    if (!travel_.spindle_position_mm) return 0.0;  // read along the slide itself
    return travel_.lever == "paper" ? x - *travel_.spindle_position_mm
                                    : travel_.overhang_mm.value_or(0.0);
  }

  [[nodiscard]] Eigen::MatrixXd rises(const Eigen::VectorXd& x, Quantity quantity) const {
    return along_slide(*effect_, machine_, x, quantity);
  }

  [[nodiscard]] Eigen::VectorXd tip(const Eigen::VectorXd& x,
                                    const Eigen::VectorXd& amplitudes) const {
    const Eigen::VectorXd levers = x.unaryExpr([this](double at) { return lever(at); });
    return rises(x, Quantity::height) * amplitudes -
           levers.cwiseProduct(rises(x, Quantity::slope) * amplitudes);
  }

  /// Amplitudes where this parameter is 1 and all others are 0.
  [[nodiscard]] Eigen::VectorXd unit_of(const FittedParameter& p) const {
    const std::vector<Parameter>& all = effect_->parameters();
    const std::string own = p.name.substr(p.name.find('.') + 1);
    const auto index = std::ranges::find(all, own, &Parameter::name) - all.begin();
    return effect_->from_parameters(Eigen::VectorXd::Unit(std::ssize(all), index));
  }

  const TravelSummary& travel_;
  Machine machine_{Machine::paper_lathe(), Lever::paper};
  Parameters parameters_;
  std::unique_ptr<Effect> effect_;
  Eigen::VectorXd amplitudes_;
};

std::vector<double> evenly(const TravelSummary& travel, double step_mm) {
  const double length = travel.slide_max_mm - travel.slide_min_mm;
  if (!(length > 0.0)) throw DataError("travel: has no length; nothing can be tabled");
  if (!(step_mm >= 0.0) || std::isinf(step_mm))
    throw UsageError("step: must be above 0 mm; 0 is a fiftieth of the travel");
  const double pieces = step_mm > 0.0 ? std::ceil(length / step_mm * (1.0 - 1e-12)) : kPieces;
  if (!(pieces < kMost))
    throw UsageError("step: " + significant(step_mm, 3) + " mm makes more than " +
                     significant(kMost, 4) + " positions of " + significant(length, 6) +
                     " mm of travel");
  std::vector<double> positions;
  for (double i = 0.0; i <= pieces; i += 1.0)
    positions.push_back(travel.slide_min_mm + length * i / pieces);
  return positions;
}

double rms_about_mean(const std::vector<double>& values) {
  double mean = 0.0, squares = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

/// Why what has no name forbids a correction of that form; "": it does not.
std::string drowned(const Analysis& analysis, const Compensation& table,
                    const std::vector<double>& form) {
  if (!analysis.trace || !analysis.trace->unnamed) return "";
  const Unnamed& left = *analysis.trace->unnamed;
  const bool slope = left.unit == "urad";
  std::vector<double> seen = form;
  if (slope) {
    const double step = table.positions_mm[1] - table.positions_mm[0];
    for (std::size_t i = 0; i + 1 < form.size(); ++i) seen[i] = (form[i + 1] - form[i]) / step;
    seen.pop_back();
  }
  const double size = rms_about_mean(seen) / (slope ? kMicroradian : kMicrometre);
  if (left.rms < size) return "";
  const std::string unit = slope ? " µrad" : " µm";
  return "the loop leaves " + significant(left.rms, 3) + unit +
         " rms without a name, no less than its own " + significant(size, 3) + unit;
}

void refuse_whole(const Analysis& analysis) {
  const auto refuse = [](const std::string& why) { throw DataError("no table: " + why); };
  if (!analysis.result.fit) refuse("the report holds no fit; accepted: one of identify or fit");
  if (!analysis.result.fit->converged) refuse("the fit did not converge");
  if (!analysis.result.travel)
    refuse("the report says no travel, being of an older slideway; identify the problem again");
  for (const FittedParameter& p : final_parameters(analysis))
    if (motion_error_of(p.name) != MotionError::none && effect_name(p).ends_with(']'))
      refuse("several carriages move along X; accepted: a machine with one");
  if (analysis.trace && analysis.trace->verdict == "not_identifiable")
    refuse(
        "the closed loop's verdict is not_identifiable: the data cannot tell what made the form");
}

/// Sets E_ZX, or says why not. @return the slope of its reference line.
double add_straightness(const Analysis& analysis, const TipLocus& locus, Compensation& out) {
  const auto leave_out = [&](const std::string& why) {
    out.left_out.push_back("EZX is left out: " + why);
    return 0.0;
  };
  const TravelSummary& travel = *analysis.result.travel;
  if (!locus.is_declared()) return leave_out("the model has no straightness");
  if (const auto names = locus.undetermined(false); !names.empty())
    return leave_out("the data do not determine " + joined(names));
  if (travel.spindle_position_mm && travel.lever == "split" && !travel.overhang_mm)
    return leave_out("the faces were cut at several overhangs, and its pitch acts on each");
  const std::string& implausible = analysis.result.fit->implausible;
  if (!implausible.empty() && (!analysis.trace || analysis.trace->rounds.empty()))
    return leave_out(implausible);

  const double first = out.positions_mm.front(), last = out.positions_mm.back();
  const Eigen::VectorXd ends = locus.at(Eigen::Vector2d(first, last));
  const double slope = (ends[1] - ends[0]) / (last - first);
  const auto deviations = [&](const std::vector<double>& x) {
    const Eigen::Map<const Eigen::VectorXd> at(x.data(), std::ssize(x));
    const Eigen::VectorXd z = (locus.at(at) - slope * at).array() - ends[0] + slope * first;
    return std::vector<double>(z.begin(), z.end());
  };
  std::vector<double> form = deviations(out.positions_mm), between;
  form.front() = form.back() = 0.0;
  for (std::size_t i = 0; i + 1 < form.size(); ++i)
    between.push_back((out.positions_mm[i] + out.positions_mm[i + 1]) / 2.0);
  between = deviations(between);
  for (std::size_t i = 0; i < between.size(); ++i)
    out.interpolation_mm =
        std::max(out.interpolation_mm, std::abs(between[i] - (form[i] + form[i + 1]) / 2.0));
  if (const std::string why = drowned(analysis, out, form); !why.empty()) return leave_out(why);
  out.straightness_mm = std::move(form);
  const std::string lever = !travel.spindle_position_mm ? ", of the carriage"
                            : travel.lever == "paper"
                                ? ", at the tool tip, with the pitch on the lever p_x = r"
                                : ", at the tool tip, with the pitch on the overhang of " +
                                      significant(*travel.overhang_mm, 6) + " mm";
  out.basis.push_back("EZX: straightness error motion of X in the direction Z, mm" + lever +
                      "; reference line: through the end points of the travel");
  return slope;
}

void add_squareness(const Analysis& analysis, const TipLocus& locus, double slope,
                    Compensation& out) {
  const auto leave_out = [&](const std::string& why) {
    out.left_out.push_back("B0X is left out: " + why);
  };
  const Parameters squareness = parameters_of(final_parameters(analysis), MotionError::squareness);
  if (squareness.empty()) return leave_out("the model has no squareness");
  const FittedParameter* found = &squareness.front();
  if (!is_determined(*found)) return leave_out("the data do not determine " + found->symbol);
  if (!out.straightness_mm.empty())
    if (const auto names = locus.undetermined(true); !names.empty())
      return leave_out("the data do not determine " + joined(names));
  const auto& check = analysis.result.squareness;
  if (check && check->verdict == "inconsistent")
    return leave_out("the cross-check with the run-out is inconsistent (E_n " +
                     (check->En ? significant(*check->En, 3) : "unknown") + ")");
  const double angle = *found->value - slope;
  std::vector<double> cone;
  for (const double x : out.positions_mm) cone.push_back(-angle * x);
  if (const std::string why = drowned(analysis, out, cone); !why.empty()) return leave_out(why);
  out.squareness_rad = angle;
  out.basis.push_back(
      "B0X: squareness of X to the spindle axis average line, E_B(0C)X, rad: Δβxz = " +
      (found->expanded_uncertainty ? with_uncertainty(*found->value, *found->expanded_uncertainty) +
                                         " (U, k = " + fixed_point(found->coverage_factor, 2) + ")"
                                   : significant(*found->value, 6)) +
      (out.straightness_mm.empty()
           ? ""
           : " minus " + significant(slope, 6) + ", the slope of EZX's reference line"));
}

}  // namespace

Compensation compensation(const Analysis& analysis, double step_mm) {
  refuse_whole(analysis);
  Compensation out;
  const TravelSummary& travel = *analysis.result.travel;
  out.positions_mm = evenly(travel, step_mm);
  const TipLocus locus(final_parameters(analysis), travel);
  const double slope = add_straightness(analysis, locus, out);
  add_squareness(analysis, locus, slope, out);
  if (out.straightness_mm.empty() && !out.squareness_rad)
    throw DataError("no table: " + joined(out.left_out, "; "));
  if (!analysis.trace)
    out.left_out.emplace_back(
        "in doubt: the closed loop was not run, so what the model lacks is in these numbers");
  else if (analysis.trace->verdict == "ambiguous")
    out.left_out.emplace_back(
        "in doubt: the closed loop's verdict is ambiguous, and its rivals would leave other "
        "numbers");
  const Parameters pitch_of_z =
      parameters_of(final_parameters(analysis), MotionError::vertical_straightness);
  if (!pitch_of_z.empty())
    out.left_out.push_back("not in this table: " + effect_name(pitch_of_z.front()) +
                           " of the report (E_BZ)");
  return out;
}

}  // namespace slideway
