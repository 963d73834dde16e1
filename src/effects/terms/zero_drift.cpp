#include <algorithm>
#include <cmath>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

Description describe_zero_drift() {
  return {.name = "zero_drift",
          .plain_name = "drift of the instrument's zero",
          .standard_name = "drift of the instrument's zero (VIM 4.21, instrumental drift)",
          .formula = "±a t_read, - where the reading is reversed",
          .source = "VIM 4.21; ISO 230-1, repeated and reversed readings",
          .cause =
              "the level, the autocollimator or the gauge warms, its stand creeps, its "
              "electronics settle while station after station is read",
          .typical = "0.01 to 1 µrad/min (levels, autocollimators), 1 to 50 nm/min (gauges)",
          .variable = IndependentVariable::reading_time,
          .confounded_with =
              "read at an even pace in one direction: the tilt of a height, b_2 of "
              "straightness of a slope (both exactly)",
          .confounded_effects = {"straightness"},
          .separated_by =
              "reading there and back: the form repeats, the drift goes on; reading "
              "the first station again at the end",
          .of_instrument = true};
}

enum class Law { steady, bend };

class ZeroDrift : public LinearEffect {
 public:
  ZeroDrift(double start_s, double end_s, Law law)
      : LinearEffect(describe_zero_drift(),
                     {{"rate_per_min", "a", "µm/min, slope: µrad/min", 0.01}},
                     diagonal_map(1, 1.0)),
        start_s_(start_s),
        end_s_(end_s),
        law_(law) {}

  [[nodiscard]] bool applies_to(const Setup& /*setup*/) const override { return true; }

  void columns(const Stations& stations, std::span<const double> /*shape*/,
               Eigen::Ref<Eigen::MatrixXd> out) const override {
    const Setup& setup = stations.setup();
    const double unit =
        sign_of_instrument(setup) * (is_height(setup) ? kMicrometre : kMicroradian) / kMinute;
    for (Eigen::Index i = 0; i < stations.size(); ++i)
      out(i, 0) = unit * since_start(stations.reading_time(i));
  }

  /// A parabola over the session that is in its middle what the drift makes in all.
  [[nodiscard]] Departures departures() const override {
    Departures out{.of_law = true};
    out.parts.push_back(std::make_unique<ZeroDrift>(start_s_, end_s_, Law::bend));
    return out;
  }

 private:
  [[nodiscard]] double since_start(double time_s) const {
    const double passed = time_s - start_s_, session = end_s_ - start_s_;
    if (law_ == Law::steady) return passed;
    return session > 0.0 ? 4.0 * passed * (session - passed) / session : 0.0;
  }

  double start_s_, end_s_;
  Law law_;
};

}  // namespace

std::unique_ptr<Effect> make_zero_drift(const Request& request) {
  request.accept_only({});
  const std::vector<std::string>& profiles = request.options.profiles;
  double start_s = INFINITY, end_s = -INFINITY;
  for (const ReadingWindow& each : request.range.read) {
    if (!profiles.empty() && std::ranges::count(profiles, each.profile) == 0) continue;
    start_s = std::min(start_s, each.from_s);
    end_s = std::max(end_s, each.to_s);
  }
  if (!(start_s <= end_s)) start_s = end_s = 0.0;
  return std::make_unique<ZeroDrift>(start_s, end_s, Law::steady);
}

}  // namespace slideway
