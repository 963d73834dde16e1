#include "shown.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

#include "dictionary.hpp"
#include "fit_numbers.hpp"
#include "search.hpp"
#include "slideway/base/distribution.hpp"
#include "slideway/base/statistics.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/left_out.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway {
namespace {

ModelTerm term_of(const Model& model, const std::string& name, const EffectOptions& options) {
  return {term_name(name, options.profiles),
          make_effect(name, options, model.machine, model.range),
          {}};
}

/// The span of the largest of some columns, at most so many.
Eigen::MatrixXd largest(const Eigen::MatrixXd& columns, double most) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(columns.cols()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::stable_sort(order, std::greater(),
                           [&](Eigen::Index c) { return columns.col(c).squaredNorm(); });
  order.resize(std::min(order.size(), static_cast<std::size_t>(std::max(most, 0.0))));
  return orthonormal(columns(Eigen::all, order));
}

/// What the low band of a profile shows beside the model.
struct Beside {
  // Of the values of parameters, and behind those of their uncertainties. What the form of one
  // profile can take is in them: other profiles share that form, and not the marks.
  Eigen::MatrixXd images;
  // Of what is faster than slow cosines: the square without and with the images, that of their sum,
  // its product with the values, what the columns of the effect without options take, and their
  // number.
  double before = 0.0, after = 0.0, of_sum = 0.0, shared = 0.0;
  double taken_by_whole = 0.0, columns_of_whole = 0.0;
  double degrees = 0.0;  // of freedom of what is fast
  double noise = 0.0;    // variance of a value, where other effects do not raise it
  Eigen::MatrixXd slow;  // what is as slow as cosines beside the model, orthonormal

  Beside(const Model& model, const Estimate& estimate, const Observation& observation,
         const Eigen::MatrixXd& of_parts, const Eigen::MatrixXd& of_whole, double noise_of_fit) {
    const Eigen::Index n = observation.values.size(), parts = of_parts.cols();
    const Eigen::MatrixXd linear = linear_columns(model, estimate, observation);
    Eigen::MatrixXd all(n, parts + of_whole.cols() + 1 + linear.cols());
    all << of_parts, of_whole, observation.values, linear;
    const Eigen::VectorXd whole_lengths = all.colwise().norm();
    all = levelled(observation, std::move(all));
    clear_rounding(all, whole_lengths);
    images = all.leftCols(parts);
    const Eigen::MatrixXd form = orthonormal(all.rightCols(linear.cols()));
    project_out(form, all);
    slow = orthonormal(levelled(observation, slow_cosines(n, slow_cosine_count(n, model.gates))));
    project_out(slow, all);
    const Eigen::VectorXd values = all.col(parts + of_whole.cols());
    const Eigen::MatrixXd whole = orthonormal(all.middleCols(parts, of_whole.cols()));
    const Eigen::VectorXd sum = all.leftCols(parts / 2).rowwise().sum();
    before = values.squaredNorm();
    shared = values.dot(sum);
    of_sum = sum.squaredNorm();
    Eigen::VectorXd rest = values - sum;
    after = rest.squaredNorm();
    taken_by_whole = (whole.transpose() * values).squaredNorm();
    columns_of_whole = static_cast<double>(whole.cols());
    degrees = static_cast<double>(n - observation.left_out() - form.cols() - slow.cols() -
                                  std::ssize(observation.nuisance_names));
    const Eigen::MatrixXd unsure = largest(all.middleCols(parts / 2, parts / 2), degrees / 4.0);
    rest -= unsure * (unsure.transpose() * rest);
    const double free = degrees - static_cast<double>(unsure.cols());
    // The few at the axis and the rim, where grooves have another form, may be far larger.
    const double of_most = deviation_of_most({rest.data(), static_cast<std::size_t>(rest.size())});
    noise = std::min({rest.squaredNorm() / free, noise_of_fit * noise_of_fit,
                      of_most * of_most * degrees / free});
  }

  /// Of the images together, to be expected.
  [[nodiscard]] double square() const { return square_of(images); }

  /// The slow part of that: few values of noise hide it.
  [[nodiscard]] double slow_square() const { return square_of(slow.transpose() * images); }

 private:
  static double square_of(const Eigen::MatrixXd& columns) {
    const Eigen::Index parameters = columns.cols() / 2;
    return columns.leftCols(parameters).rowwise().sum().squaredNorm() +
           columns.rightCols(parameters).squaredNorm();
  }
};

constexpr double kLeast = 0.5;    // of the noise of a value, or of what the samples say
constexpr double kCertain = 2.0;  // standard uncertainties

/// Whether the image is not far below the noise of the low band, or its slow part stands out of
/// that, and what is fast in the low band does not have for certain less than half of it.
bool has_image(const Beside& beside) {
  const double rest = beside.after / beside.degrees;
  return (beside.square() >= kLeast * kLeast * beside.degrees * beside.noise ||
          beside.slow_square() >= kCertain * kCertain * beside.noise) &&
         beside.shared + kCertain * std::sqrt(rest * beside.of_sum) >= kLeast * beside.of_sum;
}

constexpr double kTenth = 0.01;  // of the square
constexpr std::size_t kMostBounded = 16;

/// Whether the effect without options takes as much of what is fast. Where that is far more than
/// noise makes of its columns, a tie is enough: it is the simpler one, and that of all cuts.
bool whole_takes_as_much(const Beside& beside) {
  const double noise = beside.after / beside.degrees;
  const double price = noise * beside.columns_of_whole * std::log(beside.degrees);
  const bool is_clear = price < kTenth * beside.taken_by_whole;
  return beside.before - beside.after < beside.taken_by_whole + (is_clear ? price : -price);
}

/// The harmonics whose image in the low band stands out of its noise, which may hold what is
/// missing, or is a tenth of that of all; of those whose values are not known but bounded, the most
/// visible ones.
std::vector<std::size_t> seen_in(const Beside& beside, const ShownBySamples& shown) {
  const Eigen::Index parameters = beside.images.cols() / 2;
  std::vector<std::size_t> out, bounded;
  const std::vector<int>& harmonics = shown.options.harmonics;
  const Eigen::Index own = parameters / std::ssize(harmonics);
  const auto image = [&](std::size_t h) {
    const auto column = own * static_cast<Eigen::Index>(h);
    return beside.images.middleCols(column, own).squaredNorm() +
           beside.images.middleCols(parameters + column, own).squaredNorm();
  };
  for (std::size_t h = 0; h < harmonics.size(); ++h) {
    if (image(h) < std::min(kCertain * kCertain * beside.noise, kTenth * beside.square())) continue;
    (std::ranges::count(shown.bounded, harmonics[h]) > 0 ? bounded : out).push_back(h);
  }
  std::ranges::stable_sort(bounded, std::greater(), image);
  bounded.resize(std::min(bounded.size(), kMostBounded));
  out.insert(out.end(), bounded.begin(), bounded.end());
  std::ranges::sort(out);
  return out;
}

/// The mean of both halves in the place of each, where the low band does not show the difference:
/// it changes a value by less than half its noise, and what is not known of it is not seen where it
/// is slow. @return whether it does not
bool join_halves(const Model& model, const std::string& name, const Observation& observation,
                 const Beside& beside, ShownBySamples& shown) {
  EffectOptions options = shown.options;
  options.profiles = {observation.profile->name};
  const ModelTerm term = term_of(model, name, options);
  const auto count = std::ssize(shown.values);
  Eigen::VectorXd apart(count);
  Eigen::MatrixXd unsure = Eigen::MatrixXd::Zero(count, count);
  std::vector<Prior> means;
  for (std::size_t k = 0; k + 3 < shown.values.size(); k += 4)
    for (const std::size_t p : {k, k + 1}) {  // cosine and sine of the near half, then the far one
      const Prior &near = shown.values[p], &far = shown.values[p + 2];
      const double half = 0.5 * (near.value - far.value);
      apart[static_cast<Eigen::Index>(p)] = half;
      apart[static_cast<Eigen::Index>(p + 2)] = -half;
      const double uncertainty = std::hypot(near.standard_uncertainty, far.standard_uncertainty);
      unsure(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(p)) = 0.5 * uncertainty;
      unsure(static_cast<Eigen::Index>(p + 2), static_cast<Eigen::Index>(p)) = -0.5 * uncertainty;
      means.push_back({near.parameter, near.value - half, std::hypot(half, 0.5 * uncertainty)});
    }
  const Eigen::MatrixXd columns = low_band_columns(model, term, observation, {});
  const Eigen::VectorXd image = columns * term.effect->from_parameters(apart);
  if (image.squaredNorm() > kLeast * kLeast * beside.noise * static_cast<double>(image.size()))
    return false;
  Eigen::MatrixXd open(image.size(), count);
  for (Eigen::Index k = 0; k < count; ++k)
    open.col(k) = columns * term.effect->from_parameters(unsure.col(k));
  open = beside.slow.transpose() * levelled(observation, std::move(open));
  if (open.squaredNorm() > kCertain * kCertain * beside.noise) return false;
  shown.options.each_half = false;
  shown.values = std::move(means);
  return true;
}

std::optional<ShownEffect> shown_in(const FittedModel& declared, const std::string& name,
                                    const Observation& observation, const Noise& noise) {
  const Model& model = declared.model;
  const Profile& profile = *observation.profile;
  const Effect& effect = specimen(name);
  if (!effect.applies_to(profile.setup) || !effect.lacking(profile.setup).empty())
    return std::nullopt;
  auto seen =
      effect.shown_by(profile.stations(model.machine), profile.values, model.gates.false_line);
  if (!seen) return std::nullopt;
  EffectOptions options, whole;
  whole.profiles = {profile.name};
  const auto beside_marks = [&] {
    options = seen->options;
    options.profiles = whole.profiles;
    return Beside(model, declared.fit.estimate, observation,
                  low_band_images(model, term_of(model, name, options), seen->values, observation),
                  low_band_columns(model, term_of(model, name, whole), observation, {}),
                  noise.standard_deviation());
  };
  Beside beside = beside_marks();
  if (seen->options.each_half && join_halves(model, name, observation, beside, *seen))
    beside = beside_marks();
  if (beside.degrees < 1.0) return std::nullopt;
  ShownEffect out{{name, whole, {}}, seen->p_value};
  for (const Prior& value : seen->values)
    out.depth += kMicrometre * std::max(std::abs(value.value), value.standard_uncertainty);
  if (!has_image(beside)) return std::nullopt;
  if (seen->may_be_whole && whole_takes_as_much(beside)) return out;
  const std::size_t own = seen->values.size() / options.harmonics.size();
  out.effect.options.each_half = options.each_half;
  for (const std::size_t h : seen_in(beside, *seen)) {
    out.effect.options.harmonics.push_back(options.harmonics[h]);
    const auto first = seen->values.begin() + static_cast<std::ptrdiff_t>(own * h);
    out.effect.priors.insert(out.effect.priors.end(), first,
                             first + static_cast<std::ptrdiff_t>(own));
  }
  if (out.effect.priors.empty()) return std::nullopt;
  out.is_settled = true;
  return out;
}

constexpr double kVisibleTogether = 0.25;  // of the noise of a value: several of them show together

/// The values into which the low band carries what the first and the last turn leave within one
/// feed of the rim and of the axis, by more than kVisibleTogether of the noise: as much as the
/// marks, at the axis as much as one groove leaves a feed beside it, f²/(2 r_ε). A wavelet of many
/// taps carries it further than one value. None where they are most of the profile.
ValueIndices ends_of(const Observation& observation, const ShownEffect& shown,
                     const Machine& machine, const Gates& gates, double noise) {
  const Setup& setup = observation.profile->setup;
  const double feed = *setup.feed_per_revolution();
  const Stations stations = observation.profile->stations(machine);
  Eigen::MatrixXd ends = Eigen::MatrixXd::Zero(stations.size(), 1);
  const double at_axis = std::max(shown.depth, 8.0 * largest_feed_mark(setup, 1).value_or(0.0));
  for (Eigen::Index i = 0; i < stations.size(); ++i)
    if (const double r = stations.radius(i); r <= feed)
      ends(i, 0) = at_axis;
    else if (r >= *setup.cut_radius_mm - feed)
      ends(i, 0) = shown.depth;
  const Eigen::VectorXd carried = observation.low_band.apply(ends);
  ValueIndices out;
  for (Eigen::Index i = 0; i < carried.size(); ++i)
    if (std::abs(carried[i]) > kVisibleTogether * noise) out.push_back(i);
  if (static_cast<double>(out.size()) >= gates.most_lost * static_cast<double>(carried.size()))
    out.clear();
  return out;
}

Observation& observation_of(Model& model, const ShownEffect& shown) {
  return *std::ranges::find_if(model.observations, [&](const Observation& each) {
    return each.profile->name == shown.effect.options.profiles.front();
  });
}

/// Of a profile that is fitted, by the noise beside the effect.
ValueIndices ends_beside(FittedModel& with, const ShownEffect& shown) {
  const Observation& observation = observation_of(with.model, shown);
  const auto& fitted = with.fit.linear.observations;
  const auto place = std::ranges::find(fitted, &observation) - fitted.begin();
  return ends_of(observation, shown, with.model.machine, with.model.gates,
                 with.fit.noise[static_cast<std::size_t>(place)].standard_deviation());
}

TraceRound round_of(const ShownEffect& shown, const FittedModel& without, const FittedModel& with) {
  const ModelResult before = summarise(without.model, without.fit),
                    after = summarise(with.model, with.fit);
  TraceRound out;
  out.accepted = shown.effect.name;
  out.profiles = shown.effect.options.profiles;
  out.before_rms_um = before.rms_um;
  out.after_rms_um = after.rms_um;
  out.before_rms_urad = before.rms_urad;
  out.after_rms_urad = after.rms_urad;
  out.p_value = shown.p_value;
  const Whitened data(without.fit.linear, with.fit.noise);
  const Projection own = project(data, stacked_columns(without.model, with.model.terms.back(), {},
                                                       data.rows() - data.values()));
  out.delta_bic = penalty(data, own.rank) - own.gain;
  return out;
}

bool is_absent(const ShownEffect& shown, const ModelResult& fit, const Gates& gates) {
  constexpr double kKnown = 0.25;  // of the variance of the bounds
  const std::vector<Prior>& bounds = shown.effect.priors;
  if (!shown.is_settled || bounds.empty()) return false;
  double before = 0.0, after = 0.0, found = 0.0;
  const std::vector<FittedParameter> sizes =
      parameters_of(fit, term_name(shown.effect.name, shown.effect.options.profiles));
  for (std::size_t p = 0; p < bounds.size(); ++p) {
    const FittedParameter& size = sizes[p];
    if (bounds[p].value != 0.0 || !size.value || !size.standard_uncertainty) return false;
    before += std::pow(bounds[p].standard_uncertainty, 2);
    after += std::pow(*size.standard_uncertainty, 2);
    found += std::pow(*size.value / *size.standard_uncertainty, 2);
  }
  return after < kKnown * before &&
         chi_squared_tail(static_cast<double>(bounds.size()), found) > gates.significance;
}

}  // namespace

std::vector<ShownEffect> shown_by_samples(const Problem& problem, const FittedModel& declared) {
  std::vector<ShownEffect> out;
  for (const std::string& name : problem.trace.candidates) {
    if (std::ranges::count(problem.effects, name, &DeclaredEffect::name) > 0) continue;
    const std::size_t first = out.size();
    for (std::size_t i = 0; i < declared.fit.noise.size(); ++i)
      if (auto shown =
              shown_in(declared, name, *declared.fit.linear.observations[i], declared.fit.noise[i]))
        out.push_back(*std::move(shown));
    const std::span<ShownEffect> own(out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
    const bool any = std::ranges::any_of(own, &ShownEffect::is_settled);
    for (ShownEffect& each : own) each.is_settled = any;  // none of all profiles beside one
  }
  return out;
}

std::vector<ShownEffect> without_absent(std::vector<ShownEffect> shown, const FittedModel& fitted) {
  if (shown.empty()) return shown;
  const ModelResult fit = summarise(fitted.model, fitted.fit);
  std::erase_if(shown,
                [&](const ShownEffect& each) { return is_absent(each, fit, fitted.model.gates); });
  return shown;
}

std::vector<ShownEffect> of_any_phase_in(std::vector<ShownEffect> shown,
                                         const std::string& profile) {
  for (ShownEffect& each : shown) {
    if (each.effect.options.profiles.front() != profile) continue;
    std::vector<Prior>& priors = each.effect.priors;
    for (std::size_t h = 0; h + 1 < priors.size(); h += 2) {  // cosine and sine of a harmonic
      Prior &cosine = priors[h], &sine = priors[h + 1];
      const double size =
          std::hypot(std::hypot(cosine.value, sine.value),
                     std::hypot(cosine.standard_uncertainty, sine.standard_uncertainty));
      cosine.value = sine.value = 0.0;
      cosine.standard_uncertainty = sine.standard_uncertainty = size;
    }
  }
  return shown;
}

void append_settled(Model& model, const std::vector<ShownEffect>& shown) {
  for (const ShownEffect& each : shown)
    if (each.is_settled) append_term(model, each.effect, model.range);
}

ShownModel with_shown(const FittedModel& declared, const std::vector<ShownEffect>& shown) {
  std::vector<TraceRound> rounds;
  std::optional<FittedModel> last;
  for (const ShownEffect& each : shown) {
    const FittedModel& without = last ? *last : declared;
    Model model = without.model;
    append_term(model, each.effect, model.range);
    FittedModel with = fit_model(std::move(model));
    const ValueIndices ends = ends_beside(with, each);
    Model rest = each.is_settled ? with.model : without.model;
    const bool fewer = leave_out(observation_of(rest, each), ends);
    if (each.is_settled) {
      if (fewer) with = fit_model(std::move(rest));
      rounds.push_back(round_of(each, without, with));
      last.emplace(std::move(with));
    } else if (fewer || !last) {
      last.emplace(fit_model(std::move(rest)));
    }
  }
  return {*std::move(last), std::move(rounds)};
}

}  // namespace slideway
