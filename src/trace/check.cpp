#include "slideway/trace/check.hpp"

#include <algorithm>

#include "slideway/base/error.hpp"
#include "slideway/identify/identify.hpp"

namespace slideway {
namespace {

/// Every declared effect without the metadata it needs.
void check_effects(const Problem& problem, const std::vector<Profile>& profiles, Faults& faults) {
  Problem bare = problem;
  bare.effects.clear();
  bare.trace.own.clear();
  Model model = build_model(bare, profiles);
  for (const DeclaredEffect& effect : problem.effects) try {
      append_term(model, effect, model.range);
    } catch (const UsageError& error) {
      faults.push_back({.message = problem.path.string() + ": " + error.what()});
    }
}

DesignCheck check_design(const Problem& problem, const std::vector<Profile>& profiles) {
  DesignCheck out;
  const Model model = build_model(problem, profiles);
  for (const ModelTerm& term : model.terms) out.effects.push_back(term.name);
  out.rank = rank_of_design(model);
  out.confounding = confounding_of_all(problem, profiles);
  return out;
}

ProblemCheck checked(const std::filesystem::path& path,
                     const std::optional<std::filesystem::path>& data_dir) {
  ProblemCheck out{path, {}, {}, {}};
  const std::optional<Problem> problem = read_problem(path, data_dir, out.faults);
  if (!problem) return out;
  const std::vector<Profile> profiles = read_profiles(*problem, out.faults);
  if (!out.faults.empty()) return out;
  try {
    check_effects(*problem, profiles, out.faults);
    if (!out.faults.empty()) return out;
    out.design = check_design(*problem, profiles);
    out.data = summarise_data(*problem, profiles);
  } catch (const UsageError& error) {
    out.faults.push_back({.message = path.string() + ": " + error.what()});
  } catch (const DataError& error) {
    out.faults.push_back({.message = path.string() + ": " + error.what(), .is_of_data = true});
  }
  return out;
}

}  // namespace

ProblemCheck check_problem(const std::filesystem::path& path,
                           const std::optional<std::filesystem::path>& data_dir) {
  ProblemCheck out = checked(path, data_dir);
  std::ranges::stable_sort(out.faults, {}, &Fault::line);
  return out;
}

}  // namespace slideway
