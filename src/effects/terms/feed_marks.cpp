#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>

#include "../groove.hpp"
#include "../line_test.hpp"
#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"
#include "slideway/base/error.hpp"

namespace slideway {
namespace {

constexpr int kMostHarmonics = 32;           // the last one a thousandth of the first
constexpr int kMostTested = 16;              // by the samples
constexpr Eigen::Index kMostSamples = 4096;  // looked at for lines
constexpr Eigen::Index kLeastSamples = 64;
constexpr double kEnds = 2.0;        // grooves at the axis and at the rim, which have another form
constexpr double kUnfolded = 0.5;    // cycles a sample
constexpr double kMostShared = 0.9;  // of the square of a harmonic with others, folded
constexpr double kCertain = 2.0;     // standard uncertainties

Description describe_feed_marks() {
  return {.name = "feed_marks",
          .plain_name = "feed marks",
          .standard_name = "kinematic roughness, scallop height f²/(8 r_ε)",
          .formula =
              "A (f/f_max)² (4u² - 1/3), u in [-1/2, 1/2] across each groove of width f; f_max the "
              "coarsest feed per turn of the problem. With harmonics h: Σ_h a_h cos 2πhu + b_h sin "
              "2πhu, in one cut: a phase and a form of its own",
          .source = "A = f²/(8 r_ε) for nose radius r_ε and feed per turn f",
          .cause = "the nose of the tool leaves one groove per turn",
          .typical =
              "8 to 83 nm at 18 µm per turn, 0.1 to 1.3 µm at 73 µm per turn (nose "
              "radius 5 to 0.5 mm)",
          .variable = IndependentVariable::revolution,
          .confounded_with =
              "nothing if the grooves are resolved; averaged over blocks of a similar width, or "
              "sampled coarser than the feed, it returns as a long alias whose phase differs from "
              "cut to cut",
          .separated_by =
              "its period is exactly the feed per turn and its height goes "
              "with the square of the feed",
          .kinematic = true};
}

// Parabola of the tool nose in each groove, mean zero.
double scallop(const Stations& stations, Eigen::Index i) {
  const double u = groove_at(stations, i).across;
  return 4.0 * u * u - 1.0 / 3.0;
}

struct Harmonic {
  int order = 1;
  Eigen::Vector2d values, uncertainties;  // of the cosine and the sine, mm
};

/// The edge of a tool is convex and leaves a ridge, where the slope jumps: a harmonic of its groove
/// is at most twice that of a parabola, which goes with 1/h².
double most_of_first(int order) { return 2.0 / (order * order); }

/// What the samples show of a groove's harmonics.
struct Spectrum {
  std::vector<Harmonic> harmonics;
  std::vector<int> bounded;  // orders of those that it does not tell from noise or other errors
};

/// The harmonics of known phase 2πu that stand out of the spectrum and that a groove can have, the
/// first one among them unless it is slow: then it is at most `most_of_slow`.
Spectrum resolved(const LineTest& lines, const Eigen::VectorXd& phase, double significance,
                  double most_of_slow) {
  std::vector<int> orders;
  std::vector<Eigen::VectorXd> phases;
  Spectrum out;
  for (int h = 1; h <= kMostHarmonics; ++h) {
    const Eigen::VectorXd own = h * phase;
    bool is_seen = h <= kMostTested && lines.is_fast(own);
    if (is_seen && !lines.stands_apart(own, phases, kMostShared)) continue;
    is_seen = is_seen && (h == 1 || lines.p_value(own) <= significance);
    if (is_seen) phases.push_back(own);
    (is_seen ? orders : out.bounded).push_back(h);
  }
  const auto fitted = [&]() -> std::vector<Harmonic> {
    if (phases.empty()) return {};
    const LineTest::Amplitudes of = lines.amplitudes(phases);
    std::vector<Harmonic> list;
    for (std::size_t k = 0; k < orders.size(); ++k) {
      const auto at = 2 * static_cast<Eigen::Index>(k);
      list.push_back({orders[k], of.values.segment<2>(at), of.uncertainties.segment<2>(at)});
    }
    return list;
  };
  const std::vector<Harmonic> all = fitted();
  const bool has_first = !all.empty() && all[0].order == 1;
  const double first = has_first ? all[0].values.norm() : most_of_slow;
  for (std::size_t k = all.size(); k-- > (has_first ? 1 : 0);) {
    const double certain = all[k].values.norm() - kCertain * all[k].uncertainties.norm();
    if (certain <= most_of_first(all[k].order) * first) continue;
    phases.erase(phases.begin() + static_cast<std::ptrdiff_t>(k));
    orders.erase(orders.begin() + static_cast<std::ptrdiff_t>(k));
  }
  out.harmonics = fitted();
  return out;
}

/// A harmonic of which only the first one, or a bound of it, is known: any part of that of a
/// parabola, with any phase, as the nose and the stylus round the ridge.
Harmonic within_parabola(double first, int order) {
  const double most = first / (order * order);
  return {order, Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(most / std::sqrt(3.0))};
}

std::vector<Parameter> parameters_of(const std::vector<int>& harmonics) {
  std::vector<Parameter> list;
  for (const int h : harmonics) {
    const std::string order = std::to_string(h);
    list.push_back({"cos" + order + "_um", "a_" + order, "µm", 0.1});
    list.push_back({"sin" + order + "_um", "b_" + order, "µm", 0.1});
  }
  return list;
}

class FeedMarks : public LinearEffect {
 public:
  explicit FeedMarks(double coarsest_feed_mm)
      : LinearEffect(describe_feed_marks(), {{"amplitude_um", "A", "µm", 0.1}},
                     diagonal_map(1, kMicrometre)),
        coarsest_feed_mm_(coarsest_feed_mm) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override { return is_face_height(setup); }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (!applies_to(stations.setup())) return void(out.setZero());
    const Setup& setup = stations.setup();
    const double feed = *setup.feed_per_revolution();
    const double part = coarsest_feed_mm_ > 0.0 ? feed / coarsest_feed_mm_ : 1.0;
    for (Eigen::Index i = 0; i < stations.size(); ++i)
      out(i, 0) = part * part * scallop(stations, i);
  }

  // The harmonics that stand out of the spectrum of the samples, where the first one is one of
  // them: sampling may have folded them, but the grooves of a cut lie where its feed says. Of those
  // that do not, and of those that it has folded to slow waves, which no spectrum tells from other
  // errors, the first one is a bound; of the first one itself, the nose radius.
  [[nodiscard]] std::optional<ShownBySamples> shown_by(const Stations& stations,
                                                       std::span<const double> values,
                                                       double significance) const override {
    const Setup& setup = stations.setup();
    const Eigen::Index all = stations.size(), count = std::min(all, kMostSamples);
    if (!applies_to(setup) || !has_grooves(setup) || count < kLeastSamples) return std::nullopt;
    const Eigen::Index first = (all - count) / 2;
    Eigen::VectorXd places(count), radii(count), phase(count), weights(count);
    const double feed = *setup.feed_per_revolution(), ends = kEnds * feed;
    for (Eigen::Index i = 0; i < count; ++i) {
      places[i] = stations.trace(first + i);
      radii[i] = stations.radius(first + i);
      phase[i] = 2.0 * kPi * groove_at(stations, first + i).across;
      weights[i] = radii[i] > ends && radii[i] < *setup.cut_radius_mm - ends ? 1.0 : 0.0;
    }
    const LineTest lines(
        values.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count)), places,
        radii, weights);
    ShownBySamples out{.p_value = lines.p_value(phase)};
    const bool is_slow = !lines.is_fast(phase);
    const std::optional<double> most = largest_feed_mark(setup, 1);
    out.may_be_whole = std::abs(stations.trace(all - 1) - stations.trace(0)) <
                       kUnfolded * static_cast<double>(all - 1) * feed;
    if (out.p_value > significance || (is_slow && (out.may_be_whole || !most))) return std::nullopt;
    auto [harmonics, bounded] = resolved(lines, phase, significance, most.value_or(0.0));
    const double largest = is_slow ? *most : harmonics[0].values.norm();
    for (const int h : bounded) harmonics.push_back(within_parabola(largest, h));
    out.bounded = std::move(bounded);
    std::ranges::sort(harmonics, {}, &Harmonic::order);
    for (const Harmonic& each : harmonics) out.options.harmonics.push_back(each.order);
    const std::vector<Parameter> parameters = parameters_of(out.options.harmonics);
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const Harmonic& each = harmonics[p / 2];
      const auto k = static_cast<Eigen::Index>(p % 2);
      out.values.push_back(
          {parameters[p].name, each.values[k] / kMicrometre, each.uncertainties[k] / kMicrometre});
    }
    return out;
  }

 private:
  double coarsest_feed_mm_;
};

// The marks of one cut, where neither their phase nor how the reading rounds them is known.
class FeedMarksOfOneCut : public LinearEffect {
 public:
  explicit FeedMarksOfOneCut(const std::vector<int>& harmonics)
      : LinearEffect(describe_feed_marks(), parameters_of(harmonics),
                     diagonal_map(2 * static_cast<int>(harmonics.size()), kMicrometre)),
        harmonics_(harmonics) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override { return is_face_height(setup); }

  [[nodiscard]] std::vector<std::string> lacking_together(
      const std::vector<const Setup*>& setups) const override {
    if (setups.size() == 1) return {};
    return {"one profile: in each cut the grooves begin elsewhere"};
  }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    if (!applies_to(stations.setup())) return void(out.setZero());
    for (Eigen::Index i = 0; i < stations.size(); ++i) {
      const auto turn = std::polar(1.0, 2.0 * kPi * groove_at(stations, i).across);
      std::complex<double> harmonic = 1.0;
      int reached = 0;
      Eigen::Index j = 0;
      for (const int h : harmonics_) {
        for (; reached < h; ++reached) harmonic *= turn;
        out(i, j++) = harmonic.real();
        out(i, j++) = harmonic.imag();
      }
    }
  }

  [[nodiscard]] double size(const Eigen::VectorXd& values) const override { return values.norm(); }

 private:
  std::vector<int> harmonics_;
};

}  // namespace

std::unique_ptr<Effect> make_feed_marks(const Request& request) {
  request.accept_only({"harmonics"});
  const std::vector<int>& harmonics = request.options.harmonics;
  if (harmonics.empty()) return std::make_unique<FeedMarks>(request.range.coarsest_feed_mm);
  if (std::ranges::adjacent_find(harmonics, std::greater_equal()) != harmonics.end() ||
      harmonics.back() > kMostHarmonics)
    throw UsageError("effect feed_marks: 'harmonics' must rise, from 1 to " +
                     std::to_string(kMostHarmonics));
  return std::make_unique<FeedMarksOfOneCut>(harmonics);
}

}  // namespace slideway
