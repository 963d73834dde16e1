// Effects with two shape parameters are searched over both. The effects live in this test alone;
// the data are made from their formulas, not with the columns under test.

#include <cmath>

#include "detection.hpp"
#include "identify/cases.hpp"
#include "refine.hpp"
#include "search.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/shape_grid.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

constexpr double kNoise = 10e-6;  // mm, white
constexpr double kFaceRadius = 10.0;

/// h = A g(r; position, width) and its derivatives; without one by position that is stepwise.
struct Form {
  double (*value)(double r, double position, double width);
  double (*by_position)(double r, double position, double width);
  double (*by_width)(double r, double position, double width);
};

double bump(double r, double p, double w) { return std::exp(-(r - p) * (r - p) / (2.0 * w * w)); }

constexpr Form kBump{
    bump, [](double r, double p, double w) { return bump(r, p, w) * (r - p) / (w * w); },
    [](double r, double p, double w) { return bump(r, p, w) * (r - p) * (r - p) / (w * w * w); }};

double jump(double r, double p, double w) { return r < p ? std::exp((r - p) / w) : 0.0; }

constexpr Form kJump{
    jump, nullptr, [](double r, double p, double w) { return jump(r, p, w) * (p - r) / (w * w); }};

class TwoShapes : public Effect {
 public:
  explicit TwoShapes(const Form& form)
      : form_(form),
        shapes_{{.parameter = 1, .stepwise = form.by_position == nullptr},
                {.parameter = 2, .logarithmic = true}} {}

  [[nodiscard]] const Description& description() const override { return description_; }
  [[nodiscard]] const std::vector<Parameter>& parameters() const override { return parameters_; }
  [[nodiscard]] int amplitudes() const override { return 1; }
  [[nodiscard]] const std::vector<Shape>& shapes() const override { return shapes_; }
  [[nodiscard]] std::pair<double, double> search_range(int shape, const Stations&) const override {
    return shape == 0 ? std::pair{0.5, 9.5} : std::pair{0.2, 3.0};
  }
  [[nodiscard]] bool applies_to(const Setup& setup) const override {
    return setup.kind == Kind::face;
  }
  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    for (Eigen::Index i = 0; i < stations.size(); ++i)
      out(i, 0) = form_.value(stations.radius(i), shape[0], shape[1]);
  }
  void derivatives(const Stations& stations, std::span<const double> shape,
                   Eigen::Ref<Eigen::MatrixXd> out) const override {
    const decltype(form_.by_position) slopes[] = {form_.by_position, form_.by_width};
    for (Eigen::Index s = 0; s < 2; ++s)
      for (Eigen::Index i = 0; i < stations.size(); ++i)
        out(i, s) = slopes[s] ? slopes[s](stations.radius(i), shape[0], shape[1]) : 0.0;
  }
  [[nodiscard]] ParameterValues parameter_values(const Eigen::VectorXd& amplitudes,
                                                 std::span<const double> shape) const override {
    Eigen::Vector3d unit(1.0 / kMicrometre, 1.0, 1.0);
    return {unit.cwiseProduct(Eigen::Vector3d(amplitudes[0], shape[0], shape[1])),
            unit.asDiagonal()};
  }
  [[nodiscard]] Eigen::VectorXd from_parameters(const Eigen::VectorXd& values) const override {
    return Eigen::Vector3d(values[0] * kMicrometre, values[1], values[2]);
  }

 private:
  Form form_;
  Description description_{.name = "two_shapes"};
  std::vector<Parameter> parameters_{{"height_um", "A", "µm", 0.1},
                                     {"position_mm", "r_c", "mm", 1.0, 0.0, kFaceRadius},
                                     {"width_mm", "w", "mm", 1.0, 0.01, kFaceRadius}};
  std::vector<Shape> shapes_;
};

/// One face of 250 readings that holds the form at a size, position and width, and what a search
/// needs of it.
struct Searched {
  Searched(const Form& form, double size_um, double position, double width)
      : problem(cases::problem(Lever::paper, 0, {cases::effect("squareness")})),
        profiles{make_face(form, size_um, position, width)},
        model(build_model(problem, profiles)),
        fitted(fit(model)),
        data(fitted.linear, {noise()}) {
    candidate.term.name = "two_shapes";
    candidate.term.effect = std::make_shared<TwoShapes>(form);
    lay_out(model, 0, candidate);
  }

  static Profile make_face(const Form& form, double size_um, double position, double width) {
    RandomStream random(7, "two shapes");
    std::vector<double> r = cases::spaced(0.0, kFaceRadius, 250), z;
    for (const double at : r)
      z.push_back(size_um * kMicrometre * form.value(at, position, width) - 2e-6 * at +
                  kNoise * random.normal());
    Profile face = cases::face("face", 2.0, r, z);
    face.standard_uncertainty = kNoise;
    return face;
  }

  static Noise noise() { return Noise::white(kNoise, 250); }

  [[nodiscard]] double gain_at(double position, double width) const {
    return project(data, stacked_columns(model, candidate.term, std::vector{position, width}, 0))
        .gain;
  }

  Problem problem;
  std::vector<Profile> profiles;
  Model model;
  Solution fitted;
  Whitened data;
  Candidate candidate;
};

// 4 u: 6e-5 of correct results fail, and the seed is fixed.
void expect_found(const Searched& searched, const Refined& refined, const Eigen::Vector3d& truth) {
  ASSERT_EQ(refined.values.size(), 3);
  for (Eigen::Index p = 0; p < 3; ++p) {
    EXPECT_GT(refined.uncertainties[p], 0.0) << p;
    EXPECT_NEAR(refined.values[p], truth[p], 4.0 * refined.uncertainties[p]) << p;
    EXPECT_LT(refined.uncertainties[p], 0.2 * truth[p]) << p;
  }
  EXPECT_GE(refined.projection.gain, searched.gain_at(truth[1], truth[2]));
  EXPECT_FALSE(refined.at_end);
}

TEST(SeveralShapes, ABumpIsFoundAtItsPositionAndWidth) {
  const Searched searched(kBump, 0.1, 6.3, 0.7);
  const std::vector<Finding> findings = search(searched.data, {&searched.candidate});
  const Refined refined = refine(searched.model, searched.data, findings[0]);
  expect_found(searched, refined, {0.1, 6.3, 0.7});
  // No point about the best one is better: both shapes stand at their optimum, not one of them.
  for (int i = -5; i <= 5; ++i)
    for (int j = -5; j <= 5; ++j)
      EXPECT_LE(searched.gain_at(refined.shape[0] + 0.02 * i, refined.shape[1] * (1.0 + 0.02 * j)),
                refined.projection.gain * (1.0 + 1e-9));
}

TEST(SeveralShapes, AStepwisePositionAndASmoothWidthAreFoundTogether) {
  const Searched searched(kJump, 0.1, 6.311, 1.3);
  const std::vector<Finding> findings = search(searched.data, {&searched.candidate});
  const Refined refined = refine(searched.model, searched.data, findings[0]);
  // Between the two readings next to it the position has one set of columns.
  EXPECT_NEAR(refined.shape[0], 6.311, kFaceRadius / 249.0);
  EXPECT_NEAR(refined.values[0], 0.1, 4.0 * refined.uncertainties[0]);
  EXPECT_NEAR(refined.values[2], 1.3, 4.0 * refined.uncertainties[2]);
}

TEST(SeveralShapes, AnEndOfEitherShapeIsTold) {
  const Searched searched(kBump, 0.3, 5.0, 8.0);  // wider than what is searched
  const std::vector<Finding> findings = search(searched.data, {&searched.candidate});
  EXPECT_TRUE(refine(searched.model, searched.data, findings[0]).at_end);
}

TEST(SeveralShapes, GridIsTheProductOfBothAndBounded) {
  const Searched searched(kJump, 0.1, 6.3, 0.7);
  const auto axes = shape_axes(searched.model, searched.candidate.term);
  ASSERT_EQ(axes.size(), 2U);
  EXPECT_EQ(searched.candidate.grid.points().size(), axes[0].size() * axes[1].size());
  EXPECT_LE(searched.candidate.grid.points().size(), 8192U);
  // 249 places and 41 widths are more than that: coarser, and from end to end.
  EXPECT_LT(axes[0].size(), 249U);
  const double spacing = kFaceRadius / 249.0;
  EXPECT_NEAR(axes[0].front(), 0.5 * spacing, 1e-9);
  EXPECT_NEAR(axes[0].back(), kFaceRadius - 0.5 * spacing, 1e-9);
}

TEST(SeveralShapes, LimitsRunOverTheFirstShapeWithTheOthersInTheMiddle) {
  const Searched searched(kBump, 0.0, 5.0, 1.0);
  const auto limits = detection_limits({searched.model, searched.fitted}, searched.data,
                                       searched.data.noise(), {&searched.candidate}, {20.0, 2.0});
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_THAT(limits[0].at, ::testing::HasSubstr("position_mm = "));
  EXPECT_THAT(limits[0].at, ::testing::HasSubstr(", width_mm = "));
  EXPECT_EQ(limits[0].by_shape.size(), 5U);
  for (const auto& [position, size] : limits[0].by_shape) {
    EXPECT_GT(position, 0.5);
    EXPECT_LT(position, 9.5);
    EXPECT_GT(size, 0.0);
    EXPECT_LT(size, 1.0);
  }
}

TEST(ShapeLattice, NeighboursLieAlongEveryAxis) {
  const ShapeLattice lattice({{1.0, 2.0, 3.0}, {10.0, 20.0}});
  ASSERT_EQ(lattice.points().size(), 6U);
  EXPECT_EQ(lattice.points()[3], (std::vector{2.0, 20.0}));
  EXPECT_EQ(lattice.neighbours(3, 0), std::pair(1.0, 3.0));
  EXPECT_EQ(lattice.neighbours(3, 1), std::pair(10.0, 20.0));
  EXPECT_THAT(lattice.around(3), ::testing::ElementsAre(1, 2, 3, 5));
  EXPECT_EQ(lattice.middle(), (std::vector{2.0, 20.0}));
  EXPECT_THAT(ShapeLattice().points(), ::testing::ElementsAre(::testing::IsEmpty()));
}

}  // namespace
}  // namespace slideway
