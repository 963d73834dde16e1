#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "formula_parts.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr double kPole = 1e6;                 // times what it is at the next station
constexpr int kHalvings = 64;                 // of the gap in which a pole is looked for
constexpr Eigen::Index kMostStations = 2048;  // at shapes other than the middle
constexpr int kUntilAPoleShows = 8;           // halvings, in which it is larger by 1.5^8 = 26
constexpr double kGrowth = 2.0;               // what is no pole grows by less
constexpr double kOverflow = 1e100;           // beside what is larger than any number
constexpr int kShapesOnAxis = 17;
constexpr std::size_t kMostCornered = 6;  // shapes of which all corners are tried
constexpr std::size_t kSharpest = 4;      // stations beside which a pole is looked for
constexpr int kDigits = 6;

using Values = std::vector<double>;

/// A formula along a line between two sets of values.
class Along {
 public:
  explicit Along(Expression::Evaluation& evaluation) : evaluation_(&evaluation) {}

  double operator()(const Values& values) { return std::abs(signed_at(values)); }

  /// What is farthest from zero, or from a straight line between the two: a small pole on a slope.
  enum class From { zero, chord };

  /// Where it is so between two places, of one hump, by thirds.
  Values farthest(From from, const Values& first, const Values& last) {
    const bool is_chord = from == From::chord;
    const double at_first = is_chord ? signed_at(first) : 0.0,
                 rise = is_chord ? signed_at(last) - at_first : 0.0;
    const auto mix = [&](double share) {
      Values out = first;
      for (std::size_t i = 0; i < out.size(); ++i) out[i] += share * (last[i] - first[i]);
      return out;
    };
    const auto off = [&](double value, double share) {
      return std::abs(value - at_first - share * rise);
    };
    double low = 0.0, high = 1.0, begun = 0.0;
    for (int i = 0; i < kHalvings; ++i) {
      const double left = low + (high - low) / 3.0, right = high - (high - low) / 3.0;
      const double of_left = signed_at(mix(left)), of_right = signed_at(mix(right));
      if (!std::isfinite(of_left)) return mix(left);
      if (!std::isfinite(of_right)) return mix(right);
      const double off_left = off(of_left, left), off_right = off(of_right, right);
      (off_left < off_right ? low : high) = off_left < off_right ? left : right;
      const double most = std::max(off_left, off_right);
      if (i == 0) begun = most;
      if (i == kUntilAPoleShows && most < kGrowth * begun) break;
    }
    return mix(0.5 * (low + high));
  }

 private:
  double signed_at(const Values& values) {
    std::ranges::copy(values, evaluation_->values().begin());
    return evaluation_->result();
  }

  Expression::Evaluation* evaluation_;
};

/// The shortest part of a formula that is not finite at `bad`, or far larger than at `good`.
std::pair<std::size_t, std::string> culprit(const Formula& formula, const Values& bad,
                                            const Values& good) {
  const std::string& text = formula.text;
  std::vector<std::string> names;
  for (const FormulaVariable& variable : formula_variables()) names.emplace_back(variable.name);
  for (const FormulaParameter& parameter : formula.parameters) names.push_back(parameter.name);
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.';
  };
  const auto splits_a_word = [&](std::size_t at) {
    return at > 0 && at < text.size() && is_word(text[at - 1]) && is_word(text[at]);
  };
  for (std::size_t length = 1; length < text.size(); ++length)
    for (std::size_t at = 0; at + length <= text.size(); ++at) {
      const std::string part = text.substr(at, length);
      if (splits_a_word(at) || splits_a_word(at + length) || part.front() == ' ') continue;
      if (std::ranges::count(part, '(') != std::ranges::count(part, ')')) continue;
      try {
        const Expression expression(part, names);
        Expression::Evaluation evaluation(expression);
        Along along(evaluation);
        const double there = along(bad);
        if (!std::isfinite(there) || there > kPole * std::max(along(good), 1e-300))
          return {at, part};
      } catch (const UsageError&) {  // no expression of its own
      }
    }
  return {0, text};
}

class FaultFinder {
 public:
  FaultFinder(const FormulaParts& parts, const Stations& stations)
      : parts_(parts), stations_(stations), evaluation_(parts.expression()), along_(evaluation_) {
    for (Eigen::Index i = 1; i < stations.size(); ++i)
      if (std::abs(stations.trace(i)) < std::abs(stations.trace(nearest_to_axis_)))
        nearest_to_axis_ = i;
  }

  std::string find() {
    std::vector<double> middle;
    for (std::size_t s = 0; s < parts_.shapes(); ++s) middle.push_back(on_axis(s, 0.5));
    std::string found = at_shape(middle, stations_.size());
    for (std::size_t s = 0; s < parts_.shapes() && found.empty(); ++s)
      for (int i = 0; i < kShapesOnAxis && found.empty(); ++i) {
        std::vector<double> shape = middle;
        shape[s] = on_axis(s, i / (kShapesOnAxis - 1.0));
        found = at_shape(shape, kMostStations);
      }
    for (std::size_t s = 0; s < parts_.shapes() && found.empty(); ++s)
      found = between_shapes(s, middle);
    const std::size_t cornered = std::min(parts_.shapes(), kMostCornered);
    for (std::size_t corner = 0; cornered > 1 && corner >> cornered == 0 && found.empty();
         ++corner) {
      std::vector<double> shape = middle;
      for (std::size_t s = 0; s < cornered; ++s)
        shape[s] = on_axis(s, (corner >> s & 1U) ? 1.0 : 0.0);
      found = at_shape(shape, kMostStations, true);
    }
    return found;
  }

 private:
  [[nodiscard]] double on_axis(std::size_t shape, double share) const {
    const Parameter& p = parts_.parameters()[parts_.amplitudes() + shape];
    return is_logarithmic(p.lower, p.upper) ? p.lower * std::pow(p.upper / p.lower, share)
                                            : p.lower + share * (p.upper - p.lower);
  }

  Values values_at(Eigen::Index station, std::size_t amplitude, const std::vector<double>& shape) {
    Values values(evaluation_.values().begin(), evaluation_.values().end());
    parts_.set_station(stations_, station, values);
    parts_.set_amplitude(amplitude, values);
    parts_.set_shapes(shape, values);
    return values;
  }

  /// Where it is far larger than `largest`.
  std::optional<Values> pole_between(const Values& first, const Values& last, double largest) {
    for (const Along::From from : {Along::From::zero, Along::From::chord}) {
      Values place = along_.farthest(from, first, last);
      if (!(along_(place) <= kPole * std::max(largest, 1e-300))) return place;
    }
    return std::nullopt;
  }

  /// @param may_overflow  at a corner that no fit goes to; but no pole is there, nor what is no
  /// number
  std::string at_shape(const std::vector<double>& shape, Eigen::Index most,
                       bool may_overflow = false) {
    const Eigen::Index stride = std::max<Eigen::Index>(1, stations_.size() / most);
    std::vector<Eigen::Index> looked_at{nearest_to_axis_, stations_.size() - 1};
    for (Eigen::Index i = 0; i < stations_.size(); i += stride) looked_at.push_back(i);
    std::ranges::sort(looked_at);
    for (std::size_t j = 0; j < parts_.amplitudes(); ++j) {
      std::vector<double> sizes;
      for (const Eigen::Index i : looked_at) sizes.push_back(along_(values_at(i, j, shape)));
      const auto overflows = [](double size) { return std::isinf(size) || size > kOverflow; };
      if (may_overflow && std::ranges::all_of(sizes, overflows)) return "";
      for (std::size_t i = 0; i < sizes.size(); ++i)
        if (!std::isfinite(sizes[i])) {
          const Values values = values_at(looked_at[i], j, shape);
          return told(values, values, looked_at[i], "is not finite at ");
        }
      const double largest = std::ranges::max(sizes);
      for (const std::size_t at : sharpest(sizes)) {
        const Values here = values_at(looked_at[at], j, shape);
        for (const std::size_t beside :
             {at - std::min<std::size_t>(at, 1), std::min(at + 1, looked_at.size() - 1)}) {
          if (const auto pole = pole_between(here, values_at(looked_at[beside], j, shape), largest))
            return told(*pole, here, looked_at[at], "has a pole near ");
        }
      }
    }
    return "";
  }

  /// Where the largest is, and where these bend most.
  static std::vector<std::size_t> sharpest(const std::vector<double>& sizes) {
    const std::size_t peak =
        static_cast<std::size_t>(std::ranges::max_element(sizes) - sizes.begin());
    std::vector<double> bends(sizes.size(), 0.0);
    for (std::size_t i = 1; i + 1 < sizes.size(); ++i)
      bends[i] = std::abs(sizes[i - 1] - 2.0 * sizes[i] + sizes[i + 1]);
    bends[peak] = INFINITY;
    std::vector<std::size_t> out(sizes.size());
    std::iota(out.begin(), out.end(), 0);
    const std::size_t count = std::min(kSharpest, out.size());
    std::ranges::partial_sort(out, out.begin() + static_cast<std::ptrdiff_t>(count),
                              std::greater<>{}, [&](std::size_t i) { return bends[i]; });
    out.resize(count);
    return out;
  }

  /// A pole that lies between two of the shapes that were tried, at the station in the middle.
  std::string between_shapes(std::size_t s, std::vector<double> shape) {
    const Eigen::Index station = stations_.size() / 2;
    for (std::size_t j = 0; j < parts_.amplitudes(); ++j) {
      std::vector<Values> tried;
      for (int i = 0; i < kShapesOnAxis; ++i) {
        shape[s] = on_axis(s, i / (kShapesOnAxis - 1.0));
        tried.push_back(values_at(station, j, shape));
      }
      for (std::size_t i = 1; i < tried.size(); ++i) {
        const double largest = std::max(along_(tried[i - 1]), along_(tried[i]));
        if (const auto pole = pole_between(tried[i - 1], tried[i], largest))
          return told(*pole, tried[i], station, "has a pole near ");
      }
    }
    return "";
  }

  std::string told(const Values& bad, const Values& good, Eigen::Index station,
                   const std::string& what) {
    const Formula& formula = parts_.formula();
    std::string place, subject = "the function ";
    if (!formula.function) {
      const auto [at, part] = culprit(formula, bad, good);
      subject = "column " + std::to_string(at + 1) + " of its formula: '" + part + "' ";
    }
    const auto add = [&](const std::string& name, std::size_t i) {
      place += (place.empty() ? "" : ", ") + name + " = " + significant(bad[i], kDigits);
    };
    const std::size_t first = formula_variables().size();
    for (std::size_t v = 0; v < first; ++v)
      if (parts_.expression().uses(v)) add(formula_variables()[v].name, v);
    for (std::size_t p = 0; p < formula.parameters.size(); ++p)
      add(formula.parameters[p].name, first + p);
    return subject + what +
           significant(stations_.positions()[static_cast<std::size_t>(station)], kDigits) +
           " mm (" + place + ")";
  }

  const FormulaParts& parts_;
  const Stations& stations_;
  Expression::Evaluation evaluation_;
  Along along_;
  Eigen::Index nearest_to_axis_ = 0;
};

}  // namespace

std::string fault_of(const FormulaParts& parts, const Stations& stations) {
  return stations.size() == 0 ? "" : FaultFinder(parts, stations).find();
}

}  // namespace slideway
