#include <algorithm>
#include <array>
#include <cmath>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/report/compensation.hpp"
#include "slideway/report/number.hpp"

// isg: Beckhoff Information System, TF5280 Volumetric compensation, "ISG CSV format", "Units of
// measure", "List of parameters supported".
// etalon: the same, "Etalon Exchange Format".
// cec: SINUMERIK 840D sl/828D, Function Manual Extended Functions (6FC5397-1BP40-3BA1), K3, 4.4.
// heidenhain: columns and assignment: MANUALplus 620, Technical Manual (January 2012), 6.10.3,
// pp. 713, 716, 718; layout, where the header line states the widths: github.com/drunsinn/pyLSV2,
// table_reader.py and tests/test_files; TNC 407/415/425, Technical Manual (01.98): an error is
// positive where the travel is too long (1.6.3, p. 151), the break points of the error curve are
// entered (1.6.4, p. 152), 256 at most (4.7.3, p. 622). None of them shows a .COM file byte by
// byte.

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
      "another, shift the positions. Measured travel (a bridge from foot to foot) " +
          significant(x.front(), 9) + " to " + significant(x.back(), 9) + " mm, " +
          std::to_string(x.size()) + " positions " + significant(x[1] - x[0], 9) + " mm apart;",
      "a line between two of them is off by up to " +
          significant(table.interpolation_mm / kMicrometre, 2) + " µm."};
  lines.insert(lines.end(), table.basis.begin(), table.basis.end());
  if (!table.straightness_U_mm.empty())
    lines.push_back("EZX: U up to " +
                    significant(std::ranges::max(table.straightness_U_mm) / kMicrometre, 2) +
                    " µm over this travel");
  lines.insert(lines.end(), table.left_out.begin(), table.left_out.end());
  return lines;
}

/// U at each position: none of the formats has a column for it.
std::vector<std::string> uncertainty_lines(const Compensation& table) {
  std::vector<std::string> lines;
  if (table.straightness_U_mm.empty()) return lines;
  lines.emplace_back("Expanded uncertainty U of EZX: X in mm, U in um");
  for (std::size_t i = 0; i < table.positions_mm.size(); ++i)
    lines.push_back(millimetres(table.positions_mm[i]) + " " +
                    significant(table.straightness_U_mm[i] / kMicrometre, 2));
  return lines;
}

std::vector<std::string> volumetric_lines(const Compensation& table, const std::string& source) {
  auto lines = common_lines(table, source, false);
  lines.emplace_back(
      "To set: the axis numbers of X and Z, and `negate` if the control adds errors");
  lines.emplace_back("instead of taking them off. Check the sign with a second face before use.");
  for (std::string& line : uncertainty_lines(table)) lines.push_back(std::move(line));
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

/// Of the tool tip, from the first position on, mm.
double error_in_z(const Compensation& table, std::size_t i) {
  const std::vector<double>& x = table.positions_mm;
  return (table.straightness_mm.empty() ? 0.0 : table.straightness_mm[i]) -
         table.squareness_rad.value_or(0.0) * (x[i] - x.front());
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
  for (const std::string& line : uncertainty_lines(table)) lines.push_back(line);
  std::string text = "%_N_NC_CEC_INI\nCHANDATA(1)\n" + commented("; ", lines);
  for (std::size_t i = 0; i < x.size(); ++i)
    text += "$AN_CEC[0," + std::to_string(i) + "]=" + fine(-error_in_z(table, i)) + "\n";
  return text + "$AN_CEC_INPUT_AXIS[0]=(AX1)\n$AN_CEC_OUTPUT_AXIS[0]=(AX2)\n$AN_CEC_STEP[0]=" +
         fine((x.back() - x.front()) / static_cast<double>(x.size() - 1)) +
         "\n$AN_CEC_MIN[0]=" + millimetres(x.front()) +
         "\n$AN_CEC_MAX[0]=" + millimetres(x.back()) +
         "\n$AN_CEC_DIRECTION[0]=0\n$AN_CEC_MULT_BY_TABLE[0]=0\n$AN_CEC_IS_MODULO[0]=0\nM17\n";
}

std::string heidenhain(const Compensation& table, const std::string&) {
  constexpr std::size_t kMostRows = 256, kWidth = 16;
  const std::vector<double>& x = table.positions_mm;
  if (x.size() > kMostRows) {
    const double least = std::ceil((x.back() - x.front()) / (kMostRows - 1.0) * 1e3) / 1e3;
    throw UsageError("step: makes " + std::to_string(x.size()) + " positions, a .COM table takes " +
                     std::to_string(kMostRows) + "; accepted: " + significant(least, 6) +
                     " mm or more");
  }
  const auto row = [](const std::array<std::string, 3>& cells) {
    std::string line;
    for (std::string cell : cells) {
      cell.resize(kWidth, ' ');
      line += cell;
    }
    return line + "\n";
  };
  std::string text = "BEGIN SLIDEWAY.COM MM\n" + row({"AXISPOS", "BACKLASH", "Z"});
  for (std::size_t i = 0; i < x.size(); ++i)
    text += row({millimetres(x[i]), "", fixed_point(error_in_z(table, i), 9)});
  return text + "[END]\n";
}

std::vector<std::string> beside_heidenhain(const Compensation& table, const std::string& source) {
  auto lines = common_lines(table, source, false);
  for (const char* line :
       {"Column Z: error of Z over X, of all that is named above, mm, 0 at the first position.",
        "AXISPOS: X from the machine datum, mm. BACKLASH: empty, one curve for both directions.",
        "Layout: MANUALplus 620; a .COM table with DATUM and DIST in its head is another one.",
        "To set: keep the name SLIDEWAY.COM of the first line; enter it in column X of the .CMA",
        "table, so that Z = F(X); write your key of the axis (CfgAxes/axisList) for Z.",
        "The sign is that of an error: manuals of the maker have the error curve entered, positive",
        "where the travel is too long. Check it with a second face before use: if its form has",
        "doubled, turn the signs of column Z round."})
    lines.emplace_back(line);
  return lines;
}

struct Control {
  std::string_view name;
  std::string (*table)(const Compensation&, const std::string& source);
  std::vector<std::string> (*beside)(const Compensation&, const std::string& source) = nullptr;
};
constexpr std::array<Control, 4> kControls{{{"isg", isg},
                                            {"etalon", etalon},
                                            {"cec", cec},
                                            {"heidenhain", heidenhain, beside_heidenhain}}};

const Control& control_named(const std::string& name) {
  const auto* const found = std::ranges::find(kControls, name, &Control::name);
  if (found != kControls.end()) return *found;
  const std::vector<std::string>& names = compensation_formats();
  throw UsageError("unknown format '" + printable(name) + "'" + did_you_mean(name, names) +
                   "; accepted: " + joined(names));
}

}  // namespace

const std::vector<std::string>& compensation_formats() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const Control& control : kControls) names.emplace_back(control.name);
    return names;
  }();
  return kNames;
}

void check_compensation_format(const std::string& format) { control_named(format); }

std::string compensation_table(const Compensation& table, const std::string& format,
                               const std::string& source) {
  return control_named(format).table(table, printable(source, 200));
}

std::vector<std::string> compensation_notes(const Compensation& table, const std::string& format,
                                            const std::string& source) {
  const Control& control = control_named(format);
  return control.beside != nullptr ? control.beside(table, printable(source, 200)) : table.left_out;
}

}  // namespace slideway
