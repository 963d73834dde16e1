#include "slideway/effects/channel.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "../linear_effect.hpp"
#include "../variable_range.hpp"
#include "measured_log.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr double kLongestLag = 0.25;  // of the log
constexpr double kEarliest = 0.05;    // of it: where its clock is wrong
constexpr double kFastest = 0.1;      // of the spacing of the log: at once
constexpr double kSlowest = 2.0;      // times the log: a first-order lag that integrates
constexpr double kWidestGap = 0.2;    // of a profile's stretch on the clock
constexpr double kEven = 1.5;         // mean spacings: what is wider is a gap
constexpr double kOfTheEnds = 1e-9;   // rounding of where a log and a profile begin

/// Mean slope of a function over steps; of two that touch, their common end is asked once.
template <typename Function>
class MeanSlope {
 public:
  explicit MeanSlope(Function function) : function_(std::move(function)) {}

  /// Over [t - width/2, t + width/2].
  double operator()(double t, double width) {
    const End low = at(t - width / 2.0, width), high = at(t + width / 2.0, width);
    low_ = low, high_ = high;
    return (high.value - low.value) / width;
  }

 private:
  struct End {
    double place = NAN, value = 0.0;
  };

  End at(double place, double width) const {
    constexpr double kSame = 1e-9;  // of a step
    for (const End& known : {low_, high_})
      if (std::abs(known.place - place) <= kSame * width) return known;
    return {place, function_(place)};
  }

  Function function_;
  End low_, high_;
};

/// A quantity that is straight between its places, constant beyond them, after a first-order lag,
/// and its integral.
class Response {
 public:
  /// @param tau  0: no lag
  Response(const Channel& channel, double tau) : tau_(tau) {
    const std::vector<double>&t = channel.at, &q = channel.values;
    pieces_.reserve(t.size());
    for (std::size_t i = 0; i < t.size(); ++i) {
      Piece piece{.at = t[i], .value = q[i], .lagged = q[i]};
      if (i + 1 < t.size()) piece.slope = (q[i + 1] - q[i]) / (t[i + 1] - t[i]);
      if (i > 0) {
        const Piece& last = pieces_.back();
        piece.area = last.area + 0.5 * (q[i] + q[i - 1]) * (t[i] - t[i - 1]);
        piece.tau_slope = tau_slope_at(last, t[i]);
        piece.lagged = lagged_at(last, t[i]);
      }
      pieces_.push_back(piece);
    }
  }

  [[nodiscard]] double value(double t) const {
    if (t <= pieces_.front().at) return pieces_.front().value;
    return lagged_at(before(t), t);
  }

  /// Means over steps of this width about each of some places; of none, the value.
  [[nodiscard]] auto means(double width) const {
    return [this, width, mean = MeanSlope([this](double t) { return integral(t); })](
               double t) mutable { return width > 0.0 ? mean(t, width) : value(t); };
  }

  /// Of the value in time; right of a place where there is no lag.
  [[nodiscard]] double rate(double t) const {
    if (t < pieces_.front().at) return 0.0;
    const Piece& p = before(t);
    if (tau_ <= 0.0) return p.slope;
    return (p.value + p.slope * (t - p.at) - lagged_at(p, t)) / tau_;
  }
  [[nodiscard]] auto mean_rates(double width) const {
    return [this, width, mean = MeanSlope([this](double t) { return value(t); })](
               double t) mutable { return width > 0.0 ? mean(t, width) : rate(t); };
  }

  /// Of the value by τ.
  [[nodiscard]] double tau_slope(double t) const {
    return t <= pieces_.front().at ? 0.0 : tau_slope_at(before(t), t);
  }
  [[nodiscard]] auto mean_tau_slopes(double width) const {
    return [this, width, mean = MeanSlope([this](double t) { return integral_tau_slope(t); })](
               double t) mutable { return width > 0.0 ? mean(t, width) : tau_slope(t); };
  }

 private:
  /// From one place to the next; what is of the response is at the place.
  struct Piece {
    double at = 0.0, value = 0.0, slope = 0.0;         // of the quantity
    double area = 0.0, lagged = 0.0, tau_slope = 0.0;  // ∫ q, y, dy/dτ
  };

  [[nodiscard]] const Piece& before(double t) const {
    const auto after = std::ranges::upper_bound(pieces_, t, {}, &Piece::at);
    return after == pieces_.begin() ? *after : *std::prev(after);
  }

  /// y from y_i on, where τ y' = q - y and q = q_i + c u: y = y_i + c (u + τ d) + (y_i - q_i) d,
  /// d = exp(-u/τ) - 1.
  [[nodiscard]] double lagged_at(const Piece& p, double t) const {
    const double u = t - p.at;
    if (tau_ <= 0.0) return p.value + p.slope * u;
    const double decay = std::expm1(-u / tau_);
    return p.lagged + p.slope * (u + tau_ * decay) + (p.lagged - p.value) * decay;
  }

  /// Derivative of lagged_at() by τ; that of d is d' = u/τ² exp(-u/τ).
  [[nodiscard]] double tau_slope_at(const Piece& p, double t) const {
    if (tau_ <= 0.0) return 0.0;
    const double u = t - p.at, decay = std::expm1(-u / tau_);
    const double growth = u / (tau_ * tau_) * (1.0 + decay);
    return p.tau_slope * (1.0 + decay) + p.slope * (decay + tau_ * growth) +
           (p.lagged - p.value) * growth;
  }

  [[nodiscard]] double integral_tau_slope(double t) const {
    if (t <= pieces_.front().at) return 0.0;
    const Piece& p = before(t);
    return pieces_.front().value - lagged_at(p, t) - tau_ * tau_slope_at(p, t);
  }

  /// ∫ y = ∫ q - τ (y - y_0), as τ y' = q - y.
  [[nodiscard]] double integral(double t) const {
    const double first = pieces_.front().at, start = pieces_.front().value;
    if (t <= first) return start * (t - first);
    const Piece& p = before(t);
    const double u = t - p.at;
    const double area = p.area + u * (p.value + 0.5 * p.slope * u);
    return area - tau_ * (lagged_at(p, t) - start);
  }

  double tau_;
  std::vector<Piece> pieces_;
};

std::string unit_of_clock(const Channel& channel) {
  return channel.clock == IndependentVariable::slide ? "mm" : "s";
}

/// A cause logged while the profile was read changes what is read, be it a height or a slope.
bool acts_on_the_reading(const Channel& channel) {
  return channel.clock == IndependentVariable::reading_time;
}

Description describe(const Channel& channel, const ChannelResponse& response) {
  const std::string name = channel.name, t(symbol(channel.clock));
  const std::string lag = response.free_lag || response.lag_s != 0.0 ? " - lag" : "";
  std::string formula = "a q(" + t + lag + "), q the measured " + name;
  if (response.free_tau || response.tau_s) formula += " after a first-order lag τ";
  if (response.since_start) formula += ", from the start of the cut";
  return {.name = response.name,
          .plain_name = in_words(response.name),
          .standard_name = "a measured cause",
          .formula = formula,
          .source = "the log " + name,
          .cause = name + " as it was logged",
          .typical = "what the log and the size of the effect say",
          .variable = channel.clock,
          .measured = true,
          .axisymmetric = channel.clock == IndependentVariable::time};
}

std::vector<Parameter> parameters_of(const Channel& channel, const ChannelResponse& response) {
  const double length = channel.at.back() - channel.at.front();
  const std::string slope =
      acts_on_the_reading(channel) ? ", slope: µrad/(" + channel.unit + ")" : "";
  std::vector<Parameter> out{{"a", "a", "µm/(" + channel.unit + ")" + slope, 0.1}};
  if (response.free_lag)
    out.push_back({"lag_s", "lag", unit_of_clock(channel), length / 100.0, -kEarliest * length,
                   kLongestLag * length});
  if (response.free_tau)
    out.push_back({"tau_s", "τ", unit_of_clock(channel), length / 10.0,
                   kFastest * length / static_cast<double>(channel.at.size()), kSlowest * length});
  return out;
}

std::vector<Shape> shapes_of(const ChannelResponse& response) {
  std::vector<Shape> out;
  if (response.free_lag) out.push_back({.parameter = 1});
  if (response.free_tau)
    out.push_back({.parameter = response.free_lag ? 2 : 1, .logarithmic = true, .may_begin = true});
  return out;
}

class ChannelEffect : public LinearEffect {
 public:
  /// @param log       as it was read
  /// @param quantity  what it says of the quantity, or a draw of the error of that
  /// @param measured  where draws come from
  ChannelEffect(std::shared_ptr<const Channel> log, std::shared_ptr<const Channel> quantity,
                std::shared_ptr<const MeasuredLog> measured, const ChannelResponse& response)
      : LinearEffect(describe(*log, response), parameters_of(*log, response),
                     diagonal_map(1, kMicrometre), shapes_of(response)),
        channel_(std::move(log)),
        quantity_(std::move(quantity)),
        measured_(std::move(measured)),
        response_(response) {}

  [[nodiscard]] bool applies_to(const Setup& setup) const override {
    return is_height(setup) || acts_on_the_reading(*channel_);
  }
  [[nodiscard]] std::vector<std::string> lacking(const Setup& setup) const override;
  void columns(const Stations& stations, std::span<const double> shape,
               Eigen::Ref<Eigen::MatrixXd> out) const override;
  void derivatives(const Stations& stations, std::span<const double> shape,
                   Eigen::Ref<Eigen::MatrixXd> out) const override;
  [[nodiscard]] Departures departures() const override;
  [[nodiscard]] double resolution(int shape, double value,
                                  const Stations& stations) const override {
    const double coarser = shapes().size() > 1 ? 2.0 : 1.0;  // a grid of two is finer between
    return coarser * LinearEffect::resolution(shape, value, stations);
  }

 private:
  [[nodiscard]] VariableReading reading() const {
    switch (channel_->clock) {
      case IndependentVariable::slide:
        return slide_of;
      case IndependentVariable::measuring_time:
        return measuring_time_of;
      case IndependentVariable::reading_time:
        return reading_time_of;
      default:
        return time_of;
    }
  }
  /// Where a response is counted from.
  [[nodiscard]] double start_of(const Stations& stations) const {
    const Setup& setup = stations.setup();
    return acts_on_the_reading(*channel_) ? std::ranges::min(setup.reading_times->times_s)
                                          : setup.start_s;
  }
  static double unit_of(const Stations& stations) {
    return is_height(stations.setup()) ? 1.0 : kMicroradian / kMicrometre;
  }
  [[nodiscard]] double lag(std::span<const double> shape) const {
    return response_.free_lag ? shape[0] : response_.lag_s;
  }
  [[nodiscard]] double tau(std::span<const double> shape) const {
    return response_.free_tau ? shape.back() : response_.tau_s.value_or(0.0);
  }

  std::shared_ptr<const Channel> channel_, quantity_;
  std::shared_ptr<const MeasuredLog> measured_;
  ChannelResponse response_;
};

std::vector<std::string> ChannelEffect::lacking(const Setup& setup) const {
  std::vector<std::string> keys = Effect::lacking(setup);
  if (!keys.empty()) return keys;
  if (std::ranges::min(quantity_->values) == std::ranges::max(quantity_->values))
    return {"a log " + channel_->name + " that changes"};
  std::vector<double> ends{setup.first_mm, setup.last_mm};
  if (setup.kind == Kind::face && setup.first_mm < setup.center_mm &&
      setup.center_mm < setup.last_mm)
    ends.push_back(setup.center_mm);
  if (acts_on_the_reading(*channel_)) ends = setup.reading_times->positions_mm;
  const Machine machine(Machine::paper_lathe(), Lever::paper);
  const VariableRange range = range_of(readings({ends, setup, machine}, reading()));
  const std::vector<double>& at = channel_->at;
  const double spacing = (at.back() - at.front()) / static_cast<double>(at.size() - 1);
  const double earliest = range.low - response_.lag_s;
  const double beyond =
      std::min(spacing, kWidestGap * range.extent()) +
      kOfTheEnds * range.extent();  // as far as it is from one reading to the next
  const std::string where = " from " + significant(earliest, 5) + " to " +
                            significant(range.high, 5) + " " + unit_of_clock(*channel_);
  if (earliest < at.front() - beyond || range.high > at.back() + beyond)
    return {std::string(kLogLacks) + channel_->name + where + " (it has " +
            significant(at.front(), 5) + " to " + significant(at.back(), 5) + ")"};
  for (std::size_t i = 1; i < at.size(); ++i) {
    const double gap = std::min(at[i], range.high) - std::max(at[i - 1], range.low);
    if (gap <= kWidestGap * range.extent()) continue;
    const std::string unit = " " + unit_of_clock(*channel_);
    if (at[i] - at[i - 1] < kEven * spacing)
      return {std::string(kLogLacks) + channel_->name + where + " at least every " +
              significant(kWidestGap * range.extent(), 2) + unit + " (it has every " +
              significant(spacing, 2) + unit + ")"};
    return {std::string(kLogLacks) + channel_->name + where + " without the gap at " +
            significant(at[i - 1], 5) + unit};
  }
  return {};
}

void ChannelEffect::columns(const Stations& stations, std::span<const double> shape,
                            Eigen::Ref<Eigen::MatrixXd> out) const {
  if (!applies_to(stations.setup())) return void(out.setZero());
  const Response response(*quantity_, tau(shape));
  const Eigen::VectorXd clock = readings(stations, reading());
  const double width = range_of(clock).step, later = lag(shape);
  const double start = response_.since_start ? response.value(start_of(stations) - later) : 0.0;
  const double unit = unit_of(stations);
  auto mean = response.means(width);
  for (Eigen::Index i = 0; i < stations.size(); ++i)
    out(i, 0) = unit * (mean(clock[i] - later) - start);
}

void ChannelEffect::derivatives(const Stations& stations, std::span<const double> shape,
                                Eigen::Ref<Eigen::MatrixXd> out) const {
  if (shape.empty() || !applies_to(stations.setup())) return void(out.setZero());
  const Response response(*quantity_, tau(shape));
  const Eigen::VectorXd clock = readings(stations, reading());
  const double width = range_of(clock).step, later = lag(shape);
  const double begin = start_of(stations) - later, unit = unit_of(stations);
  const bool from_start = response_.since_start;
  const Eigen::Index by_tau = out.cols() - 1;  // that by the lag is the first
  const double start_rate = from_start && response_.free_lag ? response.rate(begin) : 0.0;
  const double start_slope = from_start && response_.free_tau ? response.tau_slope(begin) : 0.0;
  auto mean_rate = response.mean_rates(width);
  auto mean_tau_slope = response.mean_tau_slopes(width);
  for (Eigen::Index i = 0; i < stations.size(); ++i) {
    const double at = clock[i] - later;
    if (response_.free_lag) out(i, 0) = -unit * (mean_rate(at) - start_rate);
    if (response_.free_tau) out(i, by_tau) = unit * (mean_tau_slope(at) - start_slope);
  }
}

Departures ChannelEffect::departures() const {
  Departures out;
  for (const Channel& error : measured_->errors())
    out.parts.push_back(std::make_unique<ChannelEffect>(
        channel_, std::shared_ptr<const Channel>(measured_, &error), measured_, response_));
  return out;
}

}  // namespace

EffectFactory channel_effect(Channel channel, const ChannelResponse& response) {
  return channel_effects(std::move(channel), {response}).front();
}

std::vector<EffectFactory> channel_effects(Channel channel,
                                           const std::vector<ChannelResponse>& responses) {
  if (channel.at.size() < 3 || channel.at.size() != channel.values.size())
    throw UsageError("channel '" + channel.name + "' has fewer than three values");
  if (std::ranges::adjacent_find(channel.at, std::ranges::greater_equal()) != channel.at.end())
    throw UsageError("channel '" + channel.name + "' does not increase on its clock");
  constexpr double kMost = 1e30;  // whose slopes and integrals are finite
  const auto is_possible = [](double number) { return std::abs(number) < kMost; };
  const auto is_close = [](double a, double b) { return b - a < 1.0 / kMost; };
  if (!std::ranges::all_of(channel.at, is_possible) ||
      !std::ranges::all_of(channel.values, is_possible))
    throw UsageError("channel '" + channel.name + "' has numbers beyond 1e30");
  if (std::ranges::adjacent_find(channel.at, is_close) != channel.at.end())
    throw UsageError("channel '" + channel.name + "' has places closer than 1e-30 to each other");
  if (std::ranges::any_of(responses, [&](const ChannelResponse& each) {
        return !is_possible(each.lag_s) || !is_possible(each.tau_s.value_or(0.0));
      }))
    throw UsageError("a lag_s or tau_s beyond 1e30");
  auto log = std::make_shared<const Channel>(std::move(channel));
  auto measured = std::make_shared<const MeasuredLog>(*log);
  const std::shared_ptr<const Channel> quantity(measured, &measured->quantity());
  std::vector<EffectFactory> out;
  for (const ChannelResponse& response : responses)
    out.emplace_back([=](const Machine&, const TravelRange&) {
      return std::make_unique<ChannelEffect>(log, quantity, measured, response);
    });
  return out;
}

}  // namespace slideway
