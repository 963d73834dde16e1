#include <algorithm>
#include <array>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/report/compensation.hpp"
#include "slideway/report/number.hpp"

// isg: Beckhoff Information System, TF5280 Volumetric compensation, "ISG CSV format", "Units of
// measure", "List of parameters supported".
// etalon: the same, "Etalon Exchange Format".
// cec: SINUMERIK 840D sl/828D, Function Manual Extended Functions (6FC5397-1BP40-3BA1), K3, 4.4.

namespace slideway {
namespace {

std::string millimetres(double value) { return fixed_point(value, 6); }
std::string fine(double value) { return fixed_point(value, 12); }

/// Controls read ASCII.
std::string in_ascii(std::string text) {
  for (const auto& [sign, word] : {std::pair{"Δβxz", "dbeta_xz"}, {"µ", "u"}, {"±", "+-"}})
    for (std::size_t at = text.find(sign); at != std::string::npos; at = text.find(sign))
      text.replace(at, std::string_view(sign).size(), word);
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

std::string commented(const std::string& mark, const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += mark + in_ascii(line) + "\n";
  return text;
}

std::vector<std::string> common_lines(const Compensation& table, const std::string& source,
                                      bool correction) {
  const std::vector<double>& x = table.positions_mm;
  std::vector<std::string> lines{
      source,
      correction ? "Values are corrections: minus the error (actual minus nominal) of the tool tip."
                 : "Values are errors: actual minus nominal position of the tool tip.",
      "Axes as in ISO 841: +Z from the workpiece to the tool, +X away from the spindle axis;",
      "angles right-handed about +Y: B0X above 0 takes the tool to -Z as X grows.",
      "X: slide coordinate x of the problem file, a radius, mm. Where the machine coordinate is",
      "another, shift the positions. Measured travel " + significant(x.front(), 9) + " to " +
          significant(x.back(), 9) + " mm, " + std::to_string(x.size()) + " positions " +
          significant(x[1] - x[0], 9) + " mm apart;",
      "a line between two of them is off by up to " +
          significant(table.interpolation_mm / kMicrometre, 2) + " µm."};
  lines.insert(lines.end(), table.basis.begin(), table.basis.end());
  lines.insert(lines.end(), table.left_out.begin(), table.left_out.end());
  return lines;
}

std::vector<std::string> volumetric_lines(const Compensation& table, const std::string& source) {
  auto lines = common_lines(table, source, false);
  lines.emplace_back(
      "To set: the axis numbers of X and Z, and `negate` if the control adds errors");
  lines.emplace_back("instead of taking them off. Check the sign with a second face before use.");
  return lines;
}

std::string isg(const Compensation& table, const std::string& source) {
  std::string text = commented("// ", volumetric_lines(table, source));
  if (table.squareness_rad) text += "B0X\n" + fine(*table.squareness_rad) + "\n";
  if (table.straightness_mm.empty()) return text;
  if (table.squareness_rad) text += "#\n";
  text += "X\tEZX\n";
  for (std::size_t i = 0; i < table.positions_mm.size(); ++i)
    text += millimetres(table.positions_mm[i]) + "\t" + fine(table.straightness_mm[i]) + "\n";
  return text;
}

std::string etalon(const Compensation& table, const std::string& source) {
  std::string text = commented("// ", volumetric_lines(table, source));
  if (table.squareness_rad) text += "[B0X]\nVALUE = " + fine(*table.squareness_rad) + "\n";
  if (table.straightness_mm.empty()) return text;
  text += "[EZX]\nGridpoints = {\n";
  for (std::size_t i = 0; i < table.positions_mm.size(); ++i)
    text += millimetres(table.positions_mm[i]) + " " + fine(table.straightness_mm[i]) + "\n";
  return text + "}\n";
}

std::string cec(const Compensation& table, const std::string& source) {
  const std::vector<double>& x = table.positions_mm;
  auto lines = common_lines(table, source, true);
  const std::string points = std::to_string(x.size());
  for (const std::string& line :
       {std::string("Sag compensation of Z over X, of all that is named above, 0 at the first "
                    "position."),
        std::string("To set: your machine axes for AX1 (X) and AX2 (Z); a free table for index "
                    "0;"),
        "MD18342 $MN_MM_CEC_MAX_POINTS[0] = " + points + " or more (formats the memory);",
        std::string("basic system metric (MD10240); load with MD32710 $MA_CEC_ENABLE = 0 for Z, "
                    "then"),
        std::string("set it to 1, and SD41300 $SN_CEC_TABLE_ENABLE[0] = 1. Check the sign with a"),
        std::string("second face; SD41310 $SN_CEC_TABLE_WEIGHT[0] = -1 turns all values round.")})
    lines.push_back(line);
  std::string text = "%_N_NC_CEC_INI\nCHANDATA(1)\n" + commented("; ", lines);
  for (std::size_t i = 0; i < x.size(); ++i) {
    double error = table.straightness_mm.empty() ? 0.0 : table.straightness_mm[i];
    if (table.squareness_rad) error -= *table.squareness_rad * (x[i] - x.front());
    text += "$AN_CEC[0," + std::to_string(i) + "]=" + fine(-error) + "\n";
  }
  return text + "$AN_CEC_INPUT_AXIS[0]=(AX1)\n$AN_CEC_OUTPUT_AXIS[0]=(AX2)\n$AN_CEC_STEP[0]=" +
         fine((x.back() - x.front()) / static_cast<double>(x.size() - 1)) +
         "\n$AN_CEC_MIN[0]=" + millimetres(x.front()) +
         "\n$AN_CEC_MAX[0]=" + millimetres(x.back()) +
         "\n$AN_CEC_DIRECTION[0]=0\n$AN_CEC_MULT_BY_TABLE[0]=0\n$AN_CEC_IS_MODULO[0]=0\nM17\n";
}

using Writer = std::string (*)(const Compensation&, const std::string&);
constexpr std::array<std::pair<std::string_view, Writer>, 3> kWriters{
    {{"isg", isg}, {"etalon", etalon}, {"cec", cec}}};

}  // namespace

const std::vector<std::string>& compensation_formats() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const auto& [name, write] : kWriters) names.emplace_back(name);
    return names;
  }();
  return kNames;
}

void check_compensation_format(const std::string& format) {
  const std::vector<std::string>& names = compensation_formats();
  if (std::ranges::find(names, format) != names.end()) return;
  if (format == "heidenhain")
    throw UsageError(
        "heidenhain: is not written: of a .COM file the columns are documented (AXISPOS, BACKLASH, "
        "one per axis), their widths, by which the control reads its tables, and whether a value "
        "is "
        "the error or its correction are not; accepted: " +
        joined(names) + "; EZX of isg can be entered at the control");
  throw UsageError("unknown format '" + printable(format) + "'" + did_you_mean(format, names) +
                   "; accepted: " + joined(names));
}

std::string compensation_table(const Compensation& table, const std::string& format,
                               const std::string& source) {
  check_compensation_format(format);
  const auto writer =
      std::ranges::find(kWriters, format, &std::pair<std::string_view, Writer>::first);
  return writer->second(table, printable(source, 200));
}

}  // namespace slideway
