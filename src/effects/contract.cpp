#include "slideway/effects/contract.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr double kClose = 1e-4;  // a derivative to a central difference with its truncation

struct Case {
  std::string name;
  Setup setup;
  std::vector<double> positions;
};

Case case_of(std::string name, Kind kind, Quantity quantity, double first, double last) {
  constexpr int kStations = 53;  // shares no factor with grooves or periods
  Case out{std::move(name), {}, {}};
  Setup& setup = out.setup;
  setup.kind = kind;
  setup.quantity = quantity;
  setup.spindle_position_mm = kind == Kind::face ? 360.0 : 0.0;
  setup.z_mm = 80.0;
  setup.overhang_mm = 25.0;
  setup.feed_mm_per_min = 2.0;
  setup.spindle_rpm = 110.0;
  setup.cut_direction = CutDirection::inward;
  if (kind == Kind::face) setup.cut_radius_mm = last;
  setup.traverse_mm_per_s = 0.5;
  setup.first_mm = first;
  setup.last_mm = last;
  for (int i = 0; i < kStations; ++i)
    out.positions.push_back(first + (last - first) * i / (kStations - 1));
  ReadingTimes times{out.positions, {}};
  for (int i = 0; i < kStations; ++i) times.times_s.push_back(10.0 * i + 0.05 * i * i);
  setup.reading_times = std::make_shared<const ReadingTimes>(std::move(times));
  return out;
}

std::vector<Case> cases() {
  std::vector<Case> out{case_of("a face cut inward", Kind::face, Quantity::height, 0.0, 10.0),
                        case_of("a face cut outward", Kind::face, Quantity::height, 0.0, 10.0),
                        case_of("a diameter", Kind::face, Quantity::height, -10.0, 10.0),
                        case_of("heights along a slide", Kind::slide, Quantity::height, 0.0, 600.0),
                        case_of("slopes along a slide", Kind::slide, Quantity::slope, 0.0, 600.0),
                        case_of("slopes over a base", Kind::slide, Quantity::slope, 0.0, 600.0)};
  out[1].setup.cut_direction = CutDirection::outward;
  out[5].setup.base_mm = 10.0;
  return out;
}

const Machine& lathe() {
  static const Machine kLathe(Machine::paper_lathe(), Lever::paper);
  return kLathe;
}

class ContractTest {
 public:
  explicit ContractTest(const Effect& effect) : effect_(effect) {}

  std::vector<std::string> faults() {
    check_description();
    bool applies = false;
    for (const Case& each : cases()) {
      place_ = each.name;
      const Stations stations(each.positions, each.setup, lathe());
      if (!effect_.applies_to(each.setup)) continue;
      if (!effect_.lacking(each.setup).empty()) continue;
      applies = true;
      if (!check_search(stations)) continue;
      const std::string fault = effect_.fault(stations);
      require(fault.empty(), fault);
      for (const std::vector<double>& shape : shapes_to_try(stations)) check_at(stations, shape);
    }
    place_.clear();
    require(applies, "no reading shows it");
    return std::move(faults_);
  }

 private:
  void require(bool kept, const std::string& what) {
    const std::string fault = place_.empty() ? what : "on " + place_ + ": " + what;
    if (!kept && std::ranges::count(faults_, fault) == 0) faults_.push_back(fault);
  }

  void check_description() {
    const Description& about = effect_.description();
    for (const auto& [what, text] :
         {std::pair("name", &about.name), std::pair("formula", &about.formula),
          std::pair("source", &about.source), std::pair("cause", &about.cause),
          std::pair("typical", &about.typical)})
      require(!text->empty(), std::string("its description has no ") + what);
    for (const Parameter& each : effect_.parameters()) {
      require(!each.name.empty() && !each.unit.empty(), "a parameter has no name or no unit");
      require(each.scale > 0.0 && each.lower < each.upper,
              each.name + " has no scale, or bounds the wrong way round");
    }
    const auto count = static_cast<std::size_t>(effect_.amplitudes()) + effect_.shapes().size();
    require(effect_.parameters().size() == count,
            "it has not one parameter for each amplitude and each shape");
  }

  bool check_search(const Stations& stations) {
    bool inside = true;
    for (std::size_t s = 0; s < effect_.shapes().size(); ++s) {
      const Parameter& parameter = parameter_of(s);
      const auto [low, high] = effect_.search_range(static_cast<int>(s), stations);
      const bool kept = low < high && low >= parameter.lower && high <= parameter.upper &&
                        (!effect_.shapes()[s].logarithmic || low > 0.0);
      require(kept, parameter.name + " is searched outside its bounds, or nowhere");
      inside = inside && kept;
    }
    return inside;
  }

  [[nodiscard]] const Parameter& parameter_of(std::size_t shape) const {
    return effect_.parameters()[static_cast<std::size_t>(effect_.shapes()[shape].parameter)];
  }

  /// Ordinary ones, and each at the ends of its search.
  [[nodiscard]] std::vector<std::vector<double>> shapes_to_try(const Stations& stations) const {
    std::vector<std::vector<double>> out(1);
    for (std::size_t s = 0; s < effect_.shapes().size(); ++s) {
      const auto [low, high] = effect_.search_range(static_cast<int>(s), stations);
      out[0].push_back(low > 0.0 ? std::sqrt(low * high) : low + 0.3 * (high - low));
    }
    for (std::size_t s = 0; s < effect_.shapes().size(); ++s) {
      const auto [low, high] = effect_.search_range(static_cast<int>(s), stations);
      for (const double end : {low, high}) {
        out.push_back(out[0]);
        out.back()[s] = end;
      }
    }
    return out;
  }

  [[nodiscard]] Eigen::MatrixXd columns(const Stations& stations,
                                        const std::vector<double>& shape) const {
    Eigen::MatrixXd out(stations.size(), effect_.amplitudes());
    effect_.columns(stations, shape, out);
    return out;
  }

  void check_at(const Stations& stations, const std::vector<double>& shape) {
    const Eigen::MatrixXd here = columns(stations, shape);
    require(here.allFinite(), "its columns are not finite");
    check_parameters(shape);
    Eigen::MatrixXd slopes(here.rows(), std::ssize(shape) * here.cols());
    effect_.derivatives(stations, shape, slopes);
    for (std::size_t s = 0; s < shape.size(); ++s)
      check_derivative(stations, shape, s, here,
                       slopes.middleCols(static_cast<Eigen::Index>(s) * here.cols(), here.cols()));
  }

  void check_parameters(const std::vector<double>& shape) {
    const Eigen::Index n = effect_.amplitudes();
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    require(effect_.size(effect_.parameter_values(none, shape).values) == 0.0,
            "its size is not 0 where its amplitudes are");
    Eigen::VectorXd some(n);
    for (Eigen::Index i = 0; i < n; ++i)
      some[i] = 1e-3 * std::cos(1.0 + 2.0 * static_cast<double>(i));
    const Eigen::VectorXd values = effect_.parameter_values(some, shape).values;
    require((effect_.from_parameters(values).head(n) - some).norm() <= 1e-9 * some.norm(),
            "parameters and amplitudes are not inverse to one another");
    if (!effect_.linear_parameters()) return;
    const auto linear = values.size() - std::ssize(shape);
    const Eigen::VectorXd twice = effect_.parameter_values(2.0 * some, shape).values;
    require((twice - 2.0 * values).head(linear).norm() <= 1e-9 * values.head(linear).norm(),
            "its parameters are not linear in its amplitudes");
  }

  void check_derivative(const Stations& stations, const std::vector<double>& shape, std::size_t s,
                        const Eigen::MatrixXd& here, const Eigen::MatrixXd& slope) {
    require(slope.allFinite(), "a derivative by " + parameter_of(s).name + " is not finite");
    const double size = here.cwiseAbs().maxCoeff(), largest = slope.cwiseAbs().maxCoeff();
    if (effect_.shapes()[s].stepwise || size == 0.0 || largest == 0.0) return;
    const double step = std::min(1e-5 * std::abs(shape[s]), 1e-4 * size / largest);
    std::vector<double> plus = shape, minus = shape;
    plus[s] += step;
    minus[s] -= step;
    // At a bound there is no central difference.
    if (plus[s] > parameter_of(s).upper || minus[s] < parameter_of(s).lower || step == 0.0) return;
    const Eigen::MatrixXd difference =
        (columns(stations, plus) - columns(stations, minus)) / (plus[s] - minus[s]);
    const double rounding = 1e-15 * (size + largest * std::abs(shape[s])) / step;
    require((difference - slope).cwiseAbs().maxCoeff() <= kClose * largest + rounding,
            "a derivative by " + parameter_of(s).name + " is not that of its columns");
  }

  const Effect& effect_;
  std::string place_;
  std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> contract_faults(const Effect& effect) {
  return ContractTest(effect).faults();
}

}  // namespace slideway
