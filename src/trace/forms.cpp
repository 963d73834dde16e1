#include "forms.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>

#include "coarse_view.hpp"
#include "form_library.hpp"
#include "form_text.hpp"
#include "process.hpp"
#include "quick_formula.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/identify/uncertainty.hpp"
#include "structure.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostSingle = 6, kMostSums = 4;  // refined
constexpr double kApart = 0.02;  // least determinant of two columns, of their squares

bool is_of_one_profile(const Unnamed& unnamed) { return clock_of(unnamed).symbol != unnamed.clock; }

/// A finding that is still to be refined.
struct Start {
  Finding finding;
  std::string form;
  bool is_sum = false;
};

class FormSearch {
 public:
  FormSearch(ModelExtender& extender, const std::vector<AcceptedEffect>& effects,
             const Unnamed& unnamed)
      : extender_(extender),
        effects_(effects),
        unnamed_(unnamed),
        gates_(extender.base().model.gates),
        last_(extender.search(effects).data) {}

  std::vector<UnnamedForm> run() {
    views_.emplace_back(extender_.extended(effects_), last_);
    if (!set_variable()) return {};
    lay_out_forms();
    attempt(views_.back(), {});
    for (std::size_t i = 0; i < effects_.size(); ++i) {
      if (!is_of_the_variable(*effects_[i].candidate->term.effect)) continue;
      views_.emplace_back(extender_.extended(all_but(effects_, i)), last_);
      attempt(views_.back(), i);
    }
    std::vector<UnnamedForm> out;
    for (const FormAttempt* each : best_few())
      out.push_back(told(*each, variable_, effects_, extender_.summary(effects_)));
    return out;
  }

 private:
  /// @return false where the readings have no range
  bool set_variable() {
    const Clock& clock = clock_of(unnamed_);
    const CoarseView& view = views_.front();
    if (is_of_one_profile(unnamed_)) profiles_ = {unnamed_.profile};
    const std::vector<Eigen::VectorXd> all =
        readings_of(view.model(), view.linear(), unnamed_.clock);
    variable_ = {clock.name, clock.unit, INFINITY,
                 -INFINITY,  INFINITY,   unnamed_.rms_um ? "um" : "urad"};
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Profile& profile = *view.linear().observations[i]->profile;
      if (!profiles_.empty() && profile.name != profiles_.front()) continue;
      const double low = all[i].minCoeff() / clock.per_unit,
                   high = all[i].maxCoeff() / clock.per_unit;
      variable_.low = std::min(variable_.low, low);
      variable_.high = std::max(variable_.high, high);
      variable_.step = std::min(variable_.step, (high - low) / static_cast<double>(all[i].size()));
    }
    return variable_.low < variable_.high;
  }

  [[nodiscard]] bool is_of_the_variable(const Effect& effect) const {
    using enum IndependentVariable;
    const IndependentVariable its = effect.description().variable;
    const IndependentVariable own = clock_of(unnamed_).variable;
    return !effect.is_carriage() && (its == own || (own == slide && its == radius));
  }

  /// A form as a candidate effect; null where it is no effect of these profiles.
  Candidate* candidate(const ShortForm& form) {
    Candidate out;
    const Model& model = views_.front().model();
    try {
      out.term.effect =
          std::make_shared<QuickFormula>(formula_effect(form.formula)(model.machine, model.range));
    } catch (const UsageError&) {  // nothing of it is seen at the places a formula is tried at
      return nullptr;
    }
    out.term.name = form.formula.name;
    out.term.profiles = profiles_;
    out.coarse = true;
    out.choice = 2.0 * std::log(static_cast<double>(forms_.size()));
    return &candidates_.emplace_back(std::move(out));
  }

  void lay_out_forms() {
    forms_ = short_forms(variable_);
    for (const ShortForm& form : forms_) {
      extender_.limit().check();
      Candidate* added = candidate(form);
      if (!added) continue;
      lay_out(views_.front().model(), last_.rows() - last_.values(), ShapeLattice(form.axes),
              *added);
      all_.push_back(added);
      names_.push_back(form.name);
      if (form.is_local) local_.push_back(added);
    }
  }

  [[nodiscard]] const std::string& name_of(const Candidate* candidate) const {
    return names_[static_cast<std::size_t>(std::ranges::find(all_, candidate) - all_.begin())];
  }

  /// Every form, and sums of two, held against what a model leaves.
  void attempt(const CoarseView& view, std::optional<std::size_t> instead_of) {
    extender_.limit().check();
    const std::vector<Finding> findings = search(view.data(), all_);
    std::vector<Start> starts;
    for (const Finding& each : findings)
      if (each.rank > 0) starts.push_back({each, name_of(each.candidate)});
    keep_best(kMostSingle, starts);
    if (!instead_of) {
      std::vector<Start> of_two = sums(view);
      keep_best(kMostSums, of_two);
      std::ranges::move(of_two, std::back_inserter(starts));
    }
    const std::size_t first = attempts_.size();
    attempts_.resize(first + starts.size());
    const double price = price_of(view, instead_of);
    parallel_for(starts.size(), [&](std::size_t i) {
      FormAttempt& out = attempts_[first + i];
      out = {starts[i].form,
             starts[i].is_sum,
             refine(view.model(), view.data(), starts[i].finding),
             0.0,
             0,
             instead_of,
             &view,
             {}};
      out.delta_bic = out.refined.delta_bic + price;
      out.unknowns = out.refined.candidate->unknowns(out.refined.projection.rank);
      if (instead_of) out.unknowns -= unknowns_of(*instead_of);
      if (profiles_.empty())
        out.held_out = leave_one_out(view.model(), view.linear(), view.data(), out.refined);
    });
  }

  static void keep_best(std::size_t most, std::vector<Start>& starts) {
    std::ranges::stable_sort(starts, {}, [](const Start& each) { return each.finding.delta_bic; });
    if (starts.size() > most)
      starts.erase(starts.begin() + static_cast<std::ptrdiff_t>(most), starts.end());
  }

  [[nodiscard]] Eigen::Index unknowns_of(std::size_t effect) const {
    const Candidate& candidate = *effects_[effect].candidate;
    return candidate.unknowns(candidate.amplitudes());
  }

  /// What it costs in BIC to do without an effect.
  [[nodiscard]] double price_of(const CoarseView& view, std::optional<std::size_t> without) const {
    if (!without) return 0.0;
    const Candidate& candidate = *effects_[*without].candidate;
    return view.data().residual().squaredNorm() - last_.residual().squaredNorm() -
           penalty(last_, candidate, candidate.amplitudes());
  }

  /// The best sum of every two kinds of local forms, over all pairs of their points on the grid.
  std::vector<Start> sums(const CoarseView& view) {
    Eigen::Index count = 0;
    for (const Candidate* each : local_) count += each->atoms();
    Eigen::MatrixXd columns(last_.rows(), count);
    std::vector<Eigen::Index> first;  // column of each kind
    for (const Candidate* each : local_) {
      first.push_back(first.empty() ? 0 : first.back() + local_[first.size() - 1]->atoms());
      columns.middleCols(first.back(), each->atoms()) = *each->columns;
    }
    columns = view.data().outside(std::move(columns));
    const Eigen::MatrixXd gram = columns.transpose() * columns;
    const Eigen::VectorXd products = columns.transpose() * view.data().residual();
    std::vector<Start> out;
    for (std::size_t p = 0; p < local_.size(); ++p)
      for (std::size_t q = p; q < local_.size(); ++q) {
        AtomPair best;
        for (Eigen::Index a = 0; a < local_[p]->atoms(); ++a)
          for (Eigen::Index b = p == q ? a + 1 : 0; b < local_[q]->atoms(); ++b)
            if (const double gain = gain_of_two(gram, products, first[p] + a, first[q] + b);
                gain > best.gain)
              best = {a, b, gain};
        add_sum(view, *local_[p], *local_[q], best, out);
      }
    return out;
  }

  struct AtomPair {
    Eigen::Index first = 0, second = 0;
    double gain = 0.0;
  };

  /// Fall of the residual's square by two columns; 0 where they are nearly one.
  static double gain_of_two(const Eigen::MatrixXd& gram, const Eigen::VectorXd& products,
                            Eigen::Index i, Eigen::Index j) {
    const double ii = gram(i, i), jj = gram(j, j), ij = gram(i, j);
    const double determinant = ii * jj - ij * ij, pi = products[i], pj = products[j];
    if (!(determinant > kApart * ii * jj)) return 0.0;
    return (pi * pi * jj - 2.0 * pi * pj * ij + pj * pj * ii) / determinant;
  }

  void add_sum(const CoarseView& view, const Candidate& first, const Candidate& second,
               const AtomPair& best, std::vector<Start>& out) {
    if (!(best.gain > 0.0)) return;
    const ShortForm form = sum_of(variable_, name_of(&first), name_of(&second));
    Candidate* sum = candidate(form);
    if (!sum) return;
    std::vector<double> start = first.grid.points()[static_cast<std::size_t>(best.first)];
    std::ranges::copy(second.grid.points()[static_cast<std::size_t>(best.second)],
                      std::back_inserter(start));
    Finding finding = about(form, start, *sum);
    finding.rank = sum->amplitudes();
    finding.gain = best.gain;
    finding.delta_bic = penalty(view.data(), *sum, finding.rank) - best.gain;
    out.push_back({finding, form.name, true});
  }

  /// The middle of a grid of three values a shape: the ends of its range, and where it starts.
  static Finding about(const ShortForm& form, const std::vector<double>& start, Candidate& sum) {
    std::vector<std::vector<double>> axes;
    for (std::size_t s = 0; s < start.size(); ++s)
      axes.push_back({form.axes[s].front(), start[s], form.axes[s].back()});
    sum.grid = ShapeLattice(std::move(axes));
    return {&sum, sum.atoms() / 2};
  }

  /// Whether an attempt is well determined and pays: one of its sizes, of a sum each of them.
  [[nodiscard]] bool passes(const FormAttempt& attempt) const {
    const Refined& refined = attempt.refined;
    const Eigen::Index sizes = refined.candidate->amplitudes();
    if (refined.projection.rank < sizes || refined.at_end || !refined.uncertainties.allFinite() ||
        !(refined.uncertainties.array() > 0.0).all() || attempt.delta_bic > -gates_.delta_bic ||
        (attempt.held_out && !attempt.held_out->helps))
      return false;
    const Eigen::ArrayXd certain =
        refined.values.head(sizes).array().abs() / refined.uncertainties.head(sizes).array();
    return attempt.is_sum ? certain.minCoeff() >= gates_.size
                          : certain.maxCoeff() >= coverage_factor(std::nullopt);
  }

  /// Not to be had by a simpler form.
  [[nodiscard]] bool pays(const FormAttempt& attempt, const std::vector<FormAttempt*>& all) const {
    return std::ranges::none_of(all, [&](const FormAttempt* other) {
      return other->unknowns < attempt.unknowns &&
             attempt.delta_bic > other->delta_bic - gates_.delta_bic;
    });
  }

  std::vector<FormAttempt*> best_few() {
    std::vector<FormAttempt*> all, out;
    for (FormAttempt& each : attempts_)
      if (passes(each)) all.push_back(&each);
    std::ranges::stable_sort(all, {}, &FormAttempt::delta_bic);
    for (FormAttempt* each : all) {
      const bool is_known = std::ranges::any_of(
          out, [&](const FormAttempt* other) { return other->form == each->form; });
      if (out.size() < static_cast<std::size_t>(gates_.most_forms) && !is_known &&
          each->delta_bic <= gates_.form_share * all.front()->delta_bic && pays(*each, all))
        out.push_back(each);
    }
    return out;
  }

  ModelExtender& extender_;
  const std::vector<AcceptedEffect>& effects_;
  const Unnamed& unnamed_;
  const Gates& gates_;
  const Whitened& last_;
  FormVariable variable_;
  std::vector<std::string> profiles_;
  std::vector<ShortForm> forms_;
  std::deque<Candidate> candidates_;
  Candidates all_, local_;
  std::vector<std::string> names_;  // of all_
  std::deque<CoarseView> views_;
  std::vector<FormAttempt> attempts_;
};

}  // namespace

std::vector<UnnamedForm> describe_in_forms(ModelExtender& extender,
                                           const std::vector<AcceptedEffect>& effects,
                                           const Unnamed& unnamed) {
  if (unnamed.clock.empty() || extender.base().model.gates.most_forms < 1.0) return {};
  return FormSearch(extender, effects, unnamed).run();
}

std::string what_separates(const Unnamed& unnamed) {
  switch (clock_of(unnamed).variable) {
    case IndependentVariable::slide:
      return "the workpiece or the straightedge moved along the slide, or the slide read with an "
             "autocollimator: a form of the slide stays at its x";
    case IndependentVariable::time:
      return "the same cut begun later, or a log of temperature, pressure or power beside it: "
             "[[channel]]";
    case IndependentVariable::distance:
      return "a fresh tool, or a tool changed half way: what goes with the distance begins anew";
    case IndependentVariable::reading_time:
      return "the same stations read back: what goes with the reading time turns round";
    default:
      return "the same trace read once more, the workpiece turned on the instrument: what is of "
             "the reading stays where it was in the trace";
  }
}

}  // namespace slideway
