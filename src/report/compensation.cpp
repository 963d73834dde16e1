#include "slideway/report/compensation.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {

constexpr double kPieces = 50.0;  // of the travel, where no step is asked for
constexpr double kMost = 5000.0;

using Parameters = std::vector<FittedParameter>;

bool is_determined(const FittedParameter& p) { return p.identifiable && p.value; }

/// The tool tip's deviation in Z that straightness makes: Σ b_k (x^k - p_x k x^(k-1)), mm.
class TipLocus {
 public:
  TipLocus(const Parameters& parameters, const TravelSummary& travel) : travel_(&travel) {
    constexpr std::string_view kPrefix = "straightness.b";
    for (const FittedParameter& p : parameters) {
      if (!p.name.starts_with(kPrefix)) continue;
      std::size_t k = 0;
      std::from_chars(p.name.data() + kPrefix.size(), p.name.data() + p.name.size(), k);
      b_[k] = &p;
    }
  }

  [[nodiscard]] bool is_declared() const { return !b_.empty(); }

  /// Names of b_first and above that the data do not determine.
  [[nodiscard]] std::vector<std::string> undetermined(std::size_t first) const {
    std::vector<std::string> names;
    for (const auto& [k, p] : b_)
      if (k >= first && !is_determined(*p)) names.push_back(p->symbol);
    return names;
  }

  [[nodiscard]] double operator()(double x) const {
    long double sum = 0.0L;
    for (const auto& [k, p] : b_) {
      if (!is_determined(*p)) continue;
      const long double below = k == 0 ? 0.0L : std::pow(static_cast<long double>(x), k - 1.0L);
      sum += *p->value * (k == 0 ? 1.0L : (x - lever(x) * static_cast<double>(k)) * below);
    }
    return static_cast<double>(sum);
  }

 private:
  [[nodiscard]] double lever(double x) const {
    if (!travel_->spindle_position_mm) return 0.0;  // read along the slide itself
    return travel_->lever == Lever::paper ? x - *travel_->spindle_position_mm
                                          : travel_->overhang_mm.value_or(0.0);
  }

  const TravelSummary* travel_;
  std::map<std::size_t, const FittedParameter*> b_;
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
  const bool slope = !left.rms_um;
  const double rms = left.rms_um.value_or(left.rms_urad.value_or(0.0));
  std::vector<double> seen = form;
  if (slope) {
    const double step = table.positions_mm[1] - table.positions_mm[0];
    for (std::size_t i = 0; i + 1 < form.size(); ++i) seen[i] = (form[i + 1] - form[i]) / step;
    seen.pop_back();
  }
  const double size = rms_about_mean(seen) / (slope ? kMicroradian : kMicrometre);
  if (rms < size) return "";
  const std::string unit = slope ? " µrad" : " µm";
  return "the loop leaves " + significant(rms, 3) + unit +
         " rms without a name, no less than its own " + significant(size, 3) + unit;
}

void refuse_whole(const Analysis& analysis) {
  const auto refuse = [](const std::string& why) { throw DataError("no table: " + why); };
  if (!analysis.result.final) refuse("the report holds no fit; accepted: one of identify or fit");
  if (!analysis.result.final->converged) refuse("the fit did not converge");
  if (!analysis.result.travel)
    refuse("the report says no travel, being of an older slideway; identify the problem again");
  for (const FittedParameter& p : analysis.result.final->parameters)
    if (p.name.starts_with("straightness[") || p.name.starts_with("squareness["))
      refuse("several carriages move along X; accepted: a machine with one");
  if (analysis.trace && analysis.trace->verdict == TraceVerdict::not_identifiable)
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
  if (const auto names = locus.undetermined(2); !names.empty())
    return leave_out("the data do not determine " + joined(names));
  if (travel.spindle_position_mm && travel.lever == Lever::split && !travel.overhang_mm)
    return leave_out("the faces were cut at several overhangs, and its pitch acts on each");
  const std::string& implausible = analysis.result.final->implausible;
  if (!implausible.empty() && (!analysis.trace || analysis.trace->rounds.empty()))
    return leave_out(implausible);

  const double first = out.positions_mm.front(), last = out.positions_mm.back();
  const double slope = (locus(last) - locus(first)) / (last - first);
  const auto deviation = [&](double x) { return locus(x) - locus(first) - slope * (x - first); };
  std::vector<double> form;
  for (const double x : out.positions_mm) form.push_back(deviation(x));
  form.front() = form.back() = 0.0;
  for (std::size_t i = 0; i + 1 < form.size(); ++i) {
    const double x = (out.positions_mm[i] + out.positions_mm[i + 1]) / 2.0;
    out.interpolation_mm =
        std::max(out.interpolation_mm, std::abs(deviation(x) - (form[i] + form[i + 1]) / 2.0));
  }
  if (const std::string why = drowned(analysis, out, form); !why.empty()) return leave_out(why);
  out.straightness_mm = std::move(form);
  const std::string lever = !travel.spindle_position_mm ? ", of the carriage"
                            : travel.lever == Lever::paper
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
  const Parameters& parameters = analysis.result.final->parameters;
  const auto found = std::ranges::find(parameters, "squareness.dbeta_xz", &FittedParameter::name);
  if (found == parameters.end()) return leave_out("the model has no squareness");
  if (!is_determined(*found)) return leave_out("the data do not determine " + found->symbol);
  const bool needs_b1 =
      analysis.result.travel->lever == Lever::split && !out.straightness_mm.empty();
  if (needs_b1)
    if (const auto names = locus.undetermined(1); !names.empty())
      return leave_out("the data do not determine " + joined(names));
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
      (found->expanded_uncertainty
           ? with_uncertainty(*found->value, *found->expanded_uncertainty) +
                 " (U, k = " + fixed_point(found->coverage_factor.value_or(2.0), 2) + ")"
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
  const TipLocus locus(analysis.result.final->parameters, travel);
  const double slope = add_straightness(analysis, locus, out);
  add_squareness(analysis, locus, slope, out);
  if (out.straightness_mm.empty() && !out.squareness_rad)
    throw DataError("no table: " + joined(out.left_out, "; "));
  if (!analysis.trace)
    out.left_out.emplace_back(
        "in doubt: the closed loop was not run, so what the model lacks is in these numbers");
  else if (analysis.trace->verdict == TraceVerdict::ambiguous)
    out.left_out.emplace_back(
        "in doubt: the closed loop's verdict is ambiguous, and its rivals would leave other "
        "numbers");
  const auto is_pitch_of_z = [](const FittedParameter& p) {
    return p.name.starts_with("vertical_straightness.");
  };
  if (std::ranges::any_of(analysis.result.final->parameters, is_pitch_of_z))
    out.left_out.emplace_back("not in this table: vertical_straightness of the report (E_BZ)");
  return out;
}

}  // namespace slideway
