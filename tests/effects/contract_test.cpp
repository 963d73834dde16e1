// What every effect of the catalogue must keep, whatever it is.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "effects/effect_cases.hpp"
#include "slideway/base/error.hpp"
#include "slideway/effects/contract.hpp"

namespace slideway::contract_test {
namespace {

using namespace testing_support;

class EffectContract : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Effect> effect_ = make(GetParam());

  // Shape parameters to try: ordinary, and each close to an end of what is possible.
  [[nodiscard]] std::vector<std::vector<double>> shapes_to_try(const Stations& stations) const {
    std::vector<double> ordinary;
    for (std::size_t s = 0; s < effect_->shapes().size(); ++s) {
      const auto [low, high] = effect_->search_range(static_cast<int>(s), stations);
      ordinary.push_back(low > 0.0 ? std::sqrt(low * high) : low + 0.3 * (high - low));
    }
    std::vector<std::vector<double>> result{ordinary};
    for (std::size_t s = 0; s < ordinary.size(); ++s) {
      const Parameter& p = effect_->parameters()[effect_->shapes()[s].parameter];
      const auto [low, high] = effect_->search_range(static_cast<int>(s), stations);
      // The last two lie far outside the search: three decades beyond, or the bound itself.
      for (const double end :
           {low, high, std::max(p.lower, low * 1e-3), std::min(p.upper, high * 1e3)}) {
        result.push_back(ordinary);
        result.back()[s] = end;
      }
    }
    return result;
  }

  template <typename Check>
  void for_each_case(Check&& check) const {
    for (const Case& profile : all_cases()) {
      if (!effect_->applies_to(profile.setup)) continue;
      SCOPED_TRACE(profile.name);
      const Stations stations(profile.positions, profile.setup, lathe());
      for (const std::vector<double>& shape : shapes_to_try(stations)) {
        SCOPED_TRACE(::testing::PrintToString(shape));
        check(stations, shape);
      }
    }
  }

  [[nodiscard]] Eigen::MatrixXd columns_at(const Stations& stations,
                                           const std::vector<double>& shape) const {
    Eigen::MatrixXd out(stations.size(), effect_->amplitudes());
    effect_->columns(stations, shape, out);
    return out;
  }
};

TEST_P(EffectContract, IsDescribedInFull) {
  const Description& d = effect_->description();
  EXPECT_EQ(d.name, GetParam());
  for (const std::string& text : {d.plain_name, d.standard_name, d.formula, d.source, d.cause,
                                  d.typical, d.confounded_with, d.separated_by})
    EXPECT_FALSE(text.empty());
}

TEST_P(EffectContract, DeclaresUnitsScalesAndBounds) {
  for (const Parameter& p : effect_->parameters()) {
    SCOPED_TRACE(p.name);
    EXPECT_FALSE(p.name.empty());
    EXPECT_FALSE(p.symbol.empty());
    EXPECT_FALSE(p.unit.empty());
    EXPECT_GT(p.scale, 0.0);
    EXPECT_LT(p.lower, p.upper);
  }
  EXPECT_EQ(effect_->parameters().size(), effect_->amplitudes() + effect_->shapes().size());
}

TEST_P(EffectContract, AppliesToSomethingAndFillsFiniteColumns) {
  int cases = 0;
  for_each_case([&](const Stations& stations, const std::vector<double>& shape) {
    ++cases;
    EXPECT_TRUE(columns_at(stations, shape).allFinite());
    Eigen::MatrixXd out(stations.size(), std::ssize(shape) * effect_->amplitudes());
    effect_->derivatives(stations, shape, out);
    EXPECT_TRUE(out.allFinite());
  });
  EXPECT_GT(cases, 0);
}

TEST_P(EffectContract, IsZeroOnReadingsItDoesNotApplyTo) {
  for (const Case& profile : all_cases()) {
    if (effect_->applies_to(profile.setup) || GetParam() == "centre_step") continue;
    const std::vector<double> shape(effect_->shapes().size(), 1.0);
    EXPECT_TRUE(columns(*effect_, profile, shape).isZero(0.0)) << profile.name;
  }
}

TEST_P(EffectContract, ZeroAmplitudeGivesZero) {
  for_each_case([&](const Stations& stations, const std::vector<double>& shape) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(effect_->amplitudes());
    EXPECT_TRUE((columns_at(stations, shape) * none).isZero(0.0));
    const ParameterValues values = effect_->parameter_values(none, shape);
    EXPECT_EQ(effect_->size(values.values), 0.0);
    EXPECT_TRUE(values.jacobian.allFinite());
  });
}

TEST_P(EffectContract, DerivativesAgreeWithCentralDifferences) {
  for_each_case([&](const Stations& stations, const std::vector<double>& shape) {
    const Eigen::Index amplitudes = effect_->amplitudes();
    Eigen::MatrixXd slopes(stations.size(), std::ssize(shape) * amplitudes);
    effect_->derivatives(stations, shape, slopes);
    for (std::size_t which = 0; which < shape.size(); ++which) {
      const Eigen::MatrixXd slope =
          slopes.middleCols(static_cast<Eigen::Index>(which) * amplitudes, amplitudes);
      if (effect_->shapes()[which].stepwise) {
        EXPECT_TRUE(slope.isZero(0.0));
        continue;
      }
      const double largest = slope.cwiseAbs().maxCoeff();
      const double size = columns_at(stations, shape).cwiseAbs().maxCoeff();
      if (size == 0.0) continue;  // not seen here: nothing tells the size of a step
      // A step that changes the columns by 1e-4 of their size: truncation is then of order 1e-8.
      double step = 1e-4 * std::abs(shape[which]);
      if (largest > 0.0) step = std::min(step, 1e-4 * size / largest);
      std::vector<double> plus = shape, minus = shape;
      plus[which] += step;
      minus[which] -= step;
      const Eigen::MatrixXd difference =
          (columns_at(stations, plus) - columns_at(stations, minus)) / (plus[which] - minus[which]);
      // Rounding of the columns, and of a phase that may run to many turns, over the step.
      const double rounding = 1e-15 * (size + largest * std::abs(shape[which])) / step;
      EXPECT_LE((difference - slope).cwiseAbs().maxCoeff(), 1e-5 * largest + rounding);
    }
  });
}

TEST_P(EffectContract, ParametersAndAmplitudesAreInverse) {
  for_each_case([&](const Stations&, const std::vector<double>& shape) {
    Eigen::VectorXd amplitudes(effect_->amplitudes());
    for (Eigen::Index i = 0; i < amplitudes.size(); ++i)
      amplitudes[i] = 1e-3 * std::cos(1.0 + 2.0 * static_cast<double>(i));  // no zero among them
    const Eigen::VectorXd values = effect_->parameter_values(amplitudes, shape).values;
    const Eigen::VectorXd back = effect_->from_parameters(values);
    // Degree 5 on [0, 600] loses 3 digits in the powers of x.
    EXPECT_LT((back.head(amplitudes.size()) - amplitudes).norm(), 1e-12 * amplitudes.norm());
    for (std::size_t i = 0; i < shape.size(); ++i)
      EXPECT_DOUBLE_EQ(back[amplitudes.size() + static_cast<Eigen::Index>(i)], shape[i]);
  });
}

TEST_P(EffectContract, ParameterJacobianAgreesWithCentralDifferences) {
  const std::vector<double> shape(effect_->shapes().size(), 3.0);
  Eigen::VectorXd at(effect_->amplitudes() + static_cast<Eigen::Index>(shape.size()));
  for (Eigen::Index i = 0; i < at.size(); ++i)
    at[i] = 1e-3 * std::cos(1.0 + 2.0 * static_cast<double>(i));
  at.tail(shape.size()).setConstant(3.0);
  const auto values_at = [&](const Eigen::VectorXd& point) {
    const std::vector<double> moved(point.data() + effect_->amplitudes(),
                                    point.data() + point.size());
    return effect_->parameter_values(point.head(effect_->amplitudes()), moved);
  };
  const Eigen::MatrixXd jacobian = values_at(at).jacobian;
  for (Eigen::Index j = 0; j < at.size(); ++j) {
    const double step = 1e-4 * std::abs(at[j]);
    Eigen::VectorXd plus = at, minus = at;
    plus[j] += step;
    minus[j] -= step;
    const Eigen::VectorXd difference =
        (values_at(plus).values - values_at(minus).values) / (plus[j] - minus[j]);
    for (Eigen::Index i = 0; i < difference.size(); ++i) {
      // Truncation is of order 1e-8 of the row's size, rounding 1e-16 of the value over the step.
      const double tolerance = 1e-6 * jacobian.row(i).cwiseAbs().maxCoeff() +
                               1e-15 * std::abs(values_at(at).values[i]) / step;
      EXPECT_NEAR(difference[i], jacobian(i, j), tolerance) << i << " " << j;
    }
  }
}

TEST_P(EffectContract, IsLinearAsDeclared) {
  const std::vector<double> shape(effect_->shapes().size(), 3.0);
  Eigen::VectorXd a(effect_->amplitudes()), b(effect_->amplitudes());
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    a[i] = std::cos(static_cast<double>(i));
    b[i] = std::sin(1.0 + static_cast<double>(i));
  }
  const auto head = [&](const Eigen::VectorXd& amplitudes) -> Eigen::VectorXd {
    return effect_->parameter_values(amplitudes, shape)
        .values.head(static_cast<Eigen::Index>(effect_->parameters().size() - shape.size()));
  };
  const Eigen::VectorXd defect = head(a + b) - head(a) - head(b);
  const double scale = head(a).cwiseAbs().maxCoeff();
  if (effect_->linear_parameters())
    EXPECT_LT(defect.norm(), 1e-12 * scale);
  else
    EXPECT_GT(defect.norm(), 1e-3 * scale);
}

TEST_P(EffectContract, NamesTheMetadataItLacks) {
  for (const Case& profile : all_cases()) {
    if (!effect_->applies_to(profile.setup)) continue;
    EXPECT_TRUE(effect_->lacking(profile.setup).empty()) << profile.name;
    slideway::Setup bare = profile.setup;
    bare.feed_mm_per_min.reset();
    bare.spindle_rpm.reset();
    bare.cut_direction.reset();
    bare.traverse_mm_per_s.reset();
    const std::vector<std::string> lacking = effect_->lacking(bare);
    for (const std::string& key : missing_for(effect_->description().variable, bare))
      EXPECT_THAT(lacking, ::testing::Contains(key));
    std::set<std::string> needed(lacking.begin(), lacking.end());
    for (const std::string& key : missing_for(effect_->description().variable, bare))
      needed.erase(key);
    needed.erase("cut_direction");  // of what changes its sign with it
    EXPECT_THAT(needed, ::testing::IsEmpty());
  }
}

TEST_P(EffectContract, SearchesInsideTheBounds) {
  for (const Case& profile : all_cases()) {
    if (!effect_->applies_to(profile.setup)) continue;
    const Stations stations(profile.positions, profile.setup, lathe());
    for (std::size_t i = 0; i < effect_->shapes().size(); ++i) {
      const auto [low, high] = effect_->search_range(static_cast<int>(i), stations);
      const Parameter& p = effect_->parameters()[effect_->shapes()[i].parameter];
      EXPECT_LT(low, high) << profile.name;
      EXPECT_GE(low, p.lower) << profile.name;
      EXPECT_LE(high, p.upper) << profile.name;
      if (effect_->shapes()[i].logarithmic) {
        EXPECT_GT(low, 0.0) << profile.name;
      }
    }
  }
}

TEST_P(EffectContract, NamesRealEffectsItIsConfoundedWith) {
  const Description& d = effect_->description();
  for (const std::string& other : d.confounded_effects) {
    EXPECT_THAT(effect_names(), ::testing::Contains(other));
    EXPECT_NE(other, GetParam());
    EXPECT_THAT(d.confounded_with, ::testing::HasSubstr(other));
  }
}

TEST_P(EffectContract, LetsConventionsGiveWayBeforeWhatDataDetermine) {
  int least_conventional = 1000, most_measured = -1;
  for (const Parameter& p : effect_->parameters())
    if (p.by_convention)
      least_conventional = std::min(least_conventional, p.gauge);
    else
      most_measured = std::max(most_measured, p.gauge);
  EXPECT_LT(most_measured, least_conventional);
}

// To first order what an error of a body does to a face is what the columns say, Eq. (5).
TEST_P(EffectContract, ErrorsOfTheBodiesMakeTheColumnsOfAFace) {
  const Case profile = all_cases()[0];
  if (!effect_->applies_to(profile.setup)) return;
  const Stations stations(profile.positions, profile.setup, lathe());
  for (const std::vector<double>& shape : shapes_to_try(stations)) {
    const Eigen::MatrixXd columns = columns_at(stations, shape);
    const Eigen::VectorXd amplitudes =
        Eigen::VectorXd::LinSpaced(effect_->amplitudes(), 1e-4, 2e-4);
    for (Eigen::Index i = 0; i < stations.size(); ++i) {
      const Pose pose{stations.radius(i), profile.setup.z_mm, profile.setup.overhang_mm};
      std::vector<BodyErrors> errors(lathe().bodies().size());
      effect_->add_body_errors(pose, stations.slide(i), amplitudes, errors);
      const double height = lathe().volumetric_error_first_order(pose, errors).z();
      const bool silent = height == 0.0 && !effect_->is_carriage();
      if (silent) continue;
      EXPECT_NEAR(height, columns.row(i).dot(amplitudes), 1e-15) << i;
    }
  }
}

TEST_P(EffectContract, CarriagesAdviseOnADirectionOfTheirOwn) {
  if (!effect_->is_carriage()) return;
  UndeterminedPart part{.others = {}, .model_has_others = true};
  for (const Parameter& p : effect_->parameters()) part.own.push_back(p.name);
  EXPECT_NE(effect_->advice(part), "");
}

TEST_P(EffectContract, HypothesesOfASearchCanBeMade) {
  const TravelRange range{.slide_max = 600.0, .beam_span_mm = 700.0};
  const std::vector<EffectOptions> missing = effect_->hypotheses(nullptr);
  EXPECT_FALSE(missing.empty());
  for (const EffectOptions& options : missing)
    EXPECT_GT(make_effect(GetParam(), options, lathe(), range)->amplitudes(), 0);
}

// Of a declared effect a search tries parameters that it does not have.
TEST_P(EffectContract, HypothesesOfADeclaredEffectAddParameters) {
  EffectOptions declared;
  if (effect_->amplitudes() > 1 && effect_->is_carriage()) declared.degree = 3;
  const auto names = [&](const EffectOptions& options) {
    std::set<std::string> out;
    const auto effect = make_effect(GetParam(), options, lathe(), kTravel);
    for (const Parameter& p : effect->parameters()) out.insert(p.name);
    return out;
  };
  for (const EffectOptions& options : effect_->hypotheses(&declared)) {
    std::set<std::string> more = names(options);
    for (const std::string& name : names(declared)) {
      EXPECT_EQ(more.erase(name), options.above ? 0U : 1U) << name;
    }
    EXPECT_FALSE(more.empty());
  }
}

TEST_P(EffectContract, NeedsOfTheMachineWhatItSays) {
  EXPECT_THAT(effect_->lacking_of_machine({.beam_span_mm = 700.0}), ::testing::IsEmpty());
  const EffectOptions options = effect_->hypotheses(nullptr).front();
  if (effect_->lacking_of_machine({}).empty())
    EXPECT_NO_THROW((void)make_effect(GetParam(), options, lathe(), {}));
  else
    EXPECT_THROW((void)make_effect(GetParam(), options, lathe(), {}), UsageError);
}

TEST_P(EffectContract, IsSteepestAtTheCentreWhereItSaysSo) {
  if (!effect_->description().steep_at_centre) return;
  const Case profile = all_cases()[0];
  const Stations stations(profile.positions, profile.setup, lathe());
  const Eigen::MatrixXd z = columns_at(stations, shapes_to_try(stations).front());
  const Eigen::VectorXd change = (z.bottomRows(z.rows() - 1) - z.topRows(z.rows() - 1)).cwiseAbs();
  Eigen::Index steepest = -1;
  change.maxCoeff(&steepest);
  EXPECT_LE(steepest, 1);
}

// The same in the library, for effects of a user's own.
TEST_P(EffectContract, IsKeptAsTheProgramChecksIt) {
  EXPECT_THAT(contract_faults(*effect_), ::testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EffectContract, ::testing::ValuesIn(effect_names()),
                         [](const auto& entry) { return entry.param; });

}  // namespace
}  // namespace slideway::contract_test
