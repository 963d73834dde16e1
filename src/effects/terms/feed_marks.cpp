#include <complex>

#include "../groove.hpp"
#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr int kMostHarmonics = 8;

Description describe_feed_marks() {
  return {
      .name = "feed_marks",
      .plain_name = "feed marks",
      .standard_name = "kinematic roughness, scallop height f²/(8 r_ε)",
      .formula =
          "A (f/f_max)² (4u² - 1/3), u in [-1/2, 1/2] across each groove of width f; f_max the "
          "coarsest feed per turn of the problem. With a degree: Σ_h a_h cos 2πhu + b_h sin 2πhu, "
          "h = 1 to degree, in one cut: a phase and a form of its own",
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
          "with the square of the feed"};
}

// Parabola of the tool nose in each groove, mean zero.
double scallop(const Stations& stations, Eigen::Index i) {
  const double u = groove_at(stations, i).across;
  return 4.0 * u * u - 1.0 / 3.0;
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
    const double feed = *setup.feed_mm_per_min / *setup.spindle_rpm;
    const double part = coarsest_feed_mm_ > 0.0 ? feed / coarsest_feed_mm_ : 1.0;
    for (Eigen::Index i = 0; i < stations.size(); ++i)
      out(i, 0) = part * part * scallop(stations, i);
  }

  // Besides: in one cut, with the harmonics the data ask for.
  [[nodiscard]] std::vector<EffectOptions> hypotheses(
      const EffectOptions* declared) const override {
    if (declared) return {};
    std::vector<EffectOptions> out(1);
    for (const int degree : {1, 2, 3, 4, 6, kMostHarmonics}) out.push_back({.degree = degree});
    return out;
  }

 private:
  double coarsest_feed_mm_;
};

std::vector<Parameter> harmonics(int degree) {
  std::vector<Parameter> list;
  for (int h = 1; h <= degree; ++h) {
    const std::string order = std::to_string(h);
    list.push_back({"cos" + order + "_um", "a_" + order, "µm", 0.1});
    list.push_back({"sin" + order + "_um", "b_" + order, "µm", 0.1});
  }
  return list;
}

// The marks of one cut, where neither their phase nor how the reading rounds them is known.
class FeedMarksOfOneCut : public LinearEffect {
 public:
  explicit FeedMarksOfOneCut(int degree)
      : LinearEffect(describe_feed_marks(), harmonics(degree),
                     diagonal_map(2 * degree, kMicrometre)) {}

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
      std::complex<double> harmonic = turn;
      for (Eigen::Index j = 0; j < out.cols(); j += 2, harmonic *= turn) {
        out(i, j) = harmonic.real();
        out(i, j + 1) = harmonic.imag();
      }
    }
  }

  [[nodiscard]] double size(const Eigen::VectorXd& values) const override { return values.norm(); }
};

}  // namespace

std::unique_ptr<Effect> make_feed_marks(const Request& request) {
  request.accept_only({"degree"});
  if (request.options.degree && *request.options.degree != 0)
    return std::make_unique<FeedMarksOfOneCut>(request.degree(0, kMostHarmonics));
  return std::make_unique<FeedMarks>(request.range.coarsest_feed_mm);
}

}  // namespace slideway
