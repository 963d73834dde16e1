#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <tuple>
#include <variant>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/formula.hpp"
#include "slideway/identify/problem_tree.hpp"
#include "slideway/identify/ranking.hpp"
#include "slideway/identify/simulate.hpp"
#include "slideway/report/number.hpp"
#include "slideway/report/report.hpp"
#include "slideway/signal/bands.hpp"
#include "slideway/trace/analysis.hpp"

/// The compiled half of the Python module: plain containers in and out. What users see, its units
/// and its shapes are in slideway/__init__.py.
namespace slideway {
namespace {

namespace py = pybind11;
using Column = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Directory = std::optional<std::filesystem::path>;

/// slideway/_problem.py leaves nothing but these types.
TomlValue tree(py::handle node) {
  if (py::isinstance<py::bool_>(node)) return {0, py::cast<bool>(node)};
  if (py::isinstance<py::int_>(node)) return {0, py::cast<std::int64_t>(node)};
  if (py::isinstance<py::float_>(node)) return {0, py::cast<double>(node)};
  if (py::isinstance<py::str>(node)) return {0, py::cast<std::string>(node)};
  if (py::isinstance<py::list>(node)) {
    TomlValue::Array elements;
    for (const py::handle element : node) elements.push_back(tree(element));
    return {0, std::move(elements)};
  }
  TomlValue::Table entries;
  for (const auto& [key, value] : py::cast<py::dict>(node))
    entries.push_back({py::cast<std::string>(key), 0, tree(value)});
  return {0, std::move(entries)};
}

/// A problem as Python gave it, to be read without the interpreter's lock.
class GivenProblem {
 public:
  GivenProblem(const py::object& problem, Directory data) : data_(std::move(data)) {
    if (py::isinstance<py::dict>(problem))
      source_ = tree(problem);
    else
      source_ = py::cast<std::filesystem::path>(problem);
  }
  [[nodiscard]] Problem read() const {
    return std::visit([this](const auto& source) { return read_problem(source, data_); }, source_);
  }

 private:
  std::variant<std::filesystem::path, TomlValue> source_;
  Directory data_;
};

std::vector<double> numbers(const Column& column, const std::string& what) {
  if (column.ndim() != 1)
    throw UsageError(what + ": an array of " + std::to_string(column.ndim()) +
                     " dimensions; accepted: 1");
  return {column.data(), column.data() + column.size()};
}

py::array_t<double> array(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::str text(const std::string& utf8) {  // a file's name in it need not be UTF-8
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(utf8.data(), static_cast<py::ssize_t>(utf8.size()), "replace"));
}

/// Ends a run from another thread. The run asks before it takes the interpreter's lock, so that one
/// that is left over does not wait for an interpreter that has ended.
class Cancellation {
 public:
  void cancel() { cancelled_ = true; }
  void check() const {
    if (cancelled_) throw DataError("cancelled");
  }

 private:
  std::atomic<bool> cancelled_ = false;
};
using SharedCancellation = std::shared_ptr<Cancellation>;

/// A Python function, called and let go with the interpreter's lock.
class LockedFunction {
 public:
  LockedFunction(py::function function, SharedCancellation cancellation)
      : function_(new py::function(std::move(function)),
                  [](py::function* own) {
                    const py::gil_scoped_acquire lock;
                    delete own;
                  }),
        cancellation_(std::move(cancellation)) {}

  std::vector<double> operator()(const std::map<std::string, std::vector<double>>& variables,
                                 const std::map<std::string, double>& parameters) const {
    cancellation_->check();
    const py::gil_scoped_acquire lock;
    py::dict arguments;
    for (const auto& [name, values] : variables) arguments[name.c_str()] = array(values);
    for (const auto& [name, value] : parameters) arguments[name.c_str()] = value;
    return numbers(py::cast<Column>((*function_)(**arguments)), "the function");
  }

 private:
  std::shared_ptr<py::function> function_;
  SharedCancellation cancellation_;
};

/// (name, function, variables, [(parameter, unit, lower, upper)], cause, source, typical)
using GivenEffect = std::tuple<
    std::string, py::function, std::vector<std::string>,
    std::vector<std::tuple<std::string, std::string, std::optional<double>, std::optional<double>>>,
    std::string, std::string, std::string>;

std::vector<DeclaredEffect> made(const std::vector<GivenEffect>& effects,
                                 const SharedCancellation& cancellation) {
  std::vector<DeclaredEffect> out;
  for (const auto& [name, function, variables, parameters, cause, source, typical] : effects) {
    Formula formula{.name = name, .text = "a function of " + joined(variables)};
    for (const auto& [parameter, unit, lower, upper] : parameters)
      formula.parameters.push_back({parameter, unit, lower, upper});
    formula.cause = cause;
    formula.source = source;
    formula.typical = typical;
    formula.function = LockedFunction(function, cancellation);
    formula.variables = variables;
    try {
      out.push_back({name, {.own = formula_effect(formula)}, {}});
    } catch (const UsageError& error) {
      throw UsageError("effect '" + name + "': " + error.what());
    }
  }
  return out;
}

GivenTraces traces_of(const std::map<std::string, std::vector<Column>>& profiles) {
  constexpr std::size_t kUntimed = 2, kTimed = 3;
  GivenTraces out;
  for (const auto& [name, columns] : profiles) {
    if (columns.size() != kUntimed && columns.size() != kTimed)
      throw UsageError("'" + name + "': " + std::to_string(columns.size()) +
                       " arrays; accepted: positions and values, or these and reading times");
    Trace& trace = out[name];
    trace.positions = numbers(columns[0], "positions of '" + name + "'");
    trace.values = numbers(columns[1], "values of '" + name + "'");
    if (columns.size() == kTimed) trace.times = numbers(columns[2], "times of '" + name + "'");
  }
  return out;
}

py::tuple analysed(const py::object& problem,
                   const std::map<std::string, std::vector<Column>>& profiles,
                   const Directory& data, bool ranks_only, bool closes_loop,
                   const std::vector<GivenEffect>& effects, const py::function& progress,
                   const SharedCancellation& cancellation) {
  const std::vector<DeclaredEffect> own = made(effects, cancellation);
  const GivenProblem given(problem, data);
  const GivenTraces traces = traces_of(profiles);
  std::string json, report;
  {
    const py::gil_scoped_release unlocked;
    Problem read = given.read();
    for (const DeclaredEffect& effect : own) look_for(effect, read);
    const Analysis analysis =
        analyse(read, read_profiles(read, traces),
                {ranks_only ? Scope::rank : Scope::identify, closes_loop, true, true},
                [&](const std::string& stage, double done) {
                  cancellation->check();
                  const py::gil_scoped_acquire lock;
                  progress(stage, done);
                });
    json = json_report(analysis);
    report = text_report(analysis);
  }
  return py::make_tuple(text(json), text(report));
}

constexpr const char* kReport = "report";  // what its JSON goes by in messages

py::str page(const std::string& json) { return text(html_report(json, kReport)); }

py::str picture(const std::string& json) { return text(svg_report(json, kReport)); }

py::list simulated(const py::object& problem, std::optional<std::uint64_t> seed,
                   const Directory& data) {
  const GivenProblem given(problem, data);
  const std::vector<Profile> profiles = [&] {
    const py::gil_scoped_release unlocked;
    Problem read = given.read();
    if (seed && read.truth) read.truth->seed = *seed;
    return simulate(read);
  }();
  py::list result;
  for (const Profile& profile : profiles) {
    const bool slope = profile.setup.quantity == Quantity::slope;
    std::vector<double> values = profile.values;
    for (double& value : values) value = slope ? value * 1e6 : value / kMicrometre;
    result.append(
        py::make_tuple(text(profile.name), profile.setup.kind == Kind::face ? "face" : "slide",
                       slope ? "slope" : "height", array(profile.positions), array(values)));
  }
  return result;
}

void check_finite(const std::vector<double>& values, const std::string& what) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw DataError(what + ": sample " + std::to_string(i) +
                      " is not finite; bands are made of whole profiles");
}

void check_signal(const std::vector<double>& signal, int level) {
  constexpr int kHighestLevel = 30;
  if (level < 1 || level > kHighestLevel)
    throw UsageError("level: " + std::to_string(level) + " is out of range; accepted: 1 to " +
                     std::to_string(kHighestLevel));
  const std::size_t needed = std::size_t{1} << level;
  if (signal.size() < needed)
    throw DataError("signal: " + std::to_string(signal.size()) + " samples; level " +
                    std::to_string(level) + " needs " + std::to_string(needed));
  check_finite(signal, "signal");
}

py::array_t<double> rows(const std::vector<Band>& bands) {
  py::array_t<double> matrix({bands.size(), bands.front().size()});
  for (std::size_t j = 0; j < bands.size(); ++j)
    std::copy(bands[j].begin(), bands[j].end(),
              matrix.mutable_data(static_cast<py::ssize_t>(j), 0));
  return matrix;
}

py::tuple decomposed(const Column& signal, const std::string& wavelet, int level,
                     const std::string& mode) {
  const std::vector<double> samples = numbers(signal, "signal");
  const Bands bands = [&] {
    const py::gil_scoped_release unlocked;
    check_signal(samples, level);
    return reconstruct_bands(daubechies(wavelet), boundary(mode), level, samples);
  }();
  return py::make_tuple(rows(bands.approximations), rows(bands.details));
}

py::list ranked(const Column& signal, const py::dict& candidates, const std::string& wavelet,
                int level, const std::string& mode) {
  const std::vector<double> measured = numbers(signal, "signal");
  check_finite(measured, "signal");
  std::vector<std::pair<std::string, std::vector<double>>> columns;
  for (const auto& [key, value] : candidates) {
    const auto name = py::cast<std::string>(key);
    const std::string what = "candidate '" + name + "'";
    columns.emplace_back(name, numbers(py::cast<Column>(value), what));
    if (columns.back().second.size() != measured.size())
      throw DataError(what + ": " + std::to_string(columns.back().second.size()) +
                      " samples; accepted: as many as the signal has, " +
                      std::to_string(measured.size()));
    check_finite(columns.back().second, what);
  }
  const std::vector<ColumnRanking> ranking = [&] {
    const py::gil_scoped_release unlocked;
    return rank_columns(measured, columns, {wavelet, level, boundary(mode)});
  }();
  py::list result;
  for (const ColumnRanking& row : ranking)
    result.append(py::make_tuple(text(row.candidate), row.raw, row.low_band, row.lag,
                                 row.lag_coefficient, row.effective_observations, row.p_value));
  return result;
}

template <typename Error>
void register_error(py::module_& module, const char* name, const char* doc) {
  auto& type = py::register_exception<Error>(module, name, PyExc_ValueError);
  type.attr("__module__") = "slideway";
  type.attr("__doc__") = doc;
}

}  // namespace

PYBIND11_MODULE(_slideway, module) {
  module.attr("__version__") = SLIDEWAY_VERSION;
  register_error<UsageError>(module, "UsageError",
                             "The problem, or an argument, is wrong: what, and what is accepted.");
  register_error<DataError>(module, "DataError",
                            "Numbers or a data file cannot be used: what is wrong, and where.");
  py::class_<Cancellation, SharedCancellation>(module, "Cancellation",
                                               "Ends a run from another thread.")
      .def(py::init<>())
      .def("cancel", &Cancellation::cancel);
  module.def("analyse", &analysed, py::arg("problem"), py::arg("profiles"), py::arg("data"),
             py::arg("ranks_only"), py::arg("closes_loop"), py::arg("effects"), py::arg("progress"),
             py::arg("cancellation"));
  module.def("page", &page, py::arg("json"));
  module.def("picture", &picture, py::arg("json"));
  module.def("value_text", &with_uncertainty, py::arg("value"), py::arg("expanded_uncertainty"));
  module.def("simulate", &simulated, py::arg("problem"), py::arg("seed"), py::arg("data"));
  module.def("rank_columns", &ranked, py::arg("signal"), py::arg("candidates"), py::arg("wavelet"),
             py::arg("level"), py::arg("boundary"));
  module.def("decompose", &decomposed, py::arg("signal"), py::arg("wavelet"), py::arg("level"),
             py::arg("boundary"));
}

}  // namespace slideway
