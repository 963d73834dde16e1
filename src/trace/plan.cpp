#include "slideway/trace/plan.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>

#include "detection.hpp"
#include "exchange.hpp"
#include "imagined.hpp"
#include "next_cut.hpp"
#include "plan_words.hpp"
#include "search_band.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/identify.hpp"
#include "slideway/identify/planned_fit.hpp"
#include "suspects.hpp"

namespace slideway {
namespace {

/// What is not determined now counts as so many times what it will be.
constexpr double kUndetermined = 100.0;
/// An effect that is hidden or not told apart now counts as so many times its size then; no size
/// falls by more.
constexpr double kHidden = 10.0;
constexpr std::size_t kLargestSet = 3;

/// Parameters whose U is wanted.
std::vector<Eigen::Index> wanted_parameters(const Model& model) {
  std::vector<Eigen::Index> carriages, all;
  for (const ModelTerm& term : model.terms) {
    const std::vector<Parameter>& parameters = term.effect->parameters();
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      all.push_back(term.first_parameter + static_cast<Eigen::Index>(p));
      if (term.effect->is_carriage() && !parameters[p].by_convention)
        carriages.push_back(all.back());
    }
  }
  return carriages.empty() ? all : carriages;
}

/// The wanted parameters of a solution: which are determined, and their covariance.
struct Wanted {
  std::vector<bool> determined;
  Eigen::MatrixXd covariance;

  Wanted(const std::vector<Eigen::Index>& which, const Solution& fit) {
    for (const Eigen::Index p : which)
      determined.push_back(fit.null.identifiable[static_cast<std::size_t>(p)]);
    const Eigen::MatrixXd rows = fit.parameters.jacobian(which, Eigen::all) * fit.uncertainty.basis;
    covariance = fit.uncertainty.inflation * rows * fit.uncertainty.covariance * rows.transpose();
  }
};

/// A fit whose noise is taken as known: what is quick to compare sets by.
Solution with_known_noise(Solution fit) {
  for (Noise& noise : fit.noise) noise.alternatives.clear();
  fit.other_forms.clear();
  fit.other_shapes.clear();
  return fit;
}

double logarithm_of_fall(const std::optional<double>& now, const std::optional<double>& planned) {
  if (!planned) return 0.0;
  return now ? std::log(std::min(*now / *planned, kHidden)) : std::log(kHidden);
}

std::optional<double> expanded(const FittedParameter& of) { return of.expanded_uncertainty; }
std::optional<double> expanded(const Straightness& of) { return of.expanded_uncertainty_um; }

/// U that is planned, of U as it is reported and of both in the low band of a search, without what
/// profiles that disagree and processes without a name add: that is taken to fall as the rest.
template <typename Quantity>
std::optional<double> in_declared_band(const Quantity& now, const Quantity& coarse,
                                       const Quantity& planned) {
  const std::optional<double> before = expanded(now), as_coarse = expanded(coarse),
                              then = expanded(planned);
  return before && as_coarse && then ? *before * (*then / *as_coarse) : then;
}

double mean(double sum, std::size_t count) {
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

struct Criteria {
  double score = 0.0, d_gain = 0.0, a_share = 1.0;
};

class Planner {
 public:
  /// @param in_means  the cuts are made from the profiles of the band, if any
  Planner(const Problem& problem, Searched searched, bool in_means, const FittedModel& fitted,
          const ModelResult& final, const std::vector<CutToCome>& cuts)
      : problem_(problem),
        cuts_(cuts),
        coarser_(std::move(searched.band)),
        fitted_(coarser_ ? coarser_->fitted : fitted),
        suspects_(std::move(searched.dictionary), fitted_),
        wanted_(wanted_parameters(fitted_.model)),
        quick_(with_known_noise(fitted_.fit)),
        now_(wanted_, with_profiles(fitted_.model, quick_, {})),
        summary_(final),
        coarse_(summarise(fitted_.model, fitted_.fit)) {
    const std::size_t count = cuts_.size();
    imagined_.resize(count);
    papers_.resize(count);
    parallel_for(count, [&](std::size_t c) {
      imagined_[c] = imagine(problem, fitted_, in_means ? nullptr : coarser_.get(), cuts_[c]);
      papers_[c] = std::make_unique<PaperProfile>(
          suspects_.on_paper(imagined_[c]->observation, imagined_[c]->noise));
    });
    for (const Suspect& suspect : suspects_.all()) limits_now_.push_back(suspect.limit);
  }

  Plan run() {
    Plan out;
    out.version = SLIDEWAY_VERSION;
    out.title = problem_.title;
    for (const CutToCome& cut : cuts_)
      out.cuts.push_back({cut.profile.name, cut.what, cut.like, cut.cost, cut.time_min});
    for (std::size_t c = 0; c < cuts_.size(); ++c) out.alone.push_back(design({c}));
    std::ranges::stable_sort(out.alone, std::ranges::greater(), &PlannedDesign::score);
    add_sets(out);
    add_notes(out);
    return out;
  }

  /// The first of run().alone.
  NextCut best_alone() {
    std::size_t best = 0;
    double highest = -INFINITY;
    for (std::size_t c = 0; c < cuts_.size(); ++c)
      if (const double score = criteria({c}).score; score > highest) highest = score, best = c;
    const CutToCome& cut = cuts_[best];
    return {cut.profile.name, cut.what, design({best}).reason};
  }

 private:
  [[nodiscard]] std::vector<ProfileToCome> more(const CutSet& set) const {
    std::vector<ProfileToCome> out;
    for (const std::size_t c : set)
      out.push_back({&imagined_[c]->observation, imagined_[c]->noise});
    return out;
  }

  [[nodiscard]] PaperData paper_of(const CutSet& set) const {
    std::vector<const PaperProfile*> all;
    for (const PaperProfile& profile : suspects_.present()) all.push_back(&profile);
    for (const std::size_t c : set) all.push_back(papers_[c].get());
    return {all, fitted_.fit.linear.prior_rows};
  }

  [[nodiscard]] Criteria criteria(const CutSet& set) const {
    std::vector<ProfileToCome> profiles = more(set);
    for (ProfileToCome& each : profiles) each.noise.alternatives.clear();
    const Wanted planned(wanted_, with_profiles(fitted_.model, quick_, profiles));
    Criteria out;
    std::vector<Eigen::Index> both;
    std::size_t fresh = 0;
    double shares = 0.0;
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (now_.determined[i]) {
        both.push_back(at);
        shares += planned.covariance(at, at) / now_.covariance(at, at);
      } else {
        fresh += planned.determined[i] ? 1 : 0;
        shares += planned.determined[i] ? 1.0 / (kUndetermined * kUndetermined) : 1.0;
      }
    }
    out.a_share = mean(shares, wanted_.size());
    out.d_gain = mean(static_cast<double>(fresh) * std::log(kUndetermined) +
                          0.5 * (log_determinant(now_, both) - log_determinant(planned, both)),
                      wanted_.size());
    const PaperData paper = paper_of(set);
    out.score = out.d_gain + gain_of_limits(paper, set) + gain_of_pairs(paper);
    return out;
  }

  /// Of the covariance of some, in units of what their uncertainties are now.
  [[nodiscard]] double log_determinant(const Wanted& wanted,
                                       const std::vector<Eigen::Index>& which) const {
    if (which.empty()) return 0.0;
    const Eigen::VectorXd unit = now_.covariance.diagonal()(which).cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
            unit.asDiagonal() * wanted.covariance(which, which) * unit.asDiagonal(),
            Eigen::EigenvaluesOnly)
            .eigenvalues();
    constexpr double kRounding = 1e-14;
    return eigenvalues.array().max(kRounding).log().sum();
  }

  [[nodiscard]] double gain_of_limits(const PaperData& paper, const CutSet& set) const {
    double sum = static_cast<double>(testable(set).size()) * std::log(kHidden);
    for (std::size_t s = 0; s < limits_now_.size(); ++s)
      sum += logarithm_of_fall(limits_now_[s], suspects_.limit(suspects_.all()[s], paper));
    return mean(sum, limits_now_.size() + suspects_.untestable().size());
  }

  [[nodiscard]] double gain_of_pairs(const PaperData& paper) const {
    double sum = 0.0;
    for (const SuspectPair& pair : suspects_.pairs())
      sum += logarithm_of_fall(pair.now, suspects_.told_apart(pair, paper));
    return mean(sum, suspects_.pairs().size());
  }

  /// Effects that lack nothing any more but what profiles have together.
  [[nodiscard]] std::vector<std::string> testable(const CutSet& set) const {
    std::vector<const Profile*> profiles;
    for (const Observation* each : fitted_.fit.linear.observations)
      profiles.push_back(each->profile);
    for (const std::size_t c : set) profiles.push_back(&cuts_[c].profile);
    std::vector<std::string> out;
    for (const Untestable& each : suspects_.untestable())
      if (std::ranges::count(effect_names(), each.effect) > 0 &&
          specimen(each.effect).lacking_of_machine(fitted_.model.range).empty() &&
          can_be_looked_for(specimen(each.effect), profiles))
        out.push_back(each.effect);
    return out;
  }

  static bool can_be_looked_for(const Effect& effect, const std::vector<const Profile*>& profiles) {
    std::vector<const Setup*> shown;
    for (const Profile* profile : profiles) {
      if (!effect.applies_to(profile->setup)) continue;
      if (!effect.lacking(profile->setup).empty()) return false;
      shown.push_back(&profile->setup);
    }
    return !shown.empty() && effect.lacking_together(shown).empty() &&
           effect.lacking_to_be_told(shown).empty();
  }

  // --- what is reported -------------------------------------------------------------------------

  [[nodiscard]] PlannedDesign design(const CutSet& set) const {
    const Criteria criteria = this->criteria(set);
    PlannedDesign out;
    out.score = criteria.score;
    out.d_gain = criteria.d_gain;
    out.a_share = criteria.a_share;
    const auto total = [&](const std::optional<double> CutToCome::*member) {
      std::optional<double> sum = 0.0;
      for (const std::size_t c : set)
        sum = sum && cuts_[c].*member ? std::optional(*sum + *(cuts_[c].*member)) : std::nullopt;
      return sum;
    };
    for (const std::size_t c : set) out.cuts.push_back(cuts_[c].profile.name);
    out.cost = total(&CutToCome::cost);
    out.time_min = total(&CutToCome::time_min);
    out.quantities = quantities(set);
    add_suspects(paper_of(set), out);
    out.testable = testable(set);
    out.reason = reason_of(out);
    return out;
  }

  [[nodiscard]] std::vector<PlannedQuantity> quantities(const CutSet& set) const {
    Model model = fitted_.model;
    for (const std::size_t c : set) model.observations.push_back(imagined_[c]->observation);
    const ModelResult planned = summarise(model, with_profiles(model, fitted_.fit, more(set)));
    std::vector<PlannedQuantity> out;
    for (const Eigen::Index p : wanted_) {
      const auto at = static_cast<std::size_t>(p);
      const FittedParameter& now = summary_.parameters[at];
      out.push_back({now.name, now.symbol, now.unit, now.expanded_uncertainty,
                     in_declared_band(now, coarse_.parameters[at], planned.parameters[at])});
    }
    if (summary_.straightness)
      out.push_back(
          {"E_ZX", "E_ZX", "um", summary_.straightness->expanded_uncertainty_um,
           in_declared_band(*summary_.straightness, *coarse_.straightness, *planned.straightness)});
    return out;
  }

  void add_suspects(const PaperData& paper, PlannedDesign& out) const {
    for (const Suspect& suspect : suspects_.all()) {
      const Parameter& size = suspect.candidate->term.effect->parameters()[0];
      out.limits.push_back({suspect.candidate->name(), size.name, size.unit,
                            shape_text(*suspect.candidate, suspect.shape),
                            suspects_.hidden_by(suspect), suspect.limit,
                            suspects_.limit(suspect, paper)});
    }
    const double size = fitted_.model.gates.planned_size;
    for (const SuspectPair& pair : suspects_.pairs()) {
      const Rivalry& worst = pair.directions.front();
      const std::optional<double> planned = suspects_.told_apart(pair, paper);
      out.pairs.push_back({suspects_.all()[worst.suspect].candidate->effect_name(), worst.rival,
                           pair.now, planned, planned && *planned <= size});
    }
  }

  // --- sets -------------------------------------------------------------------------------------

  void add_sets(Plan& out) const {
    const auto largest = std::min(kLargestSet, cuts_.size());
    const std::vector<CutSet> by_d =
        greedy_sets(cuts_.size(), largest, [&](const CutSet& set) { return criteria(set).score; });
    const std::vector<CutSet> by_a = greedy_sets(
        cuts_.size(), largest, [&](const CutSet& set) { return -criteria(set).a_share; });
    for (std::size_t size = 2; size <= largest; ++size) {
      const CutSet &d = by_d[size - 1], &a = by_a[size - 1];
      out.sets.push_back(design(d));
      out.sets.back().criteria = {"D"};
      if (a == d) {
        out.sets.back().criteria.emplace_back("A");
        continue;
      }
      out.sets.push_back(design(a));
      out.sets.back().criteria = {"A"};
    }
  }

  void add_notes(Plan& out) const {
    const auto has_memory = [](const Noise& noise) {
      return noise.is_estimated() && !noise.is_white();
    };
    const std::vector<Noise>& noise = fitted_.fit.noise;
    if (std::ranges::any_of(noise, has_memory))
      out.notes.emplace_back(
          "the noise has a memory here: planned U may turn out half as large or " +
          std::string(noise.size() == 1 ? "twice as large" : "a fifth larger") +
          "; more profiles know it better");
    if (fitted_.fit.uncertainty.inflation > 1.0)
      out.notes.emplace_back(
          "structure without a name is left in the profiles, which widens every U, planned ones "
          "too");
    if (!fitted_.fit.other_forms.empty())
      out.notes.emplace_back(
          "a curve beside the polynomial form of the slide is likelier than none; what it adds to "
          "U is taken to stay");
    if (!fitted_.fit.other_shapes.empty())
      out.notes.emplace_back(
          "other values of a lag, a time constant or a place fit nearly as well; what they add to "
          "U is taken to stay");
  }

  const Problem& problem_;
  const std::vector<CutToCome>& cuts_;
  std::unique_ptr<SearchBand> coarser_;  // null: the low band is as coarse
  const FittedModel& fitted_;            // in the low band of a search
  Suspects suspects_;
  std::vector<Eigen::Index> wanted_;
  Solution quick_;
  Wanted now_;
  const ModelResult& summary_;  // as reported
  ModelResult coarse_;
  std::vector<std::optional<Imagined>> imagined_;
  std::vector<std::unique_ptr<PaperProfile>> papers_;
  std::vector<std::optional<double>> limits_now_;
};

}  // namespace

Plan plan_cuts(const Problem& problem, const std::vector<Profile>& profiles,
               const std::vector<CutToCome>& cuts, const Progress& progress) {
  const FittedModel declared = fit_declared(problem, profiles);
  TimeLimit limit(problem.trace.time_limit_s);
  ClosedLoop loop = close_loop(problem, profiles, declared, limit, progress);
  if (progress) progress("trying cuts on paper", 0.0);
  const FittedModel& fitted = loop.last(declared);
  std::vector<std::string> left_out;
  const std::vector<CutToCome> tried = with_found_effects(problem, fitted.model, cuts, left_out);
  if (tried.empty()) throw UsageError(left_out.front());
  Result reported;
  set_final(problem, fitted, loop.more_variance(), Scope::identify, false, reported);
  Plan out =
      Planner(problem, std::move(loop.searched), false, fitted, *reported.final, tried).run();
  std::ranges::move(left_out, std::back_inserter(out.notes));
  for (std::size_t i = 0; i < tried.size() && !problem.planned.empty(); ++i)
    for (const std::string& doubt : tried[i].profile.doubts)
      out.notes.push_back("planned cut '" + tried[i].profile.name + "': " + doubt);
  for (const TraceRound& round : loop.trace.rounds)
    out.notes.push_back("the model has " + term_name(round.accepted, round.profiles) +
                        ", which the closed loop has found");
  return out;
}

std::optional<NextCut> next_cut(const Problem& problem, const std::vector<Profile>& profiles,
                                const FittedModel& fitted, const ModelResult& final,
                                Searched searched) {
  const bool in_means = searched.band && problem.planned.empty();  // fewer than the samples
  std::vector<std::string> left_out;
  const std::vector<CutToCome> cuts = with_found_effects(
      problem, fitted.model, cuts_to_come(problem, in_means ? searched.band->profiles : profiles),
      left_out);
  if (cuts.empty()) return std::nullopt;
  return Planner(problem, std::move(searched), in_means, fitted, final, cuts).best_alone();
}

}  // namespace slideway
