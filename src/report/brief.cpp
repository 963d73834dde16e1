#include "brief.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

#include "json_writer.hpp"
#include "slideway/report/report.hpp"
#include "slideway/trace/analysis_fields.hpp"

namespace slideway {
namespace {

constexpr int kDigits = 8;  // 5e-8 of a value: below a hundredth of U wherever U is above 5e-6

/// What a brief report has of each record: keys, with their digits where they are others.
constexpr std::pair<std::string_view, std::string_view> kKept[] = {
    {"Report",
     "schema version title about inputs closure travel dominant final crosscheck "
     "conformity trace notes"},
    {"Input",
     "name file kind quantity role loss samples missing left_out outlier_count rms_um:4 "
     "rms_urad:4"},
    {"Closure", "verdict suspects"},
    {"Travel", "slide_min_mm slide_max_mm"},
    {"Dominant", "by_correlation by_fit agree doubt"},
    {"ModelResult",
     "effects converged message rms_um:4 rms_urad:4 observations "
     "effective_observations:4 parameters straightness identifiability residuals "
     "implausible notes"},
    {"Parameter", "name value unit expanded_uncertainty:4 coverage_factor:4 at_bound"},
    {"Straightness",
     "end_point_um least_squares_um minimum_zone_um expanded_uncertainty_um:4 form "
     "reason"},
    {"CurveForm", "length_mm:4 amplitude_um:4 roughness"},
    {"Identifiability", "rank determined"},
    {"Determined", "combination value unit expanded_uncertainty:4 coverage_factor:4"},
    {"Residual", "profile rms_um:4 rms_urad:4"},
    {"Crosscheck", "squareness profiles held_out repeats"},
    {"SquarenessCheck", "fit_rad fit_U_rad:4 indirect_rad indirect_U_rad:4 En:4 verdict"},
    {"ProfileCheck", "profiles what En:4 verdict"},
    {"HeldOutCheck", "profile p_value:4 largest_um:4 largest_urad:4 at_mm verdict"},
    {"PureErrorCheck", "profiles p_value:4 verdict"},
    {"Conformity",
     "what value_um U_um:4 limit_um value_um_per_m U_um_per_m:4 limit_um_per_m "
     "verdict"},
    {"Trace",
     "verdict unfinished not_looked_at fragile rounds unnamed gain instrument blunders "
     "next_cut left detection_limits lack_of_fit_p:4 notes"},
    {"NextCut", "what reason"},
    {"Fragile", "gate value:4 verdict"},
    {"Round",
     "accepted profiles ambiguous_with before_rms_um:4 after_rms_um:4 before_rms_urad:4 "
     "after_rms_urad:4 before_holdout_rms_um:4 after_holdout_rms_um:4 delta_bic:5 "
     "p_value:4 stability:3"},
    {"Unnamed",
     "rms_um:4 rms_urad:4 profile from_mm:4 to_mm:4 clock correlation_length:4 "
     "correlation_unit dominant_period_mm:4 forms"},
    {"UnnamedForm", "form formula profiles"},
    {"SharedResidual",
     "profiles correlation:4 rms_um:4 rms_urad:4 p_value:4 significant lacked_by"},
    {"Blunder", "profile what delta_bic:5"},
    {"Left", "effect"},
    {"DetectionLimit", "effect unit value:3"}};

std::string_view kept_of(std::string_view record) {
  for (const auto& [name, keys] : kKept)
    if (name == record) return keys;
  return {};
}

struct Kept {
  std::string_view key;
  int digits = kDigits;
};

/// The next word of a list, which it is taken from.
Kept next_of(std::string_view& words) {
  const std::string_view word = words.substr(0, words.find(' '));
  words.remove_prefix(std::min(words.size(), word.size() + 1));
  const std::size_t colon = std::min(word.find(':'), word.size());
  Kept out{word.substr(0, colon)};
  if (colon < word.size())
    std::from_chars(word.data() + colon + 1, word.data() + word.size(), out.digits);
  return out;
}

/// Of checks between profiles those that fail, and the one that comes closest to it.
void keep_worst(std::vector<ProfileCheck>& checks) {
  const auto worst = std::ranges::max_element(
      checks, {}, [](const ProfileCheck& check) { return check.En.value_or(0.0); });
  std::vector<ProfileCheck> kept;
  for (auto check = checks.begin(); check != checks.end(); ++check)
    if (check == worst || check->verdict == Consistency::inconsistent) kept.push_back(*check);
  checks = std::move(kept);
}

}  // namespace

int brief_digits(std::string_view record, std::string_view key) {
  for (std::string_view rest = kept_of(record); !rest.empty();)
    if (const Kept member = next_of(rest); member.key == key) return member.digits;
  return 0;
}

std::vector<std::string_view> brief_names() {
  std::vector<std::string_view> out;
  for (const auto& [record, keys] : kKept) out.push_back(record);
  return out;
}

std::vector<std::string> brief_keys(std::string_view record) {
  std::vector<std::string> out;
  for (std::string_view rest = kept_of(record); !rest.empty();) out.emplace_back(next_of(rest).key);
  return out;
}

std::string json_brief(Analysis analysis) {
  analysis.schema = kBriefSchema;
  keep_worst(analysis.result.crosscheck.profiles);
  if (analysis.trace) {
    TraceResult& trace = *analysis.trace;
    std::erase_if(trace.instrument, [](const SharedResidual& each) { return !each.significant; });
    if (trace.unnamed && trace.unnamed->forms.size() > 1) trace.unnamed->forms.resize(1);
  }
  JsonWriter writer(JsonWriter::Layout::brief);
  writer.write(analysis);
  return writer.take();
}

}  // namespace slideway
