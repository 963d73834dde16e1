#include <algorithm>
#include <nlohmann/json.hpp>

#include "slideway/base/text.hpp"
#include "slideway/batch/pool.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson or_null(const std::optional<double>& value) {
  return value ? OrderedJson(*value) : OrderedJson(nullptr);
}

OrderedJson parameter_json(const FittedParameter& p) {
  return {{"name", p.name},
          {"value", or_null(p.value)},
          {"unit", p.unit},
          {"standard_uncertainty", or_null(p.standard_uncertainty)},
          {"expanded_uncertainty", or_null(p.expanded_uncertainty)},
          {"coverage_factor", or_null(p.coverage_factor)},
          {"identifiable", p.identifiable}};
}

std::string rate_unit(const Trend& trend, bool are_dates) {
  const std::string unit = trend.unit == "1" ? "" : trend.unit;
  return (unit.empty() ? "1" : unit) + (are_dates ? "/day" : "/time");
}

OrderedJson trend_json(const Trend& trend, bool are_dates) {
  return {{"parameter", trend.parameter},
          {"items", trend.items},
          {"rate", trend.rate},
          {"unit", rate_unit(trend, are_dates)},
          {"standard_uncertainty", trend.standard_uncertainty},
          {"expanded_uncertainty", trend.expanded_uncertainty},
          {"p_value", written_probability(trend.p_value)},
          {"between_items", trend.between_items}};
}

std::string number(const std::optional<double>& value, int digits) {
  return value ? significant(*value, digits) : "-";
}

std::string parameters_text(const PooledMachine& machine) {
  using Column = TextColumn;
  TextTable table({"parameter", "value ± U", "unit", "k"},
                  {Column::text, Column::text, Column::text, Column::number});
  for (const FittedParameter& p : machine.parameters) {
    std::string shown = "not determined";
    if (p.identifiable) shown = with_uncertainty(*p.value, *p.expanded_uncertainty);
    table.add(
        {p.name, shown, p.unit, p.coverage_factor ? fixed_point(*p.coverage_factor, 2) : "-"});
  }
  return table.text();
}

std::string trends_text(const PooledMachine& machine, bool are_dates) {
  if (machine.trends.empty()) return "";
  using Column = TextColumn;
  TextTable table({"trend", "rate ± U", "unit", "p"},
                  {Column::text, Column::text, Column::text, Column::number});
  for (const Trend& trend : machine.trends) {
    table.add({trend.parameter, with_uncertainty(trend.rate, trend.expanded_uncertainty),
               rate_unit(trend, are_dates), significant(trend.p_value, 2)});
  }
  return table.text();
}

/// The items that do not fit, and the one that comes nearest to it.
std::string items_text(const PooledMachine& machine) {
  using Column = TextColumn;
  TextTable table({"item", "E_n", "p", ""},
                  {Column::name, Column::number, Column::number, Column::text});
  const auto add = [&](const PooledItem& item) {
    table.add({printable(item.id, 60), number(item.En, 2), number(item.p_value, 2),
               item.fits ? "fits" : "does not fit"});
  };
  const PooledItem* worst = nullptr;
  for (const PooledItem& item : machine.items)
    if (!item.fits)
      add(item);
    else if (item.En && (worst == nullptr || *item.En > *worst->En))
      worst = &item;
  if (worst != nullptr) add(*worst);
  return table.text();
}

std::string machine_text(const PooledMachine& machine, bool are_dates) {
  const auto fit =
      static_cast<std::size_t>(std::count_if(machine.items.begin(), machine.items.end(),
                                             [](const PooledItem& item) { return item.fits; }));
  std::string line = "Machine " + printable(machine.machine, 60) + ": " + std::to_string(fit) +
                     " of " + std::to_string(machine.items.size()) + " items fit together";
  if (machine.scatter > 1.0)
    line += "; they differ " + fixed_point(machine.scatter, 2) +
            " times as much as their uncertainties say, which all U allow for";
  if (!machine.left_out.empty())
    line += "; left out, because they declare other carriage parameters than the first: " +
            printable(joined(machine.left_out), 200);
  if (machine.items.empty()) return paragraph("", line);
  return paragraph("", line) + parameters_text(machine) + trends_text(machine, are_dates) +
         items_text(machine);
}

}  // namespace

std::string pooled_text(const std::vector<PooledMachine>& machines, bool are_dates) {
  std::string text;
  for (const PooledMachine& machine : machines) {
    text += '\n';
    text += machine_text(machine, are_dates);
  }
  return text;
}

std::string pooled_json(const std::vector<PooledMachine>& machines, bool are_dates) {
  OrderedJson out = OrderedJson::array();
  for (const PooledMachine& machine : machines) {
    OrderedJson parameters = OrderedJson::array(), trends = OrderedJson::array(),
                items = OrderedJson::array();
    for (const FittedParameter& p : machine.parameters) parameters.push_back(parameter_json(p));
    for (const Trend& trend : machine.trends) trends.push_back(trend_json(trend, are_dates));
    for (const PooledItem& item : machine.items)
      items.push_back({{"id", item.id},
                       {"En", or_null(item.En)},
                       {"p_value", item.p_value ? OrderedJson(written_probability(*item.p_value))
                                                : OrderedJson()},
                       {"fits", item.fits}});
    out.push_back({{"machine", machine.machine},
                   {"parameters", parameters},
                   {"scatter", machine.scatter},
                   {"trends", trends},
                   {"items", items},
                   {"left_out", machine.left_out}});
  }
  return out.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace slideway
