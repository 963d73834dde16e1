#include <algorithm>
#include <cmath>
#include <map>

#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/report/number.hpp"
#include "summary.hpp"
#include "text_parts.hpp"

/// What the cross-checks say of the numbers.
namespace slideway {
namespace {

/// Whether two values with their U could differ by as much as the larger of them and agree all the
/// same.
bool shows_little(double a, double U_a, double b, double U_b) {
  return std::hypot(U_a, U_b) > std::max(std::abs(a), std::abs(b));
}

/// "" where nothing was compared.
std::string agreement_of(const std::vector<ProfileCheck>& checks) {
  std::optional<double> most;
  for (const ProfileCheck& check : checks)
    if (check.En) most = std::max(most.value_or(0.0), *check.En);
  if (!most) return "";
  return "the profiles agree, E_n up to " + en_text(*most) +
         (std::ranges::any_of(checks, [](const auto& each) { return shows_little(each); })
              ? ", though U exceeds what is compared"
              : "");
}

}  // namespace

bool shows_little(const SquarenessCheck& check) {
  return check.fit_rad && check.fit_U_rad && check.indirect_rad && check.indirect_U_rad &&
         shows_little(*check.fit_rad, *check.fit_U_rad, *check.indirect_rad, *check.indirect_U_rad);
}

bool shows_little(const ProfileCheck& check) {
  return check.value_um.size() == 2 &&
         shows_little(check.value_um[0], check.U_um[0], check.value_um[1], check.U_um[1]);
}

bool is_texture(const PureErrorCheck& check) {
  constexpr double kShared = 2.0;  // white noise has 0.7 at most
  const auto shared = [&](const std::optional<double>& common, const std::optional<double>& apart) {
    return common && apart && *common > kShared * *apart;
  };
  return check.verdict == RepeatFit::fits &&
         (shared(check.common_um, check.apart_um) || shared(check.common_urad, check.apart_urad));
}

std::string noise_of(const Crosscheck& checks) {
  return std::ranges::any_of(checks.repeats, is_texture) ? "a texture that repeats" : "noise";
}

std::string condition(const Result& result, const Conformity& conformity) {
  const bool is_form = conformity.limit_um && conformity.what != kFlatness && result.final;
  const std::string with_all =
      conformity.with_left_out_um && conformity.verdict == ConformityVerdict::undecided
          ? ", " + number(*conformity.with_left_out_um, 3) + " µm with the values at the axis"
          : "";
  return with_all + (is_form ? parts_beside(result) : "") + condition(conformity.if_no);
}

bool is_contradicted(const Crosscheck& checks) {
  const auto does = [](const auto& check) { return contradicts(check); };
  return (checks.squareness && checks.squareness->verdict == Consistency::inconsistent) ||
         std::ranges::any_of(checks.profiles, does) || std::ranges::any_of(checks.held_out, does);
}

std::vector<std::string> objections(const Result& result) {
  constexpr int kNamedPairs = 2;  // of profiles that disagree; more are counted
  std::vector<std::string> out;
  for (const Conformity& each : result.conformity)
    if (each.verdict == ConformityVerdict::does_not_conform)
      out.push_back(each.what + " does not conform");
  const auto& angle = result.crosscheck.squareness;
  if (angle && angle->verdict == Consistency::inconsistent)
    out.emplace_back("the run-out contradicts the squareness");
  std::map<std::string, std::pair<int, int>> pairs;  // that disagree, of all, by what
  for (const ProfileCheck& check : result.crosscheck.profiles) {
    auto& [apart, all] = pairs[check.what];
    apart += contradicts(check) ? 1 : 0;
    ++all;
  }
  for (const auto& [what, count] : pairs)
    if (count.first > kNamedPairs)
      out.push_back(std::to_string(count.first) + " of " + std::to_string(count.second) +
                    " pairs of profiles disagree in " + what);
  const bool by_pairs = std::ranges::any_of(result.crosscheck.profiles, [](const auto& check) {
    return contradicts(check) && !is_of_all(check);
  });
  for (const ProfileCheck& check : result.crosscheck.profiles) {
    if (!contradicts(check) || pairs[check.what].first > kNamedPairs) continue;
    if (by_pairs && is_of_all(check)) continue;  // it follows
    const std::string who = who_of(check) + " disagree in ";
    const auto known =
        std::ranges::find_if(out, [&](const std::string& each) { return each.starts_with(who); });
    if (known == out.end())
      out.push_back(who + check.what);
    else
      *known += " and " + check.what;
  }
  for (const HeldOutCheck& check : result.crosscheck.held_out)
    if (contradicts(check)) out.push_back(check.profile + ", held out, does not fit");
  return out;
}

void say_crosscheck(const Result& result, Summary& out) {
  const Crosscheck& checks = result.crosscheck;
  std::vector<std::string> parts, consistent;
  const auto& angle = checks.squareness;
  if (angle && angle->En) {
    QuantityValue indirect;
    indirect.value = angle->indirect_rad;
    indirect.expanded_uncertainty = angle->indirect_U_rad;
    const bool is_consistent = angle->verdict != Consistency::inconsistent;
    (is_consistent ? consistent : parts)
        .push_back(std::string(is_consistent ? "consistent" : "INCONSISTENT") +
                   " with the run-out, Eq. (21): " + value_text(indirect, kMicroradian) +
                   " µm/m, E_n = " + en_text(*angle->En) +
                   (shows_little(*angle) ? ", though U exceeds both" : ""));
  }
  for (const ProfileCheck& check : checks.profiles)
    if (contradicts(check))
      parts.push_back("INCONSISTENT: " + check.what + " of " + who_of(check) +
                      (check.En ? ", E_n = " + en_text(*check.En) : ""));
  for (const HeldOutCheck& check : checks.held_out) {
    const bool fits = !contradicts(check);
    (fits ? consistent : parts)
        .push_back(check.profile + ", held out, " +
                   (fits ? "fits" : "DOES NOT FIT at " + number(check.at_mm, 4) + " mm"));
  }
  const std::size_t contradictions = parts.size();
  std::ranges::move(consistent, std::back_inserter(parts));
  const std::string agreement = contradictions == 0 ? agreement_of(checks.profiles) : "";
  if (!agreement.empty()) parts.push_back(agreement);
  out.has_crosscheck = !parts.empty();
  const std::string none = angle && !angle->reason.empty() ? ": " + angle->reason : "";
  out.crosscheck = parts.empty() ? "none" + none : joined(parts, "; ");
  out.checks = out.conformity.empty() ? out.crosscheck
               : parts.empty()        ? out.conformity + "; no cross-check" + none
                                      : out.conformity + "; " + out.crosscheck;
  out.checks_in_brief = out.checks;
  if (!agreement.empty() && parts.size() > 1 && code_points(out.checks) > kBoxText)
    out.checks_in_brief.erase(out.checks.size() - agreement.size() - 2);  // "; "
  if (angle && angle->En && angle->verdict == Consistency::consistent && contradictions == 0 &&
      code_points(out.checks_in_brief) > kBoxText)
    out.checks_in_brief.replace(
        out.checks_in_brief.find(parts.front()), parts.front().size(),
        std::string(shows_little(*angle) ? "the run-out shows little" : "the run-out agrees") +
            ", E_n = " + en_text(*angle->En));
  if (contradictions > 1 && code_points(out.checks) > kBoxText)
    out.checks_in_brief = (out.conformity.empty() ? "" : out.conformity + "; ") + parts.front() +
                          "; " + std::to_string(contradictions - 1) + " more";
}

}  // namespace slideway
