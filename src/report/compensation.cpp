#include "slideway/report/compensation.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/report/number.hpp"
#include "slideway/trace/unseen.hpp"
#include "summary.hpp"

namespace slideway {
namespace {

constexpr double kPieces = 50.0;  // of the travel, where no step is asked for
constexpr double kMostPositions = 5000.0;

/// The form of the report at any position of its travel: a cubic through the four points about it.
class Form {
 public:
  Form(const std::vector<double>& x, const std::vector<double>& y) : x_(x), y_(y) {}

  [[nodiscard]] double operator()(double x) const {
    const std::size_t last = x_.size() - 1;
    const double place = (x - x_.front()) / (x_.back() - x_.front()) * static_cast<double>(last);
    const auto below = static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(last)));
    const std::size_t first = std::min(below == 0 ? 0 : below - 1, last - 3);
    double sum = 0.0;
    for (std::size_t i = first; i < first + 4; ++i) {
      double weight = 1.0;
      for (std::size_t j = first; j < first + 4; ++j)
        if (j != i) weight *= (x - x_[j]) / (x_[i] - x_[j]);
      sum += weight * y_[i];
    }
    return sum;
  }

 private:
  const std::vector<double>&x_, &y_;
};

std::vector<double> evenly(const TravelSummary& travel, double step_mm) {
  const double length = travel.slide_max_mm - travel.slide_min_mm;
  if (!(length > 0.0)) throw DataError("travel: has no length; nothing can be tabled");
  if (!(step_mm >= 0.0) || std::isinf(step_mm))
    throw UsageError("step: must be above 0 mm; 0 is a fiftieth of the travel");
  const double pieces = step_mm > 0.0 ? std::ceil(length / step_mm * (1.0 - 1e-12)) : kPieces;
  if (!(pieces < kMostPositions))
    throw UsageError("step: " + significant(step_mm, 3) + " mm makes more than " +
                     significant(kMostPositions, 4) + " positions of " + significant(length, 6) +
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
  const bool slope = !left.rms_um;
  const double rms = left.rms_um.value_or(left.rms_urad.value_or(0.0));
  std::vector<double> reading = form;
  if (slope) {
    const double step = table.positions_mm[1] - table.positions_mm[0];
    for (std::size_t i = 0; i + 1 < form.size(); ++i) reading[i] = (form[i + 1] - form[i]) / step;
    reading.pop_back();
  }
  const double size = rms_about_mean(reading) / (slope ? kMicroradian : kMicrometre);
  if (rms < size) return "";
  const std::string unit = slope ? " µrad" : " µm";
  return "the loop leaves " + significant(rms, 3) + unit +
         " rms without a name, no less than its own " + significant(size, 3) + unit;
}

void refuse_whole(const Analysis& analysis) {
  const auto refuse = [](const std::string& why) { throw DataError("no table: " + why); };
  const auto& model = analysis.result.final;
  if (!model) refuse("the report holds no fit; accepted: one of identify or fit");
  if (!model->converged) refuse("the fit did not converge");
  if (!analysis.result.travel) refuse("the report says no travel");
  for (const FittedParameter& p : model->parameters)  // "straightness[upper].b2"
    if (p.name.find('[') != std::string::npos && motion_error_of(p.name) != MotionError::none)
      refuse("several carriages move along X; accepted: a machine with one");
  if (analysis.trace && analysis.trace->verdict == TraceVerdict::not_identifiable)
    refuse(
        "the closed loop's verdict is not_identifiable: the data cannot tell what made the form");
}

/// Sets E_ZX, or says why not.
void add_straightness(const Analysis& analysis, Compensation& out) {
  const auto leave_out = [&](const std::string& why) {
    out.left_out.push_back("EZX is left out: " + why);
  };
  const ModelResult& model = *analysis.result.final;
  const TravelSummary& travel = *analysis.result.travel;
  if (!model.straightness) return leave_out("the model has no straightness");
  if (!model.straightness->each.empty())
    return leave_out("profiles have forms of their own; accepted: one for all of them");
  const StraightnessCurve& curve = model.straightness->curve;
  if (curve.position_mm.size() < 4)
    return leave_out(model.straightness->reason.empty() ? "the report holds no form"
                                                        : model.straightness->reason);
  const bool at_tip = travel.spindle_position_mm.has_value();
  if (at_tip && curve.tip_um.size() != curve.position_mm.size())
    return leave_out("the faces were cut at several overhangs, and its pitch acts on each");
  if (!model.implausible.empty() && !was_extended(analysis)) return leave_out(model.implausible);

  const Form form(curve.position_mm, at_tip ? curve.tip_um : curve.deviation_um);
  const Form U(curve.position_mm,
               at_tip ? curve.tip_expanded_uncertainty_um : curve.expanded_uncertainty_um);
  std::vector<double> heights;
  for (const double x : out.positions_mm) heights.push_back(form(x) * kMicrometre);
  heights.front() = heights.back() = 0.0;
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
    const double x = (out.positions_mm[i] + out.positions_mm[i + 1]) / 2.0;
    const double between = (heights[i] + heights[i + 1]) / 2.0;
    out.interpolation_mm =
        std::max(out.interpolation_mm, std::abs(form(x) * kMicrometre - between));
  }
  if (const std::string why = drowned(analysis, out, heights); !why.empty()) return leave_out(why);
  out.straightness_mm = std::move(heights);
  for (const double x : out.positions_mm)
    out.straightness_U_mm.push_back(std::max(0.0, U(x)) * kMicrometre);
  const std::string lever = !at_tip ? ", of the carriage"
                            : travel.lever == Lever::paper
                                ? ", at the tool tip, with the pitch on the lever p_x = r"
                                : ", at the tool tip, with the pitch on the overhang of " +
                                      significant(travel.overhang_mm.value_or(0.0), 6) + " mm";
  out.basis.push_back("EZX: straightness error motion of X in the direction Z, mm" + lever +
                      "; reference line: through the end points of the travel");
  for (const StraightnessError& error : model.straightness->errors)
    if (error.line == ReferenceLineKind::end_point)
      out.basis.push_back("E_ZX of the carriage over this travel: " + value_text(error) +
                          " µm (U, end-point line)");
}

void add_squareness(const Analysis& analysis, Compensation& out) {
  const auto leave_out = [&](const std::string& why) {
    out.left_out.push_back("B0X is left out: " + why);
  };
  const ModelResult& model = *analysis.result.final;
  const auto found = std::ranges::find_if(model.parameters, is_squareness);
  if (found == model.parameters.end()) return leave_out("the model has no squareness");
  if (!is_known(*found)) return leave_out("the data do not determine " + found->symbol);
  double slope = 0.0;
  if (!out.straightness_mm.empty()) {
    const std::optional<double>& tip = model.straightness->curve.tip_slope_rad;
    if (!tip) return leave_out("the data do not determine the slope of EZX's reference line");
    slope = *tip;
  }
  const auto& check = analysis.result.crosscheck.squareness;
  if (check && check->verdict == Consistency::inconsistent)
    return leave_out("the cross-check with the run-out is inconsistent (E_n " +
                     (check->En ? significant(*check->En, 3) : "unknown") + ")");
  const double angle = *found->value - slope;
  std::vector<double> cone;
  for (const double x : out.positions_mm) cone.push_back(-angle * x);
  if (const std::string why = drowned(analysis, out, cone); !why.empty()) return leave_out(why);
  out.squareness_rad = angle;
  out.basis.push_back(
      "B0X: squareness of X to the spindle axis average line, E_B(0C)X, rad: Δβxz = " +
      value_text(*found) + " (U, k = " + fixed_point(found->coverage_factor.value_or(2.0), 2) +
      ")" +
      (out.straightness_mm.empty()
           ? ""
           : " minus " + significant(slope, 6) + ", the slope of EZX's reference line"));
}

/// What the numbers of a table hold besides.
void add_doubts(const Analysis& analysis, Compensation& out) {
  const ModelResult& model = *analysis.result.final;
  const auto doubt = [&](const std::string& why) { out.left_out.push_back("in doubt: " + why); };
  const auto holds = [&](const char* what, const std::vector<std::string>& if_no) {
    if (!if_no.empty())
      doubt(std::string(what) + " holds " + effect_titles(if_no, " or ") +
            " as well: these data do not tell them apart");
  };
  if (!out.straightness_mm.empty()) holds("EZX", model.straightness->if_no);
  if (out.squareness_rad) holds("B0X", model.squareness()->if_no);
  if (!analysis.trace) {
    doubt("the closed loop was not run, so what the model lacks is in these numbers");
    return;
  }
  if (analysis.trace->verdict == TraceVerdict::ambiguous)
    doubt("the closed loop's verdict is ambiguous, and its rivals would leave other numbers");
  if (out.squareness_rad && may_be_moved_unseen(model, *analysis.trace))
    doubt("what these data do not show may move B0X " + moved_unseen(analysis));
  if (!out.straightness_mm.empty() && may_be_bent_unseen(model, *analysis.trace))
    doubt("what these data do not show may move EZX " + bent_unseen(analysis));
}

}  // namespace

Compensation compensation(const Analysis& analysis, double step_mm) {
  refuse_whole(analysis);
  Compensation out;
  out.positions_mm = evenly(*analysis.result.travel, step_mm);
  add_straightness(analysis, out);
  add_squareness(analysis, out);
  if (out.straightness_mm.empty() && !out.squareness_rad)
    throw DataError("no table: " + joined(out.left_out, "; "));
  add_doubts(analysis, out);
  for (const std::string& effect : analysis.result.final->effects)
    if (is_vertical(effect))
      out.left_out.push_back("not in this table: " + effect + " of the report (E_BZ)");
  return out;
}

}  // namespace slideway
