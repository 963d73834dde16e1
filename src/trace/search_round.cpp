#include "search_round.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "modulation.hpp"
#include "sample_residuals.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/low_band_lines.hpp"
#include "undescribed.hpp"
#include "whiten_beside.hpp"

namespace slideway {
namespace {

constexpr double kBetterKnown = 0.5;    // of what was open of the noise: the null is another one
constexpr std::size_t kEnoughPass = 3;  // names: a later check may refuse the best ones

std::string implausible(const Refined& refined) {
  const std::vector<Parameter>& parameters = refined.candidate->term.effect->parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const double value = refined.values[static_cast<Eigen::Index>(p)];
    if (value < parameters[p].lower || value > parameters[p].upper)
      return parameters[p].name + " = " + significant(value, 3) + " is physically impossible";
  }
  return "";
}

/// Whether `each` is neither measured nor of the carriages, and `chosen` a measured cause; or is
/// the same in fewer readings.
bool ranks_below(const TestedCandidate& each, const TestedCandidate& chosen) {
  return is_in_fewer_readings(each, chosen) ||
         (is_measured(*chosen.refined.candidate) && !is_measured(*each.refined.candidate) &&
          !each.refined.candidate->term.effect->is_carriage());
}

/// Whether two parts of the residual are one and the same rather than each its own.
bool alike(const TestedCandidate& a, const TestedCandidate& b, const Gates& gates) {
  return std::abs(a.fitted.dot(b.fitted)) > gates.alike * a.fitted.norm() * b.fitted.norm();
}

/// By how much less one may lower the BIC than the chosen one does and still be as good.
double tie(const TestedCandidate& each, const TestedCandidate& chosen, const Gates& gates) {
  const double share = each.is_wave && chosen.is_wave ? gates.wave_share : gates.tie_share;
  return std::max(gates.tie_bic, -share * chosen.refined.delta_bic);
}

/// White columns, orthonormal, of the best finding that is no wave, and of its neighbours on the
/// grid; none where it would not be accepted.
Eigen::MatrixXd columns_of_no_wave(const Model& model, const Whitened& data,
                                   const std::vector<Finding>& findings) {
  for (const Finding& each : findings) {
    if (each.delta_bic >= -model.gates.delta_bic) break;
    const std::vector<double>& shape =
        each.candidate->grid.points()[static_cast<std::size_t>(each.atom)];
    if (!is_wave(model, each.candidate->term, shape))
      return orthonormal(data.outside(each.candidate->columns_around(each.atom)));
  }
  return Eigen::MatrixXd(data.rows(), 0);
}

/// Candidates refined to their best shapes, best BIC first: those near the best, and on down until
/// several effects pass.
std::vector<TestedCandidate> test_best(const Model& model, const Solution& fit,
                                       const Whitened& data, std::vector<Finding> findings,
                                       const Calibration& calibration) {
  sort_by_priority(findings);
  const SampleResiduals samples(model, fit);
  const Eigen::MatrixXd no_wave = columns_of_no_wave(model, data, findings);
  const auto test = [&](const Finding& finding) {
    TestedCandidate tested;
    tested.refined = refine(model, data, finding);
    if (tested.refined.candidate->term.profiles.empty())  // else the others lack their own share
      tested.held_out = leave_one_out(model, fit.linear, data, tested.refined);
    tested.fitted = data.outside(tested.refined.columns * tested.refined.projection.amplitudes);
    tested.is_wave = is_wave(model, finding.candidate->term, tested.refined.shape);
    if (tested.is_wave && !finding.candidate->is_fast) {  // else the samples have shown it
      Eigen::VectorXd rest = data.residual() - tested.fitted;
      project_out(no_wave, rest);
      tested.noise_beside = noise_beside_line(data, finding, rest, model.gates);
    }
    tested.p_value = calibration.p_value(-tested.delta_bic_beside());
    tested.part_of = part_of_a_line(model, fit.estimate.shapes, tested.refined);
    const std::optional<std::size_t> alone = only(*finding.candidate);
    const auto is_of_marks = [&](Folding folding) {
      return is_of_feed_marks(model, data, tested.refined, tested.fitted, folding);
    };
    if (is_of_marks(Folding::by_sampling)) {
      tested.of_feed_marks = true;
      tested.folded = "its line is that of the feed marks, folded by sampling";
      return tested;
    }
    if (!samples.have(tested.refined)) {
      tested.of_feed_marks = is_of_marks(Folding::by_low_band);
      tested.folded = "the samples do not have its line: the low band has folded another";
    }
    if (alone && !finding.candidate->is_fast &&
        is_too_fine(model, finding.candidate->term, tested.refined.shape,
                    *fit.linear.observations[*alone]))
      tested.folded = "its profile has too few low-band values a cycle";
    return tested;
  };
  const auto worth = [&](double most) {
    const auto first_not = std::ranges::find_if(
        findings, [&](const Finding& f) { return f.rank == 0 || f.delta_bic > most; });
    return std::min<std::size_t>(first_not - findings.begin(),
                                 static_cast<std::size_t>(model.gates.most_refined));
  };
  const double best = findings.front().delta_bic;
  std::vector<TestedCandidate> out(
      worth(std::max(best + model.gates.refine_bic, model.gates.refine_share * best)));
  parallel_for(out.size(), [&](std::size_t i) { out[i] = test(findings[i]); });
  const std::size_t pay = worth(model.gates.refine_bic - model.gates.delta_bic);
  std::set<std::string> passing;
  const auto note = [&](const TestedCandidate& tested) {
    if (tested.refused(model.gates).empty()) passing.insert(tested.name());
  };
  std::ranges::for_each(out, note);
  while (out.size() < pay && passing.size() < kEnoughPass) {
    out.push_back(test(findings[out.size()]));
    note(out.back());
  }
  std::ranges::stable_sort(out, {}, &TestedCandidate::priority);
  return out;
}

}  // namespace

double TestedCandidate::delta_bic_beside() const {
  return refined.delta_bic + refined.projection.gain * (1.0 - 1.0 / noise_beside);
}

std::string TestedCandidate::refused(const Gates& gates) const {
  if (std::string why = fails(gates); !why.empty()) return why;
  const std::string& takes = refined.candidate->takes;
  if (!takes.empty()) return "it may be, but it takes " + takes + " to be told";
  if (held_out && !held_out->helps) return "it predicts left-out profiles worse";
  return "";
}

std::string TestedCandidate::fails(const Gates& gates) const {
  if (refined.projection.rank == 0) return "the model makes the same columns";
  if (!part_of.empty()) return "its line is " + part_of;
  if (!folded.empty()) return folded;
  if (refined.delta_bic > -gates.delta_bic)
    return "gains too little: difference in BIC " + significant(refined.delta_bic, 3);
  if (delta_bic_beside() > -gates.delta_bic)
    return "the noise beside its line is " + significant(noise_beside, 2) + " times as strong";
  if (p_value > gates.significance) return "noise gives as much: p = " + significant(p_value, 2);
  if (std::string why = implausible(refined); !why.empty()) return why;
  if (refined.at_end) return "its shape runs to the end of what is possible";
  if (refined.size_in_uncertainties < gates.size)
    return "its size is only " + significant(refined.size_in_uncertainties, 2) +
           " of its standard uncertainties";
  return "";
}

bool TestedCandidate::is_possible() const {
  return refined.projection.rank > 0 && folded.empty() && implausible(refined).empty();
}

bool is_in_fewer_readings(const TestedCandidate& part, const TestedCandidate& whole) {
  const Candidate &a = *part.refined.candidate, &b = *whole.refined.candidate;
  const auto is_in_whole = [&](const std::string& name) {
    return b.term.profiles.empty() || std::ranges::count(b.term.profiles, name) > 0;
  };
  const Description& effect = a.term.effect->description();
  return (effect.of_instrument || effect.measured) && a.effect_name() == b.effect_name() &&
         a.name() != b.name() && !a.term.profiles.empty() &&
         std::ranges::all_of(a.term.profiles, is_in_whole);
}

double SearchRound::least_of_effect(const TestedCandidate& part) const {
  double least = part.refined.delta_bic;
  if (!is_of_place(*part.refined.candidate)) return least;
  for (const TestedCandidate& each : tested)
    if (each.refined.candidate->effect_name() == part.refined.candidate->effect_name() &&
        each.refined.candidate->term.profiles.empty())
      least = std::min(least, each.refined.delta_bic);
  return least;
}

const TestedCandidate* SearchRound::choice(const Gates& gates,
                                           const std::vector<std::string>& excluded) const {
  for (auto each = tested.begin(); each != tested.end(); ++each) {
    if (!each->refused(gates).empty() || std::ranges::count(excluded, each->name()) > 0) continue;
    const double least = least_of_effect(*each);
    const auto stands_before = [&](const TestedCandidate& better) {
      return better.folded.empty() && better.refined.candidate->takes.empty() &&
             std::ranges::count(excluded, better.name()) == 0 &&
             better.refined.candidate->effect_name() != each->refined.candidate->effect_name() &&
             better.refined.delta_bic < least - gates.tie_bic && alike(better, *each, gates);
    };
    if (std::none_of(tested.begin(), each, stands_before)) {
      const TestedCandidate* better_known = better_known_than(*each, gates, excluded);
      return simplest_law(better_known ? *better_known : *each, gates);
    }
  }
  return nullptr;
}

const TestedCandidate* SearchRound::simplest_law(const TestedCandidate& choice,
                                                 const Gates& gates) const {
  const TestedCandidate* out = &choice;
  for (const TestedCandidate& each : tested)
    if (each.name() == choice.name() &&
        each.refined.candidate->amplitudes() == choice.refined.candidate->amplitudes() &&
        each.refined.shape.size() < out->refined.shape.size() && each.refused(gates).empty() &&
        each.refined.delta_bic <= choice.refined.delta_bic + tie(each, choice, gates))
      out = &each;
  return out;
}

const TestedCandidate* SearchRound::better_known_than(
    const TestedCandidate& choice, const Gates& gates,
    const std::vector<std::string>& excluded) const {
  if (choice.refined.candidate->term.effect->is_carriage()) return nullptr;
  const auto at = std::ranges::find_if(tested, [&](const TestedCandidate& each) {
    return ((is_measured(*each.refined.candidate) && !is_measured(*choice.refined.candidate)) ||
            is_in_fewer_readings(choice, each)) &&
           each.refused(gates).empty() &&
           each.refined.delta_bic <= choice.refined.delta_bic + tie(each, choice, gates) &&
           std::ranges::count(excluded, each.name()) == 0 && alike(each, choice, gates);
  });
  return at == tested.end() ? nullptr : &*at;
}

std::vector<const TestedCandidate*> SearchRound::as_good_as(const TestedCandidate& chosen,
                                                            const Gates& gates) const {
  std::vector<const TestedCandidate*> out;
  const auto is_same_effect = [](const TestedCandidate& a, const TestedCandidate& b) {
    return a.refined.candidate->effect_name() == b.refined.candidate->effect_name();
  };
  const auto unknowns = [](const TestedCandidate& each) {
    return each.refined.candidate->unknowns(each.refined.projection.rank);
  };
  // The same in other cuts; not of traces, each of which lies in a place of its own.
  const auto is_known = [&](const TestedCandidate& each) {
    if (!is_same_effect(each, chosen))
      return std::ranges::any_of(out,
                                 [&](const auto* other) { return is_same_effect(*other, each); });
    return each.name() == chosen.name() || is_of_place(*each.refined.candidate) ||
           is_kinematic(*each.refined.candidate);
  };
  // What is of a trace's place is one form where the values do not show how far it is off.
  const auto are_of_place = [&](const TestedCandidate& each) {
    return is_of_place(*each.refined.candidate) && is_of_place(*chosen.refined.candidate);
  };
  for (const TestedCandidate& each : tested) {
    const bool is_untold = !each.refined.candidate->takes.empty();
    const bool counts =
        (is_untold ? each.fails(gates) : each.refused(gates)).empty() ||
        (each.is_possible() && (unknowns(each) <= unknowns(chosen) || are_of_place(each) ||
                                chosen.refined.candidate->term.effect->is_carriage()));
    if (counts && !is_known(each) &&
        each.refined.delta_bic <= chosen.refined.delta_bic + tie(each, chosen, gates) &&
        alike(each, chosen, gates))
      out.push_back(&each);
  }
  return out;
}

std::vector<const TestedCandidate*> SearchRound::rivals(const TestedCandidate& chosen,
                                                        const Gates& gates) const {
  std::vector<const TestedCandidate*> out = as_good_as(chosen, gates);
  std::erase_if(out, [&](const auto* each) { return ranks_below(*each, chosen); });
  return out;
}

std::vector<const TestedCandidate*> SearchRound::in_more_readings(
    const TestedCandidate& chosen) const {
  std::vector<const TestedCandidate*> out;
  const Effect& effect = *chosen.refined.candidate->term.effect;
  if (!effect.description().of_instrument || !effect.departures().of_law) return out;
  for (const TestedCandidate& each : tested)
    if (is_in_fewer_readings(chosen, each) && each.is_possible()) out.push_back(&each);
  return out;
}

std::vector<const TestedCandidate*> SearchRound::outranked(const TestedCandidate& chosen,
                                                           const Gates& gates) const {
  std::vector<const TestedCandidate*> out = as_good_as(chosen, gates);
  std::erase_if(out, [&](const auto* each) { return !ranks_below(*each, chosen); });
  return out;
}

SearchRound search_round(const Model& model, const Solution& fit, const Candidates& candidates,
                         std::optional<Calibration>& calibration,
                         const std::function<void(double)>& progress) {
  const FreeValues beside = undescribed_beside(model, fit, fit.noise);
  auto [data, findings] = whiten_beside(model, fit, beside, candidates);
  SearchRound out{std::move(data), {}};
  if (candidates.empty()) return out;
  if (!calibration ||
      probability_of_others(out.data.noise()) < kBetterKnown * calibration->of_others)
    calibration = calibrate(out.data, candidates, model.gates, progress);
  out.tested = test_best(model, fit, out.data, findings, *calibration);
  if (out.tested.empty() ||
      !out.tested.front().refined.candidate->term.effect->description().steep_at_centre)
    return out;
  const Refined& best = out.tested.front().refined;
  const FreeValues undescribed =
      undescribed_beside(model, fit, out.data.noise(), best.columns * best.projection.amplitudes);
  if (count_of(undescribed) == count_of(beside)) return out;
  std::tie(out.data, findings) = whiten_beside(model, fit, undescribed, candidates);
  out.tested = test_best(model, fit, out.data, findings, *calibration);
  return out;
}

}  // namespace slideway
