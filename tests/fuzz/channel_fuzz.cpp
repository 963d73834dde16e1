#include "slideway/effects/channel.hpp"
#include "torture/drawn_problem.hpp"

namespace slideway {
namespace {

constexpr std::array<double, 12> kNumbers{0.0, 1.0,  -1.0, 10.0,  100.0, 1e4,
                                          1e9, -1e9, 1e18, 1e300, 1e-9,  1e-300};

Channel drawn_channel(Draw& draw) {
  Channel channel{.name = "log"};
  channel.clock = draw.one_of(std::array{IndependentVariable::time, IndependentVariable::slide,
                                         IndependentVariable::measuring_time,
                                         IndependentVariable::reading_time});
  double at = draw.one_of(kNumbers);
  for (std::size_t left = draw.below(40); left > 0; --left) {
    channel.at.push_back(at);
    channel.values.push_back(draw.one_of(kNumbers) * draw.between(-1.0, 1.0));
    at += draw.once_in(12) ? draw.one_of(kNumbers) : draw.between(0.0, 50.0);
  }
  return channel;
}

ChannelResponse drawn_response(Draw& draw) {
  ChannelResponse response{.name = "log"};
  response.free_lag = draw.once_in(3);
  response.lag_s = draw.one_of(kNumbers);
  response.free_tau = draw.once_in(3);
  if (draw.once_in(2)) response.tau_s = std::abs(draw.one_of(kNumbers));
  response.since_start = draw.once_in(2);
  return response;
}

Setup drawn_setup(Draw& draw, const std::vector<double>& positions) {
  Setup setup;
  setup.kind = draw.once_in(2) ? Kind::slide : Kind::face;
  setup.feed_mm_per_min = draw.between(0.1, 100.0);
  setup.cut_direction = CutDirection::inward;
  setup.traverse_mm_per_s = 0.5;
  setup.first_mm = positions.front();
  setup.last_mm = positions.back();
  setup.cut_radius_mm = positions.back();
  return setup;
}

void require_finite_columns(const Effect& effect, Draw& draw) {
  std::vector<double> positions;
  for (int i = 0; i < 30; ++i) positions.push_back(i * 2.0);
  const Machine machine(Machine::paper_lathe(), Lever::paper);
  const Setup setup = drawn_setup(draw, positions);
  const Stations stations(positions, setup, machine);
  if (!effect.applies_to(stations.setup()) || !effect.lacking(stations.setup()).empty()) return;
  std::vector<double> shape;
  for (std::size_t i = 0; i < effect.shapes().size(); ++i) {
    const auto [low, high] = effect.search_range(static_cast<int>(i), stations);
    shape.push_back(draw.between(low, high));
    require(std::isfinite(shape.back()), "a range without ends");
  }
  Eigen::MatrixXd columns(30, effect.amplitudes());
  effect.columns(stations, shape, columns);
  require(columns.allFinite(), "a column that is not finite");
}

}  // namespace
}  // namespace slideway

// A log as a cause: refused, or its columns are finite.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  Draw draw({data, size});
  ends_well([&] {
    const Channel channel = drawn_channel(draw);
    const auto effect = channel_effect(channel, drawn_response(draw))(
        Machine(Machine::paper_lathe(), Lever::paper), {});
    require_finite_columns(*effect, draw);
  });
  return 0;
}
