#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <utility>

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
constexpr double kUnfolded = 0.499;  // cycles a sample: at 0.5 no phase is shown
constexpr double kMostShared = 0.9;  // of the square of a harmonic with others, folded
constexpr double kCertain = 2.0;     // standard uncertainties

Description describe_feed_marks() {
  return {.name = "feed_marks",
          .plain_name = "feed marks",
          .standard_name = "kinematic roughness, scallop height f²/(8 r_ε)",
          .formula =
              "A (f/f_max)² (4u² - 1/3), u in [-1/2, 1/2] across each groove of width f; f_max the "
              "coarsest feed per turn of the problem. With harmonics h: Σ_h a_h cos 2πhu + b_h sin "
              "2πhu, in one cut: a phase and a form of its own; with each_half, on each half of a "
              "diameter",
          .source = "A = f²/(8 r_ε) for nose radius r_ε and feed per turn f",
          .cause = "the nose of the tool leaves one groove per turn",
          .typical =
              "8 to 83 nm at 18 µm per turn, 0.1 to 1.3 µm at 73 µm per turn (nose "
              "radius 5 to 0.5 mm)",
          .variable = IndependentVariable::revolution,
          .confounded_with =
              "nothing if the grooves are resolved; averaged over blocks of a similar width, or "
              "sampled coarser than the feed, it returns as a long alias whose phase differs from "
              "cut to cut; where the feed is not known, slide_periodic",
          .confounded_effects = {"slide_periodic"},
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

  [[nodiscard]] const Harmonic* find(int order) const {
    const auto place = std::ranges::find(harmonics, order, &Harmonic::order);
    return place == harmonics.end() ? nullptr : &*place;
  }
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
    is_seen = is_seen && lines.stands_apart(own, phases, kMostShared) &&
              (h == 1 || lines.p_value(own) <= significance);
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

std::vector<Parameter> parameters_of(const std::vector<int>& harmonics, bool each_half) {
  std::vector<Parameter> list;
  for (const int h : harmonics) {
    const std::string order = std::to_string(h);
    list.push_back({"cos" + order + "_um", "a_" + order, "µm", 0.1});
    list.push_back({"sin" + order + "_um", "b_" + order, "µm", 0.1});
    if (!each_half) continue;
    list.push_back({"cos" + order + "_far_um", "a_" + order + ",far", "µm", 0.1});
    list.push_back({"sin" + order + "_far_um", "b_" + order + ",far", "µm", 0.1});
  }
  return list;
}

bool is_far(const Stations& stations, Eigen::Index i) { return stations.trace(i) < 0.0; }

/// Samples of a profile, looked at for lines of known phase, 2πu.
struct Part {
  LineTest lines;
  Eigen::VectorXd phase;

  /// Of those from `first` to `last`, exclusive, at most kMostSamples in the middle.
  static Part of(const Stations& stations, std::span<const double> values, Eigen::Index first,
                 Eigen::Index last) {
    const Eigen::Index count = std::min(last - first, kMostSamples);
    first += (last - first - count) / 2;
    const Setup& setup = stations.setup();
    Eigen::VectorXd places(count), radii(count), phase(count), weights(count);
    const double ends = kEnds * *setup.feed_per_revolution();
    for (Eigen::Index i = 0; i < count; ++i) {
      places[i] = stations.trace(first + i);
      radii[i] = stations.radius(first + i);
      phase[i] = 2.0 * kPi * groove_at(stations, first + i).across;
      weights[i] = radii[i] > ends && radii[i] < *setup.cut_radius_mm - ends ? 1.0 : 0.0;
    }
    const auto own =
        values.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
    return {LineTest(own, places, radii, weights), std::move(phase)};
  }

  [[nodiscard]] bool is_slow() const { return !lines.is_fast(phase); }
  [[nodiscard]] double p_value() const { return lines.p_value(phase); }
};

/// The near half of a diameter and the far one; none where one of them has few samples.
std::vector<Part> halves_of(const Stations& stations, std::span<const double> values) {
  const Eigen::Index all = stations.size();
  Eigen::Index turn = 0;
  while (turn < all && is_far(stations, turn) == is_far(stations, 0)) ++turn;
  if (std::min(turn, all - turn) < kLeastSamples) return {};
  std::vector<Part> out{Part::of(stations, values, 0, turn), Part::of(stations, values, turn, all)};
  if (is_far(stations, 0)) std::swap(out[0], out[1]);
  return out;
}

/// Probability that two halves with one phase and form show their first harmonics as unlike as
/// these do: that of the lowest order that is fast and stands out of one of them. 1: none is.
double p_of_one_form(const std::vector<Part>& halves, double significance) {
  for (int h = 1; h <= kMostTested; ++h) {
    std::vector<LineTest::Amplitudes> shown;
    bool is_seen = false;
    for (const Part& half : halves) {
      const Eigen::VectorXd own = h * half.phase;
      if (!half.lines.is_fast(own)) break;
      is_seen = is_seen || half.lines.p_value(own) <= significance;
      shown.push_back(half.lines.amplitudes({own}));
    }
    if (shown.size() < halves.size() || !is_seen) continue;
    return p_of_equal_lines(shown[0].values, shown[0].uncertainties, shown[1].values,
                            shown[1].uncertainties);
  }
  return 1.0;
}

/// Whether sampling folds one of the strongest harmonics to a slow wave: its phase there turns with
/// a small part of a feed, which those that are seen may not show.
bool has_slow_one(const Part& part) {
  constexpr int kStrongest = 4;  // 1/h² of a parabola: the next one is a twenty-fifth
  for (int h = 1; h <= kStrongest; ++h)
    if (!part.lines.is_fast(h * part.phase)) return true;
  return false;
}

/// Of parts of a profile together, each part with a phase and a form of its own.
struct Spectra {
  std::vector<Spectrum> of;
  std::vector<double> largest;  // of their first harmonics, or a bound of it, mm

  Spectra(const std::vector<Part>& parts, double significance, std::optional<double> most) {
    for (const Part& part : parts) {
      of.push_back(resolved(part.lines, part.phase, significance, most.value_or(0.0)));
      largest.push_back(part.is_slow() ? most.value_or(0.0) : of.back().harmonics[0].values.norm());
    }
  }

  [[nodiscard]] bool is_seen(int order) const {
    return std::ranges::any_of(of, [&](const Spectrum& each) { return each.find(order); });
  }
  [[nodiscard]] bool is_bounded(int order) const {
    return std::ranges::all_of(
        of, [&](const Spectrum& each) { return std::ranges::count(each.bounded, order) > 0; });
  }

  void append_to(ShownBySamples& out) const {
    out.options.each_half = of.size() > 1;
    std::vector<Harmonic> harmonics;
    for (int h = 1; h <= kMostHarmonics; ++h) {
      if (!is_seen(h) && !is_bounded(h)) continue;
      out.options.harmonics.push_back(h);
      if (!is_seen(h)) out.bounded.push_back(h);
      for (std::size_t k = 0; k < of.size(); ++k) {
        const Harmonic* own = of[k].find(h);
        harmonics.push_back(own ? *own : within_parabola(largest[k], h));
      }
    }
    const auto parameters = parameters_of(out.options.harmonics, out.options.each_half);
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const Harmonic& each = harmonics[p / 2];
      const auto k = static_cast<Eigen::Index>(p % 2);
      out.values.push_back(
          {parameters[p].name, each.values[k] / kMicrometre, each.uncertainties[k] / kMicrometre});
    }
  }
};

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
  // errors, the first one is a bound; of the first one itself, the nose radius. A diameter whose
  // centre is off by part of a feed has marks of another phase on each half: where the halves are
  // unlike, where a slow one would be, or where the whole shows none, so that noise may pass at
  // twice the significance.
  [[nodiscard]] std::optional<ShownBySamples> shown_by(const Stations& stations,
                                                       std::span<const double> values,
                                                       double significance) const override {
    const Setup& setup = stations.setup();
    const Eigen::Index all = stations.size();
    if (!applies_to(setup) || !has_grooves(setup) || all < kLeastSamples) return std::nullopt;
    const std::optional<double> most = largest_feed_mark(setup, 1);
    ShownBySamples out;
    out.may_be_whole = std::abs(stations.trace(all - 1) - stations.trace(0)) <
                       kUnfolded * static_cast<double>(all - 1) * *setup.feed_per_revolution();
    const auto is_known = [&](const Part& part) {
      return !part.is_slow() || (!out.may_be_whole && most);
    };
    const std::vector<Part> whole{Part::of(stations, values, 0, all)},
        halves = halves_of(stations, values);
    out.p_value = whole[0].p_value();
    bool is_of_each = false;
    if (!halves.empty() && std::ranges::all_of(halves, is_known)) {
      is_of_each = out.p_value > significance || has_slow_one(whole[0]) ||
                   p_of_one_form(halves, significance) <= significance;
      if (out.p_value > significance)
        out.p_value = std::min({1.0, 2.0 * halves[0].p_value(), 2.0 * halves[1].p_value()});
    }
    const std::vector<Part>& parts = is_of_each ? halves : whole;
    if (out.p_value > significance || !std::ranges::all_of(parts, is_known)) return std::nullopt;
    Spectra(parts, significance, most).append_to(out);
    return out;
  }

 private:
  double coarsest_feed_mm_;
};

// The marks of one cut, where neither their phase nor how the reading rounds them is known.
class FeedMarksOfOneCut : public LinearEffect {
 public:
  FeedMarksOfOneCut(const std::vector<int>& harmonics, bool each_half)
      : LinearEffect(describe_feed_marks(), parameters_of(harmonics, each_half),
                     diagonal_map(static_cast<int>(std::ssize(harmonics)) * (each_half ? 4 : 2),
                                  kMicrometre)),
        harmonics_(harmonics),
        each_half_(each_half) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override {
    return each_half_ ? crosses_the_axis(setup) : is_face_height(setup);
  }

  [[nodiscard]] std::vector<std::string> lacking_together(
      const std::vector<const Setup*>& setups) const override {
    if (setups.size() == 1) return {};
    return {"one profile: in each cut the grooves begin elsewhere"};
  }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    out.setZero();
    if (!applies_to(stations.setup())) return;
    const Eigen::Index step = each_half_ ? 4 : 2;
    for (Eigen::Index i = 0; i < stations.size(); ++i) {
      const auto turn = std::polar(1.0, 2.0 * kPi * groove_at(stations, i).across);
      std::complex<double> harmonic = 1.0;
      int reached = 0;
      Eigen::Index j = each_half_ && is_far(stations, i) ? 2 : 0;
      for (const int h : harmonics_) {
        for (; reached < h; ++reached) harmonic *= turn;
        out(i, j) = harmonic.real();
        out(i, j + 1) = harmonic.imag();
        j += step;
      }
    }
  }

  [[nodiscard]] double size(const Eigen::VectorXd& values) const override { return values.norm(); }

 private:
  std::vector<int> harmonics_;
  bool each_half_;
};

}  // namespace

std::unique_ptr<Effect> make_feed_marks(const Request& request) {
  request.accept_only({"harmonics", "each_half"});
  const std::vector<int>& harmonics = request.options.harmonics;
  if (harmonics.empty() && request.options.each_half)
    throw UsageError("effect feed_marks: 'each_half' is of its 'harmonics', which are missing");
  if (harmonics.empty()) return std::make_unique<FeedMarks>(request.range.coarsest_feed_mm);
  if (std::ranges::adjacent_find(harmonics, std::greater_equal()) != harmonics.end() ||
      harmonics.back() > kMostHarmonics)
    throw UsageError("effect feed_marks: 'harmonics' must rise, from 1 to " +
                     std::to_string(kMostHarmonics));
  return std::make_unique<FeedMarksOfOneCut>(harmonics, request.options.each_half);
}

}  // namespace slideway
