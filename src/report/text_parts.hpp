#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slideway/trace/analysis.hpp"

namespace slideway {

std::string heading(const std::string& text);
std::string item(const std::string& text);
std::string note(const std::string& text);

/// "-" where it is not finite.
std::string number(double value, int digits);
std::string probability(double p);
/// "p = 0.03", "p < 1e-4".
std::string p_text(double p);
/// E_n in two digits, or in as many as tell it from its limit 1: "1.004".
std::string en_text(double En);
/// "cannot be decided" where a report has "can not be decided".
std::string verdict_text(ConformityVerdict verdict);
/// A quantity with a tolerance, by its definition: "straightness (minimum zone)".
std::string toleranced(const std::string& what);
/// What the declared model gave, "" where that is the same number.
std::string declared_value(const Result& result, const FittedParameter& p);
/// "um" as µm, "urad" as µrad, "1" as nothing.
std::string unit_text(const std::string& unit);
/// Of a pair of numbers such as rms_um and rms_urad the one that is there, with its unit.
std::string size_text(const std::optional<double>& um, const std::optional<double>& urad,
                      int digits = 3);

/// "0.71 c1 - 0.71 dbeta_xz": parameters without their effect where that leaves no two alike.
std::string in_words(const Combination& terms, const ModelResult& model);

/// The final parameters; the declared model's values beside those that are another there.
/// @param most  rows at most; of more parameters the last line says how many are not shown
std::string parameter_table(const Result& result, std::size_t most);

/// The ranking by correlation, and which effect dominates; "" where there is none.
std::string ranking_text(const Result& result);

/// What `--full` prints after the short report.
std::string full_text(const Analysis& analysis);

/// The closed loop of `--full`.
std::string trace_text(const TraceResult& trace);

/// The profile whose residual the loop has lowered most, else the first. REQUIRES one.
const ProfileCurves& profile_to_show(const Curves& curves);

/// The residual of the profile in which the loop has lowered it most, before and after; "" where it
/// has not.
std::string residual_pictures(const Curves& curves);

}  // namespace slideway
