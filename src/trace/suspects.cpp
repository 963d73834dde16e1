#include "suspects.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "detection.hpp"
#include "slideway/base/distribution.hpp"
#include "slideway/base/parallel.hpp"

namespace slideway {
namespace {

constexpr double kManyDegrees = 1e9;  // of freedom: Student's t is normal
constexpr std::size_t kPlaces = 4;    // of a rival's grid, apart from one another
/// A place alone must be this near to being taken for the suspect: with its neighbours it is
/// nearer.
constexpr double kNearness = 2.0;

double power_deviate(const Gates& gates) {
  return student_limit(kManyDegrees, 1.0 - gates.detection_power);
}

/// Non-centrality at which a difference in BIC exceeds tie_bic with the detection power: it is
/// normal about λ with the variance 4 λ.
double enough_to_tell(const Gates& gates) {
  const double z = power_deviate(gates);
  const double root = z + std::sqrt(z * z + gates.tie_bic);
  return root * root;
}

std::vector<Eigen::Index> counted_from(Eigen::Index first, Eigen::Index count) {
  std::vector<Eigen::Index> out(static_cast<std::size_t>(count));
  for (Eigen::Index i = 0; i < count; ++i) out[static_cast<std::size_t>(i)] = first + i;
  return out;
}

/// Mean over the phase of an effect that has one.
double mean_gain(const Eigen::MatrixXd& gram) {
  return gram.diagonal().head(std::min<Eigen::Index>(gram.rows(), 2)).mean();
}

}  // namespace

Suspects::Suspects(Dictionary dictionary, const FittedModel& base)
    : base_(base), dictionary_(std::move(dictionary)) {
  const Whitened data(base_.fit.linear, base_.fit.noise);
  choose_suspects(data);
  find_pairs(data);
}

void Suspects::choose_suspects(const Whitened& data) {
  Candidates chosen;
  for (const Candidate& candidate : dictionary_.candidates) {
    const Effect& effect = *candidate.term.effect;
    if (!candidate.stands_for_effect() || candidate.raises_degree || effect.is_carriage() ||
        !effect.has_one_size())
      continue;
    Suspect& suspect = suspects_.emplace_back();
    suspect.candidate = &candidate;
    suspect.shape = candidate.grid.middle();
    Eigen::VectorXd values =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effect.parameters().size()));
    values[0] = 1.0;
    for (std::size_t s = 0; s < suspect.shape.size(); ++s)
      values[effect.shapes()[s].parameter] = suspect.shape[s];
    suspect.unit = effect.from_parameters(values).head(candidate.amplitudes());
    suspect.columns = counted_from(columns_, candidate.amplitudes());
    columns_ += candidate.amplitudes();
    for (std::size_t s = 0; s < suspect.shape.size(); ++s, columns_ += candidate.amplitudes())
      suspect.derivatives.push_back(counted_from(columns_, candidate.amplitudes()));
    suspect.most = INFINITY;
    for (const Observation* observation : base_.fit.linear.observations) {
      const double reach =
          (low_band_columns(base_.model, candidate.term, *observation, suspect.shape) *
           suspect.unit)
              .cwiseAbs()
              .maxCoeff();
      const double range = observation->values.maxCoeff() - observation->values.minCoeff();
      if (reach > 0.0)
        suspect.most = std::min(suspect.most, base_.model.gates.most_of_range * range / reach);
    }
    chosen.push_back(&candidate);
  }
  hidden_ = inseparable(base_.model, base_.fit, data, chosen);
}

std::vector<std::vector<Suspects::Place>> Suspects::likely_places(
    const Candidate& rival, const Whitened& data, const Eigen::MatrixXd& white) const {
  const Eigen::MatrixXd left = left_beside(data, rival, white);
  std::vector<std::vector<Place>> out(suspects_.size());
  for (std::size_t s = 0; s < suspects_.size(); ++s) {
    const Suspect& suspect = suspects_[s];
    if (!suspect.limit || suspect.candidate->effect_name() == rival.effect_name()) continue;
    Eigen::RowVectorXd own = left.row(suspect.columns[0]);
    if (suspect.columns.size() > 1) own = 0.5 * (own + left.row(suspect.columns[1]));
    const Gates& gates = base_.model.gates;
    const double size = gates.planned_size * *suspect.limit / kNearness;
    const double near = enough_to_tell(gates) / (size * size * suspect.unit.squaredNorm());
    for (Eigen::Index at = 0; out[s].size() < kPlaces; own[at] = INFINITY) {
      if (!(own.minCoeff(&at) <= near)) break;
      out[s].push_back({&rival, rival.grid.around(at)});
      for (const Eigen::Index beside : out[s].back().atoms) own[beside] = INFINITY;
    }
  }
  return out;
}

std::vector<Eigen::Index> Suspects::columns_of(const Place& place) {
  std::vector<Eigen::Index> out;
  for (const Eigen::Index atom : place.atoms) {
    auto known = std::ranges::find_if(placed_, [&](const PlacedColumns& each) {
      return each.candidate == place.candidate && each.atom == atom;
    });
    if (known == placed_.end()) {
      placed_.push_back({place.candidate, atom, columns_});
      columns_ += place.candidate->amplitudes();
      known = std::prev(placed_.end());
    }
    for (const Eigen::Index column : counted_from(known->first, place.candidate->amplitudes()))
      out.push_back(column);
  }
  return out;
}

void Suspects::put_on_paper() {
  present_.clear();
  for (std::size_t i = 0; i < base_.fit.linear.observations.size(); ++i)
    present_.push_back(on_paper(*base_.fit.linear.observations[i], base_.fit.noise[i]));
}

namespace {

std::vector<const PaperProfile*> pointers_to(const std::vector<PaperProfile>& profiles) {
  std::vector<const PaperProfile*> out;
  for (const PaperProfile& profile : profiles) out.push_back(&profile);
  return out;
}

}  // namespace

void Suspects::find_pairs(const Whitened& data) {
  put_on_paper();
  const Eigen::MatrixXd& priors = base_.fit.linear.prior_rows;
  {
    const PaperData paper(pointers_to(present_), priors);
    for (Suspect& suspect : suspects_) suspect.limit = limit(suspect, paper);
  }
  Eigen::MatrixXd white = Eigen::MatrixXd::Zero(data.rows(), columns_);
  for (const Suspect& suspect : suspects_)
    white.middleCols(suspect.columns[0], std::ssize(suspect.columns)) =
        stacked_columns(base_.model, suspect.candidate->term, suspect.shape, priors.rows());
  white = data.outside(std::move(white));
  Candidates rivals;
  for (const Candidate& candidate : dictionary_.candidates)
    if (candidate.stands_for_effect()) rivals.push_back(&candidate);
  std::vector<std::vector<std::vector<Place>>> found(rivals.size());
  parallel_for(rivals.size(),
               [&](std::size_t r) { found[r] = likely_places(*rivals[r], data, white); });
  std::vector<Rivalry> rivalries;
  for (std::size_t r = 0; r < rivals.size(); ++r)
    for (std::size_t s = 0; s < suspects_.size(); ++s) {
      if (found[r][s].empty()) continue;
      Rivalry& rivalry = rivalries.emplace_back(Rivalry{s, rivals[r]->effect_name(), {}});
      for (const Place& place : found[r][s]) rivalry.places.push_back(columns_of(place));
    }
  put_on_paper();
  set_pairs(rivalries);
}

void Suspects::set_pairs(const std::vector<Rivalry>& rivalries) {
  const PaperData data(pointers_to(present_), base_.fit.linear.prior_rows);
  std::map<std::pair<std::string, std::string>, SuspectPair> pairs;
  for (const Rivalry& rivalry : rivalries) {
    const std::string& name = suspects_[rivalry.suspect].candidate->effect_name();
    pairs[std::minmax(name, rivalry.rival)].directions.push_back(rivalry);
  }
  const auto order = [](const std::optional<double>& size) { return size.value_or(INFINITY); };
  for (auto& [names, pair] : pairs) {
    std::ranges::stable_sort(pair.directions, std::ranges::greater(),
                             [&](const Rivalry& each) { return order(told_apart(each, data)); });
    pair.now = told_apart(pair, data);
    if (order(pair.now) > base_.model.gates.planned_size) pairs_.push_back(std::move(pair));
  }
}

PaperProfile Suspects::on_paper(const Observation& observation, const Noise& noise) const {
  const Model one{base_.model.machine, base_.model.range, {}, {observation}, base_.model.gates};
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(observation.values.size(), columns_);
  // A profile that lacks the metadata of an effect says nothing of it.
  const auto shows = [&](const ModelTerm& term) {
    return term.effect->lacking(observation.profile->setup).empty();
  };
  for (const Suspect& suspect : suspects_) {
    const ModelTerm& term = suspect.candidate->term;
    const Eigen::Index a = suspect.candidate->amplitudes();
    if (!shows(term)) continue;
    columns.middleCols(suspect.columns[0], a) =
        low_band_columns(one, term, one.observations[0], suspect.shape);
    if (suspect.shape.empty()) continue;
    const Eigen::MatrixXd derivatives =
        low_band_derivatives(one, term, one.observations[0], suspect.shape);
    for (std::size_t s = 0; s < suspect.shape.size(); ++s)
      columns.middleCols(suspect.derivatives[s][0], a) =
          derivatives.middleCols(static_cast<Eigen::Index>(s) * a, a);
  }
  std::map<const Candidate*, std::vector<const PlacedColumns*>> by_rival;
  for (const PlacedColumns& each : placed_) by_rival[each.candidate].push_back(&each);
  for (const auto& [rival, places] : by_rival) {
    if (!shows(rival->term)) continue;
    std::vector<std::vector<double>> shapes;
    for (const PlacedColumns* each : places)
      shapes.push_back(rival->grid.points()[static_cast<std::size_t>(each->atom)]);
    const Eigen::MatrixXd all = searched_columns(one, rival->term, shapes);
    const Eigen::Index a = rival->amplitudes();
    for (std::size_t i = 0; i < places.size(); ++i)
      columns.middleCols(places[i]->first, a) = all.middleCols(static_cast<Eigen::Index>(i) * a, a);
  }
  return {observation, noise, linear_columns(base_.model, base_.fit.estimate, observation),
          std::move(columns)};
}

std::optional<double> Suspects::limit(const Suspect& suspect, const PaperData& data) const {
  const Gates& gates = base_.model.gates;
  const Eigen::Index rank = data.rank(suspect.columns);
  if (rank == 0) return std::nullopt;
  const double enough = std::max(static_cast<double>(suspect.candidate->unknowns(rank)) *
                                         std::log(static_cast<double>(data.values())) +
                                     gates.delta_bic,
                                 gates.size * gates.size);
  const double gain = mean_gain(data.left(suspect.columns)) * suspect.unit.squaredNorm();
  double size = std::sqrt(
      chi_squared_noncentrality(static_cast<double>(rank), enough, 1.0 - gates.detection_power) /
      gain);
  if (!suspect.shape.empty() && std::isfinite(size)) {
    std::vector<Eigen::Index> all = suspect.columns;
    for (const auto& own : suspect.derivatives) all.insert(all.end(), own.begin(), own.end());
    const Eigen::Index a = std::ssize(suspect.columns), s = std::ssize(suspect.derivatives);
    const Eigen::VectorXd inner = size * suspect.unit;
    Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(std::ssize(all), a + s);
    joint.topLeftCorner(a, a).setIdentity();
    for (Eigen::Index which = 0; which < s; ++which)
      joint.block(a * (which + 1), a + which, a, 1) = inner;
    const Eigen::MatrixXd information = joint.transpose() * data.left(all) * joint;
    const Eigen::VectorXd unit = information.diagonal().unaryExpr(
        [](double square) { return square > 0.0 ? 1.0 / std::sqrt(square) : 0.0; });
    const Eigen::MatrixXd scaled = unit.asDiagonal() * information * unit.asDiagonal();
    const Eigen::MatrixXd covariance = unit.asDiagonal() *
                                       scaled.completeOrthogonalDecomposition().pseudoInverse() *
                                       unit.asDiagonal();
    const double relative =
        relative_uncertainty(*suspect.candidate->term.effect, inner, suspect.shape, covariance);
    size *= std::max(1.0, (gates.size + power_deviate(gates)) * relative);
  }
  if (!(size > 0.0) || !(size <= suspect.most)) return std::nullopt;
  return size;
}

std::optional<double> Suspects::told_apart(const Rivalry& rivalry, const PaperData& data) const {
  const Suspect& suspect = suspects_[rivalry.suspect];
  double least = INFINITY;
  for (const std::vector<Eigen::Index>& place : rivalry.places)
    least = std::min(least, mean_gain(data.left(suspect.columns, place)));
  const double gain = least * suspect.unit.squaredNorm();
  const double size = std::sqrt(enough_to_tell(base_.model.gates) / gain);
  if (!(size <= suspect.most)) return std::nullopt;
  return size / *suspect.limit;
}

std::optional<double> Suspects::told_apart(const SuspectPair& pair, const PaperData& data) const {
  double largest = 0.0;
  for (const Rivalry& rivalry : pair.directions) {
    const std::optional<double> size = told_apart(rivalry, data);
    if (!size) return std::nullopt;
    largest = std::max(largest, *size);
  }
  return largest;
}

std::string Suspects::hidden_by(const Suspect& suspect) const {
  const auto found = std::ranges::find(hidden_, suspect.candidate->name(), &NotSeparable::effect);
  return found == hidden_.end() ? "" : found->same_as;
}

}  // namespace slideway
