// A logged quantity as an effect. Logs are closed forms; what a response makes of them is known.
#include "slideway/effects/channel.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <functional>

#include "effects/effect_cases.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/random.hpp"
#include "slideway/effects/contract.hpp"

namespace slideway::channel_test {
namespace {

using namespace testing_support;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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
  EXPECT_THAT(lacking(log_of(flat)), IsEmpty());
  EXPECT_THAT(lacking(log_of(flat, 200.0)),
              ElementsAre("the log spindle_temperature from 0 to 300 s (it has 0 to 200)"));
  Channel gap = log_of(flat);
  gap.at.erase(gap.at.begin() + 200, gap.at.begin() + 400);
  gap.values.resize(gap.at.size());
  EXPECT_THAT(lacking(gap), ElementsAre(HasSubstr("without the gap at 99.5")));
  slideway::Setup bare = setup;
  bare.feed_mm_per_min.reset();
  EXPECT_THAT(channel_effect(log_of(flat), {.name = "T"})(lathe(), kTravel)->lacking(bare),
              ElementsAre("feed_mm_per_min"));
}

// 4000 normal deviates: the median of |second differences| has 1.6 % of scatter, correlation of
// neighbours included.
TEST(ChannelEffect, KnowsTheNoiseOfALogThatMoves) {
  RandomStream random(3, "log");
  const Channel noisy = log_of(
      [&](double t) { return 20.0 + 3.0 * (1.0 - std::exp(-t / 50.0)) + 0.05 * random.normal(); },
      2000.0);
  EXPECT_NEAR(noise_of(noisy), 0.05, 0.05 * 0.07);
}

// 11.5 values a station: white noise of 2 has a variance of 4/11.5 in their means, whatever the log
// does beside. The median of its second differences has 5 % of scatter at 600 values, twice that in
// a variance; of ten draws the sum of squares has 6 %. Three times both together are allowed.
TEST(ChannelEffect, KnowsTheNoiseInItsColumns) {
  constexpr int kDraws = 10;
  const Case face = all_cases()[0];
  const Stations stations(face.positions, face.setup, lathe());
  RandomStream random(3, "log");
  for (const double signal : {0.0, 1000.0}) {
    const Channel log =
        log_of([&](double t) { return signal * t / 300.0 + 2.0 * random.normal(); });
    const auto effect = channel_effect(log, {.name = "T"})(lathe(), kTravel);
    double squares = 0.0;
    for (int d = 0; d < kDraws; ++d) {
      Eigen::MatrixXd column(stations.size(), 1);
      effect->noise_of_cause(static_cast<std::uint64_t>(d))->columns(stations, {}, column);
      squares += column.squaredNorm();
    }
    const double count = static_cast<double>(kDraws * stations.size());
    EXPECT_NEAR(squares / count, 4.0 / 11.5, 0.35 * 4.0 / 11.5);
  }
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
