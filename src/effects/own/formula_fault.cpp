#include <algorithm>
#include <cmath>

#include "formula_parts.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr double kPole = 1e6;                 // times what it is at the next station
constexpr int kHalvings = 64;                 // of the gap in which a pole is looked for
constexpr Eigen::Index kMostStations = 2048;  // at shapes other than the middle
constexpr int kShapesOnAxis = 17;
constexpr int kDigits = 6;

using Values = std::vector<double>;

/// A formula along a line between two sets of values.
class Along {
 public:
  explicit Along(Expression::Evaluation& evaluation) : evaluation_(&evaluation) {}

  double operator()(const Values& values) {
    std::ranges::copy(values, evaluation_->values().begin());
    return std::abs(evaluation_->result());
  }

  /// Where it is largest between a and b, of one hump, by thirds.
  Values largest(Values a, Values b) {
    const auto mix = [&](double share) {
      Values out = a;
      for (std::size_t i = 0; i < out.size(); ++i) out[i] += share * (b[i] - a[i]);
      return out;
    };
    for (int i = 0; i < kHalvings; ++i) {
      Values left = mix(1.0 / 3.0), right = mix(2.0 / 3.0);
      const double of_left = (*this)(left), of_right = (*this)(right);
      if (!std::isfinite(of_left)) return left;
      if (!std::isfinite(of_right)) return right;
      (of_left < of_right ? a : b) = std::move(of_left < of_right ? left : right);
    }
    return mix(0.5);
  }

 private:
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

  std::string at_shape(const std::vector<double>& shape, Eigen::Index most) {
    const Eigen::Index stride = std::max<Eigen::Index>(1, stations_.size() / most);
    std::vector<Eigen::Index> looked_at{nearest_to_axis_, stations_.size() - 1};
    for (Eigen::Index i = 0; i < stations_.size(); i += stride) looked_at.push_back(i);
    for (std::size_t j = 0; j < parts_.amplitudes(); ++j) {
      Eigen::Index peak = 0;
      double largest = -1.0;
      for (const Eigen::Index i : looked_at) {
        const Values values = values_at(i, j, shape);
        const double size = along_(values);
        if (!std::isfinite(size)) return told(values, values, i, "is not finite at ");
        if (size > largest) largest = size, peak = i;
      }
      const Eigen::Index before = std::max<Eigen::Index>(0, peak - stride);
      const Eigen::Index after = std::min(stations_.size() - 1, peak + stride);
      const Values here = values_at(peak, j, shape);
      for (const Eigen::Index beside : {before, after}) {
        const Values pole = along_.largest(here, values_at(beside, j, shape));
        if (!(along_(pole) <= kPole * std::max(largest, 1e-300)))
          return told(pole, here, peak, "has a pole near ");
      }
    }
    return "";
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
        const Values pole = along_.largest(tried[i - 1], tried[i]);
        if (!(along_(pole) <= kPole * std::max(largest, 1e-300)))
          return told(pole, tried[i], station, "has a pole near ");
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
