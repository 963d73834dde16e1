// A logged quantity as an effect. Logs are closed forms; what a response makes of them is known.
#include "slideway/effects/channel.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <functional>

#include "effects/effect_cases.hpp"
#include "own/local_trend.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/random.hpp"
#include "slideway/effects/contract.hpp"

namespace slideway::channel_test {
namespace {

using namespace testing_support;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Lt;

Channel log_of(const std::function<double(double)>& q, double last = 300.0, double step = 0.5) {
  Channel out{.name = "spindle_temperature", .unit = "degC"};
  for (int i = 0; step * i <= last; ++i) {
    out.at.push_back(step * i);
    out.values.push_back(q(step * i));
  }
  return out;
}

Eigen::VectorXd column(const Channel& channel, const ChannelResponse& response, const Case& profile,
                       std::span<const double> shape = {}) {
  const auto effect = channel_effect(channel, response)(lathe(), kTravel);
  return columns(*effect, profile, shape).col(0);
}

// Inward at 2 mm/min from 10 mm.
double time_at(const Case& face, Eigen::Index i) {
  return (10.0 - face.positions[static_cast<std::size_t>(i)]) * 30.0;
}

TEST(ChannelEffect, IsTheLogAtTheTimeOfTheCutLessTheLag) {
  const Case face = all_cases()[0];
  const Channel ramp = log_of([](double t) { return 20.0 + 0.01 * t; });
  const Eigen::VectorXd now = column(ramp, {.name = "T"}, face);
  const Eigen::VectorXd later = column(ramp, {.name = "T", .lag_s = 12.0}, face);
  for (Eigen::Index i = 3; i + 3 < now.size(); ++i) {
    // A mean over the spacing of the stations is the middle of a straight line.
    EXPECT_NEAR(now[i], 20.0 + 0.01 * time_at(face, i), 1e-11);
    if (time_at(face, i) > 15.0) {
      EXPECT_NEAR(later[i], 20.0 + 0.01 * (time_at(face, i) - 12.0), 1e-11);
    }
  }
}

// τ y' = q - y, y(0) = q(0), q = c t: y = c (t - τ + τ exp(-t/τ)). Its mean over a station's
// spacing h is y + y'' h²/24 and less.
TEST(ChannelEffect, FollowsARampWithAFirstOrderLag) {
  Case face = all_cases()[0];
  face.positions = spaced(0.0, 10.0, 1001);
  const Channel ramp = log_of([](double t) { return 0.01 * t; });
  const double tau = 40.0;
  const Eigen::VectorXd y = column(ramp, {.name = "T", .tau_s = tau}, face);
  const Eigen::VectorXd free = column(ramp, {.name = "T", .free_tau = true}, face, std::array{tau});
  for (Eigen::Index i = 2; i + 2 < y.size(); ++i) {
    const double t = time_at(face, i);
    EXPECT_NEAR(y[i], 0.01 * (t - tau + tau * std::exp(-t / tau)), 1e-6);
  }
  EXPECT_EQ(y, free);
}

// Stations 5.77 s apart, a disturbance every 0.8 s: sampled it would come back as a slow wave of
// its full size; its mean is 1/(π 7.2) of it at most.
TEST(ChannelEffect, LetsNothingThroughThatIsFasterThanTheStations) {
  const Case face = all_cases()[0];
  const Channel fast = log_of([](double t) { return std::cos(2.0 * kPi * t / 0.8); }, 300.0, 0.05);
  const Eigen::VectorXd y = column(fast, {.name = "T"}, face);
  EXPECT_LT(y.segment(1, y.size() - 2).cwiseAbs().maxCoeff(), 1.0 / (kPi * 7.2));
}

TEST(ChannelEffect, CanBeCountedFromTheStartOfTheCut) {
  Case face = all_cases()[0];
  face.setup.start_s = 100.0;
  const Channel ramp = log_of([](double t) { return 20.0 + 0.01 * t; }, 500.0);
  const Eigen::VectorXd y = column(ramp, {.name = "T", .since_start = true}, face);
  EXPECT_NEAR(y[26], 0.01 * time_at(face, 26), 1e-11);
}

// A level in a room that warms: stations read from the far end, slopes in µrad for each degree.
TEST(ChannelEffect, OnTheReadingTimeChangesASlopeToo) {
  Channel room = log_of([](double t) { return 20.0 + 0.01 * t; }, 1100.0);
  room.clock = IndependentVariable::reading_time;
  for (const Case& each : {all_cases()[3], all_cases()[5]}) {
    const double unit = each.setup.quantity == Quantity::height ? 1.0 : 1e-3;
    const Eigen::VectorXd y = column(room, {.name = "T"}, each);
    for (Eigen::Index i = 1; i + 1 < y.size(); ++i) {
      // The means reach over the spacing of the stations; the pace is uneven by 5 s in 50.
      const double t = each.setup.reading_times->at(each.positions[static_cast<std::size_t>(i)]);
      EXPECT_NEAR(y[i], unit * (20.0 + 0.01 * t), unit * 1e-9);
    }
  }
  room.at.resize(50);
  room.values.resize(50);
  EXPECT_THAT(channel_effect(room, {.name = "T"})(lathe(), kTravel)->lacking(all_cases()[3].setup),
              ElementsAre(HasSubstr("from 720 to 1000 s")));
}

TEST(ChannelEffect, TakesUnequalSpacing) {
  const Case face = all_cases()[0];
  Channel log{.name = "T", .at = {0.0, 7.0, 40.0, 41.5, 97.0, 200.0, 222.0, 300.0}};
  for (const double t : log.at) log.values.push_back(5.0 - 0.02 * t);
  const Eigen::VectorXd y = column(log, {.name = "T"}, face);
  for (Eigen::Index i = 1; i + 1 < y.size(); ++i)
    EXPECT_NEAR(y[i], 5.0 - 0.02 * time_at(face, i), 1e-11);
}

TEST(ChannelEffect, NeedsALogOfTheWholeCutWithoutAWideGap) {
  const slideway::Setup setup = all_cases()[0].setup;
  const auto lacking = [&](const Channel& channel) {
    return channel_effect(channel, {.name = "T"})(lathe(), kTravel)->lacking(setup);
  };
  const auto flat = [](double) { return 1.0; };
  const auto ramp = [](double t) { return t; };
  EXPECT_THAT(lacking(log_of(flat)), ElementsAre("a log spindle_temperature that changes"));
  EXPECT_THAT(lacking(log_of(ramp)), IsEmpty());
  EXPECT_THAT(lacking(log_of(ramp, 200.0)),
              ElementsAre("the log spindle_temperature from 0 to 300 s (it has 0 to 200)"));
  EXPECT_THAT(lacking(log_of(ramp, 295.0, 5.0)), IsEmpty());  // the next reading was at 300
  EXPECT_THAT(lacking(log_of(ramp, 290.0, 5.0)), ElementsAre(HasSubstr("it has 0 to 290")));
  EXPECT_THAT(lacking(log_of(ramp, 400.0, 80.0)),
              ElementsAre("the log spindle_temperature from 0 to 300 s at least every 60 s (it has "
                          "every 80 s)"));
  Channel gap = log_of(ramp);
  gap.at.erase(gap.at.begin() + 200, gap.at.begin() + 400);
  gap.values.resize(gap.at.size());
  EXPECT_THAT(lacking(gap), ElementsAre(HasSubstr("without the gap at 99.5")));
  slideway::Setup bare = setup;
  bare.feed_mm_per_min.reset();
  EXPECT_THAT(channel_effect(log_of(ramp), {.name = "T"})(lathe(), kTravel)->lacking(bare),
              ElementsAre("feed_mm_per_min"));
}

// The mean of a quantity whose slope is a random walk is the cubic smoothing spline with the
// penalty 1 / its variance (Wahba 1978). Values by scipy 1.10.1, make_smoothing_spline(t, y,
// lam=lam), to nine places; the diffuse start is one of 1e8 times the variance of a reading.
TEST(LocalTrend, IsTheSmoothingSpline) {
  const std::vector<double> t{0.0, 1.0, 2.5, 3.0, 4.5, 5.0, 6.0, 7.0, 9.0, 10.0, 12.0};
  const std::vector<double> y{1.0, 1.4, 0.9, 2.0, 2.2, NAN, 3.1, 2.7, 2.9, 3.5, 3.2};
  const std::array<std::size_t, 5> shown{0, 2, 5, 8, 10};
  const auto expect = [&](double penalty, const std::array<double, 5>& values) {
    const std::vector<double> found = LocalTrend{.slope = 1.0 / penalty}.smoothed(t, y);
    for (std::size_t k = 0; k < shown.size(); ++k)
      EXPECT_NEAR(found[shown[k]], values[k], 2e-7) << penalty << " at " << t[shown[k]];
  };
  expect(0.1, {1.049872042, 1.323089813, 2.571382912, 2.987817569, 3.226695603});
  expect(10.0, {0.958147478, 1.614160224, 2.360032065, 3.114225672, 3.362299681});
}

// A load that comes on at 200 s: 3 degC in the end, 0.02 degC/s at first, read with 0.03 degC every
// 2 s. Without a kink the trend is off by two standard deviations of a reading there (0.06 degC);
// what is left with one is to be less than one. A slope that is known from ten readings to either
// side has 0.005 degC/s: a log shows the kink to one reading in 19 of 20, and 18 of 20 logs or more
// do with a probability of 0.92.
TEST(LocalTrend, DoesNotSmoothAKink) {
  std::vector<double> at;
  for (double t = 0.0; t <= 600.0; t += 2.0) at.push_back(t);
  double error = 0.0;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed, "kink");
    std::vector<double> readings;
    for (const double t : at)
      readings.push_back(3.0 * (1.0 - std::exp(-std::max(t - 200.0, 0.0) / 150.0)) +
                         0.03 * random.normal());
    const LocalTrend trend = LocalTrend::of(at, readings);
    error += trend.smoothed(at, readings)[100] / 20.0;
    if (trend.kinks.size() == 1 && std::abs(trend.kinks[0].from - 199.0) <= 3.0) ++found;
  }
  EXPECT_LT(std::abs(error), 0.03);
  EXPECT_GE(found, 18);
}

Channel warming(RandomStream& random, double noise, double step = 2.0) {
  return log_of(
      [&](double t) {
        return 20.0 + 4.0 * (1.0 - std::exp(-t / 40.0)) + 3.0 * (1.0 - std::exp(-t / 250.0)) +
               noise * random.normal();
      },
      300.0, step);
}

// A log of 0.1 degC every 2 s is a mean of three values a station: 0.06 in the column, if nothing
// is smoothed. What is known of the error is its own size: of 30 logs with about ten independent
// parts each, the ratio of the squares has 8 % of scatter and the model of the walk its own; a
// factor of two is allowed.
TEST(ChannelEffect, IsFreeOfMostOfTheNoiseOfItsLogAndKnowsTheRest) {
  const Case face = all_cases()[0];
  const Stations stations(face.positions, face.setup, lathe());
  double squares = 0.0, drawn = 0.0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    RandomStream random(seed, "log");
    const auto effect = channel_effect(warming(random, 0.1), {.name = "T"})(lathe(), kTravel);
    const Eigen::VectorXd truth = column(warming(random, 0.0), {.name = "T"}, face);
    squares += (columns(*effect, face, {}).col(0) - truth).squaredNorm();
    for (const auto& part : effect->departures().parts)
      drawn += columns(*part, face, {}).squaredNorm();
  }
  const auto count = 30.0 * static_cast<double>(stations.size());
  EXPECT_LT(std::sqrt(squares / count), 0.06 / 1.5);
  EXPECT_THAT(squares / drawn, AllOf(Gt(0.5), Lt(2.0)));
}

// A valve that opens and closes at any moment between readings every 10 s. Of a jump of 1 whose
// moment is uniform over them, the mean over them has a standard deviation of 1/12^1/2, which 400
// of them tell to 4 %; its error is nowhere but between the two readings.
TEST(ChannelEffect, JumpsAtAnUnknownMomentBetweenTwoReadings) {
  Case face = all_cases()[0];
  face.positions = spaced(0.0, 10.0, 301);
  for (const double noise : {0.0, 0.02}) {
    double squares = 0.0, drawn = 0.0, means = 0.0, drawn_means = 0.0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      RandomStream random(seed, "valve");
      const double opens = 60.0 + 60.0 * random.uniform(), closes = 160.0 + 80.0 * random.uniform();
      const auto valve = [=](double t) { return t > opens && t < closes ? 1.0 : 0.0; };
      Channel log = log_of(valve, 300.0, 10.0);
      for (double& value : log.values) value += noise * random.normal();
      const auto effect = channel_effect(log, {.name = "T"})(lathe(), kTravel);
      const Eigen::VectorXd error = columns(*effect, face, {}).col(0) -
                                    column(log_of(valve, 300.0, 0.1), {.name = "T"}, face);
      const auto between = [&](const Eigen::VectorXd& values, double jump) {
        double sum = 0.0;
        for (Eigen::Index i = 0; i < values.size(); ++i)
          if (std::floor(time_at(face, i) / 10.0) == std::floor(jump / 10.0)) sum += values[i];
        return sum / 10.0;
      };
      for (Eigen::Index i = 2; i + 2 < error.size(); ++i) squares += error[i] * error[i];
      means += std::pow(between(error, opens), 2) + std::pow(between(error, closes), 2);
      for (const auto& part : effect->departures().parts) {
        const Eigen::VectorXd own = columns(*part, face, {}).col(0);
        drawn += own.squaredNorm();
        drawn_means += std::pow(between(own, opens), 2) + std::pow(between(own, closes), 2);
      }
    }
    EXPECT_NEAR(std::sqrt(means / 400.0), 1.0 / std::sqrt(12.0), 0.03);
    EXPECT_NEAR(drawn_means / means, 1.0, 0.15);
    EXPECT_THAT(squares / drawn, AllOf(Gt(0.8), Lt(1.25)));
  }
}

// A wave of 100 s read every 10 s: straight lines miss it by (2π/100)² 10²/8 = 5 % of its size, the
// cubic spline through it by 5/384 (2π/100)⁴ 10⁴ = 0.2 % (de Boor 2001, A practical guide to
// splines, chapter V).
TEST(ChannelEffect, IsNoPolygonWhereItsLogIsCoarse) {
  const Case face = all_cases()[0];
  const auto wave = [](double t) { return std::sin(2.0 * kPi * t / 100.0); };
  const Eigen::VectorXd y = column(log_of(wave, 300.0, 10.0), {.name = "T"}, face);
  const Eigen::VectorXd fine = column(log_of(wave, 300.0, 0.1), {.name = "T"}, face);
  for (Eigen::Index i = 3; i + 3 < y.size(); ++i)
    if (time_at(face, i) > 20.0 && time_at(face, i) < 280.0) EXPECT_NEAR(y[i], fine[i], 0.01);
}

// A sensor that tells 0.5 degC is wrong by up to 0.25 at every value; its runs of one value are
// right in their middles.
TEST(ChannelEffect, TakesARunOfOneValueAsOneReading) {
  const Case face = all_cases()[0];
  RandomStream random(1, "log");
  Channel coarse = warming(random, 0.0);
  for (double& value : coarse.values) value = std::round(2.0 * value) / 2.0;
  const Eigen::VectorXd y = column(coarse, {.name = "T"}, face);
  const Eigen::VectorXd truth = column(warming(random, 0.0), {.name = "T"}, face);
  double squares = 0.0;
  for (Eigen::Index i = 2; i + 2 < y.size(); ++i) squares += std::pow(y[i] - truth[i], 2);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(y.size())), 0.5 / std::sqrt(12.0) / 2.0);
}

TEST(OutliersOfALog, AreSinglePeaksAndCodesOfASensorThatWasNotRead) {
  RandomStream random(1, "log");
  Channel log = warming(random, 0.02);
  EXPECT_THAT(outliers_of(log), IsEmpty());
  log.values[50] += 3.0;
  EXPECT_THAT(outliers_of(log), ElementsAre(50));
  log.values[100] = log.values[101] = 999.0;
  EXPECT_THAT(outliers_of(log), ElementsAre(50, 100, 101));
}

// Power that is switched: every value belongs to it.
TEST(OutliersOfALog, AreNotWhatIsSwitched) {
  RandomStream random(1, "log");
  const Channel power = log_of(
      [&](double t) { return (std::fmod(t, 60.0) < 20.0 ? 2.0 : 0.0) + 0.02 * random.normal(); });
  EXPECT_THAT(outliers_of(power), IsEmpty());
  const Channel clean = log_of([&](double t) { return std::fmod(t, 60.0) < 20.0 ? 2.0 : 0.0; });
  EXPECT_THAT(outliers_of(clean), IsEmpty());
}

// One log in a thousand may have one by chance; of 1000 more than five have with 6e-4.
TEST(OutliersOfALog, AreRareByChance) {
  int with = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    RandomStream random(seed, "log");
    with += outliers_of(warming(random, 0.1)).empty() ? 0 : 1;
  }
  EXPECT_LE(with, 5);
}

TEST(ChannelEffect, KeepsTheContractOfTheCatalogue) {
  const Channel warm = log_of(
      [](double t) { return 20.0 + 2.0 * (1.0 - std::exp(-t / 60.0)) - std::exp(-t / 7000.0); },
      18000.0, 6.0);
  for (const ChannelResponse& response :
       {ChannelResponse{.name = "T"}, ChannelResponse{.name = "T", .free_tau = true},
        ChannelResponse{.name = "T", .free_lag = true, .free_tau = true}})
    EXPECT_THAT(contract_faults(*channel_effect(warm, response)(lathe(), kTravel)), IsEmpty());
}

TEST(ChannelEffect, RefusesWhatIsNoLog) {
  const auto made = [](std::vector<double> at, std::vector<double> values) {
    (void)channel_effect({.name = "T", .at = std::move(at), .values = std::move(values)}, {});
  };
  EXPECT_THROW(made({0.0, 1.0}, {1.0, 2.0}), UsageError);
  EXPECT_THROW(made({0.0, 2.0, 1.0}, {1.0, 2.0, 3.0}), UsageError);
  EXPECT_THROW(made({0.0, 1.0, 1e300}, {1.0, 2.0, 3.0}), UsageError);
  EXPECT_THROW(made({0.0, 1.0, 2.0}, {1.0, -1e300, 3.0}), UsageError);
  EXPECT_THROW(made({0.0, 1e-300, 1.0}, {1.0, 2.0, 3.0}), UsageError);
  const Channel ramp = log_of([](double t) { return t; });
  EXPECT_THROW((void)channel_effect(ramp, {.name = "T", .lag_s = 1e300}), UsageError);
  EXPECT_THROW((void)channel_effect(ramp, {.name = "T", .tau_s = 1e300}), UsageError);
}

}  // namespace
}  // namespace slideway::channel_test
