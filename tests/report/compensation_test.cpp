// What stands in a table is read back and held against the model's own height of a face,
// Eqs. (10), (12), (15), (16): z(x) = Σ b_k (x^k - p_x k x^(k-1)) - Δβxz r.

#include "slideway/report/compensation.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <sstream>

#include "report/sample_result.hpp"
#include "slideway/base/error.hpp"
#include "slideway/identify/result_fields.hpp"

namespace slideway::compensation_test {
namespace {

using testing::Contains;
using testing::HasSubstr;

// Eq. (17), as docs/reproduction.md has it; mm^(1-k).
const std::vector<double> kB{2.41e-4, -5.19e-7, 2.2905e-8, -1.558e-10, 3.3908e-13, -2.343e-16};
constexpr double kSquareness = 2.8e-6;
constexpr double kSpindle = 20.0;
constexpr double kWritten = 1e-12;  // mm: half a digit of each of two numbers

constexpr double kEnd = kSpindle + 600.0;

/// Σ b_k (x^k - p_x k x^(k-1)), mm
double tip(double x, double lever) {
  double z = 0.0;
  for (std::size_t k = 0; k < kB.size(); ++k)
    z += kB[k] * std::pow(x, k) -
         (k == 0 ? 0.0 : lever * static_cast<double>(k) * kB[k] * std::pow(x, k - 1));
  return z;
}

/// The form as a report has it, from the lines through its ends.
StraightnessCurve curve(Lever lever, double overhang) {
  const auto at = [&](double x) { return lever == Lever::paper ? x - kSpindle : overhang; };
  const double first = tip(kSpindle, at(kSpindle)), last = tip(kEnd, at(kEnd));
  StraightnessCurve out;
  out.tip_slope_rad = (last - first) / (kEnd - kSpindle);
  for (int i = 0; i <= 200; ++i) {
    const double x = kSpindle + (kEnd - kSpindle) * i / 200.0, share = i / 200.0;
    out.position_mm.push_back(x);
    out.tip_um.push_back((tip(x, at(x)) - first - *out.tip_slope_rad * (x - kSpindle)) * 1e3);
    out.tip_expanded_uncertainty_um.push_back(share * (1.0 - share));
    out.deviation_um.push_back(
        (tip(x, 0.0) - (1.0 - share) * tip(kSpindle, 0.0) - share * tip(kEnd, 0.0)) * 1e3);
    out.expanded_uncertainty_um.push_back(2.0 * share * (1.0 - share));
  }
  return out;
}

Analysis analysis(Lever lever, double overhang = 0.0) {
  Analysis out;
  ModelResult fit;
  fit.converged = true;
  fit.straightness.emplace().curve = curve(lever, overhang);
  for (std::size_t k = 0; k < kB.size(); ++k)
    fit.parameters.push_back(fitted("straightness.b" + std::to_string(k), "b_" + std::to_string(k),
                                    "mm", kB[k], std::abs(kB[k]) / 100.0));
  fit.parameters.push_back(fitted("squareness.dbeta_xz", "Δβxz", "rad", kSquareness, 1e-8));
  out.result.final = fit;
  out.result.travel = {lever, kSpindle, 600.0 + kSpindle, kSpindle, overhang};
  return out;
}

FittedParameter& parameter(Analysis& analysis, const std::string& name) {
  return *std::ranges::find(analysis.result.final->parameters, name, &FittedParameter::name);
}

double height(double x, double lever) { return tip(x, lever) - kSquareness * (x - kSpindle); }

struct Read {
  std::map<double, double> points;
  std::map<std::string, double> values;
};

/// The lines of a table without its comments.
std::vector<std::string> lines_of(const std::string& text, const std::string& mark) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (!line.starts_with(mark)) lines.push_back(line);
  return lines;
}

Read read_isg(const std::string& text) {
  Read out;
  std::string header;
  for (const std::string& line : lines_of(text, "//")) {
    std::istringstream fields(line);
    double x = 0.0, value = 0.0;
    if (line == "#" || line == "B0X" || line == "X\tEZX")
      header = line;
    else if (header == "B0X" && fields >> value)
      out.values["B0X"] = value;
    else if (header == "X\tEZX" && fields >> x >> value)
      out.points[x] = value;
    else
      ADD_FAILURE() << line;
  }
  return out;
}

Read read_etalon(const std::string& text) {
  Read out;
  std::string block;
  for (const std::string& line : lines_of(text, "//")) {
    std::istringstream fields(line);
    double x = 0.0, value = 0.0;
    if (line.starts_with("["))
      block = line.substr(1, 3);
    else if (line.starts_with("VALUE = "))
      out.values[block] = std::stod(line.substr(8));
    else if (fields >> x >> value)
      out.points[x] = value;
    else
      EXPECT_THAT(line, testing::AnyOf("Gridpoints = {", "}"));
  }
  return out;
}

Read read_cec(const std::string& text) {
  Read out;
  std::vector<double> values;
  for (const std::string& line : lines_of(text, ";")) {
    const std::size_t equals = line.find('=');
    if (line.starts_with("$AN_CEC[0,")) {
      EXPECT_EQ(line.substr(10, line.find(']') - 10), std::to_string(values.size()));
      values.push_back(std::stod(line.substr(equals + 1)));
    } else if (line.starts_with("$AN_CEC_") && line[equals + 1] != '(') {
      out.values[line.substr(8, equals - 11)] = std::stod(line.substr(equals + 1));
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    out.points[out.values["MIN"] + static_cast<double>(i) * out.values["STEP"]] = values[i];
  EXPECT_NEAR(out.points.rbegin()->first, out.values["MAX"], 1e-6);
  return out;
}

/// As pyLSV2 reads the tables of these controls (its table_reader.py): "BEGIN NAME.SUFFIX MM", then
/// the names of the columns, each as wide as its name and the blanks behind it, rows, "[END]".
Read read_heidenhain(const std::string& text) {
  Read out;
  std::istringstream stream(text);
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "BEGIN SLIDEWAY.COM MM");
  std::getline(stream, line);
  std::map<std::string, std::pair<std::size_t, std::size_t>> columns;  // from, width
  for (std::size_t from = 0, next = 0; from < line.size(); from = next) {
    const std::size_t blank = line.find(' ', from);
    next = std::min(line.find_first_not_of(' ', blank), line.size());
    columns[line.substr(from, blank - from)] = {from, next - from};
  }
  EXPECT_THAT(columns, testing::SizeIs(3));
  while (std::getline(stream, line) && line != "[END]") {
    const auto cell = [&](const std::string& name) {
      const auto [from, width] = columns.at(name);
      std::string text_of_cell = line.substr(from, width);
      EXPECT_EQ(text_of_cell.back(), ' ') << "runs into the next column: " << line;
      text_of_cell.erase(text_of_cell.find_last_not_of(' ') + 1);
      return text_of_cell;
    };
    EXPECT_EQ(cell("BACKLASH"), "");
    out.points[std::stod(cell("AXISPOS"))] = std::stod(cell("Z"));
  }
  EXPECT_EQ(line, "[END]");
  EXPECT_FALSE(std::getline(stream, line));
  return out;
}

/// The table is the model's height of the tool tip up to a constant; lever is p_x at a slide x.
template <typename LeverAt>
void expect_model(const std::map<double, double>& points, double squareness, double sign,
                  LeverAt&& lever, double written = kWritten) {
  ASSERT_EQ(points.size(), 51U);
  const auto error = [&](const auto& point) {
    return sign * point.second - squareness * point.first - height(point.first, lever(point.first));
  };
  const double constant = error(*points.begin());
  for (const auto& point : points)
    EXPECT_NEAR(error(point), constant, written * (1.0 + std::abs(point.first))) << point.first;
}

TEST(Compensation, TablesAddUpToTheModelsHeightOfTheToolTip) {
  for (const auto& [lever, overhang] :
       {std::pair{Lever::split, 0.0}, std::pair{Lever::split, 150.0},
        std::pair{Lever::paper, 0.0}}) {
    SCOPED_TRACE(std::string(text_of(lever)) + " " + std::to_string(overhang));
    const bool paper = lever == Lever::paper;
    const auto at = [&, overhang = overhang](double x) { return paper ? x - kSpindle : overhang; };
    const Compensation table = compensation(analysis(lever, overhang));
    const Read isg = read_isg(compensation_table(table, "isg", "test"));
    expect_model(isg.points, isg.values.at("B0X"), 1.0, at);
    const Read etalon = read_etalon(compensation_table(table, "etalon", "test"));
    expect_model(etalon.points, etalon.values.at("B0X"), 1.0, at);
    // A correction is minus the error, squareness included.
    expect_model(read_cec(compensation_table(table, "cec", "test")).points, 0.0, -1.0, at);
    // An error, with nine decimals of a millimetre.
    expect_model(read_heidenhain(compensation_table(table, "heidenhain", "test")).points, 0.0, 1.0,
                 at, 1e-9);
  }
}

TEST(Compensation, StraightnessIsZeroAtBothEndsOfTheReferenceLine) {
  const Compensation table = compensation(analysis(Lever::split), 7.0);
  EXPECT_EQ(table.positions_mm.front(), 20.0);
  EXPECT_EQ(table.positions_mm.back(), 620.0);
  EXPECT_EQ(table.positions_mm.size(), 87U);  // ceil(600 / 7) pieces
  EXPECT_EQ(table.straightness_mm.front(), 0.0);
  EXPECT_EQ(table.straightness_mm.back(), 0.0);
}

TEST(Compensation, IsOfTheCarriageWhereTheSlideItselfWasRead) {
  Analysis slide = analysis(Lever::paper);
  slide.result.travel->spindle_position_mm.reset();
  std::erase_if(slide.result.final->parameters,
                [](const auto& p) { return p.name.starts_with("squareness"); });
  const Compensation table = compensation(slide);
  const StraightnessCurve& form = slide.result.final->straightness->curve;
  for (std::size_t i = 1; i < 50; ++i)  // every fourth point of the form
    EXPECT_NEAR(table.straightness_mm[i], form.deviation_um[4 * i] * 1e-3, kWritten);
}

TEST(Compensation, GivesTheUncertaintyOfTheReportAtEachPosition) {
  const Compensation table = compensation(analysis(Lever::split));
  ASSERT_EQ(table.straightness_U_mm.size(), 51U);
  EXPECT_NEAR(table.straightness_U_mm[25], 0.25e-3, kWritten);  // share (1 - share) in the middle
  EXPECT_NEAR(table.straightness_U_mm.front(), 0.0, kWritten);
  for (const char* format : {"isg", "etalon", "cec"})
    EXPECT_THAT(compensation_table(table, format, "test"), HasSubstr("320.000000 0.25\n"));
}

TEST(Compensation, LeavesOutWhatIsNotDetermined) {
  Analysis given = analysis(Lever::split);
  given.result.final->straightness->curve.tip_slope_rad.reset();
  const Compensation no_squareness = compensation(given);
  EXPECT_FALSE(no_squareness.squareness_rad);
  EXPECT_THAT(no_squareness.left_out,
              Contains(HasSubstr("B0X is left out: the data do not determine the slope")));
  EXPECT_THAT(compensation_table(no_squareness, "cec", "test"), HasSubstr("; B0X is left out"));

  given.result.final->straightness = Straightness{};
  given.result.final->straightness->reason = "told by no one";
  const Compensation no_straightness = compensation(given);
  EXPECT_TRUE(no_straightness.straightness_mm.empty());
  EXPECT_THAT(no_straightness.left_out, Contains(HasSubstr("told by no one")));
  EXPECT_EQ(*no_straightness.squareness_rad, kSquareness);
  const Read cone = read_cec(compensation_table(no_straightness, "cec", "test"));
  EXPECT_NEAR(cone.points.rbegin()->second, kSquareness * 600.0, kWritten);

  parameter(given, "squareness.dbeta_xz").value.reset();
  EXPECT_THROW(compensation(given), DataError);
}

TEST(Compensation, TablesAreAscii) {
  for (const std::string& format : compensation_formats()) {
    const std::string text =
        compensation_table(compensation(analysis(Lever::split)), format, "Fläche\n");
    EXPECT_TRUE(std::ranges::all_of(text, [](char c) {
      return c == '\n' || c == '\t' || (c >= ' ' && c <= '~');
    })) << text;
  }
}

TEST(Compensation, SaysBesideATableWithoutCommentsWhatItsValuesAre) {
  const Compensation table = compensation(analysis(Lever::split));
  EXPECT_EQ(compensation_notes(table, "isg", "test"), table.left_out);
  const std::vector<std::string> notes = compensation_notes(table, "heidenhain", "test");
  EXPECT_EQ(notes.front(), "test");
  for (const char* said : {"Values are errors: actual minus nominal", "AXISPOS: X from the machine",
                           "Z = F(X)", "second face", "B0X: squareness", "mm"})
    EXPECT_THAT(notes, Contains(HasSubstr(said)));
}

TEST(Compensation, RefusesMoreRowsThanAComTableTakes) {
  // 256 entries: TNC 407/415/425, Technical Manual, error 3 of module 9095.
  const std::string full =
      compensation_table(compensation(analysis(Lever::split), 600.0 / 255.0), "heidenhain", "test");
  EXPECT_THAT(read_heidenhain(full).points, testing::SizeIs(256));
  const Compensation fine = compensation(analysis(Lever::split), 600.0 / 256.0);
  try {
    compensation_table(fine, "heidenhain", "test");
    ADD_FAILURE() << "written with 257 rows";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("257 positions, a .COM table takes 256; accepted: 2.353 mm"));
  }
}

TEST(Compensation, LeavesOutASquarenessTheRunOutContradicts) {
  Analysis given = analysis(Lever::split);
  given.result.crosscheck.squareness.emplace();
  given.result.crosscheck.squareness->verdict = Consistency::inconsistent;
  EXPECT_FALSE(compensation(given).squareness_rad);
}

TEST(Compensation, LeavesOutStraightnessAcrossOverhangs) {
  Analysis given = analysis(Lever::split);
  given.result.final->straightness->curve.tip_um.clear();
  EXPECT_TRUE(compensation(given).straightness_mm.empty());
}

TEST(Compensation, RefusesWhatTheLoopDoubts) {
  Analysis given = analysis(Lever::split);
  given.trace.emplace();
  given.trace->verdict = TraceVerdict::not_identifiable;
  EXPECT_THROW(compensation(given), DataError);

  given.trace->verdict = TraceVerdict::unnamed;
  Unnamed left;
  left.rms_um = 0.01;
  given.trace->unnamed = left;
  EXPECT_EQ(compensation(given).straightness_mm.size(), 51U);
  given.trace->unnamed->rms_um = 100.0;
  EXPECT_THROW(compensation(given), DataError);

  given.trace->unnamed.reset();
  given.trace->verdict = TraceVerdict::ambiguous;
  EXPECT_THAT(compensation(given).left_out, Contains(HasSubstr("ambiguous")));
}

TEST(Compensation, TakesAnEffectOfOneProfileForNoSecondCarriage) {
  Analysis given = analysis(Lever::split);
  given.result.final->parameters.push_back(
      fitted("thermal_drift[fine].amplitude_um", "A", "µm", 1.0, 0.01));
  EXPECT_FALSE(compensation(given).straightness_mm.empty());
  given.result.final->parameters.push_back(
      fitted("straightness[upper].b2", "b_2", "mm^-1", 1e-7, 1e-9));
  EXPECT_THROW(compensation(given), DataError);
}

TEST(Compensation, RefusesWhatItCanNotTable) {
  EXPECT_THROW(compensation(Analysis{}), DataError);
  EXPECT_THROW(compensation(analysis(Lever::split), -1.0), UsageError);
  EXPECT_THROW(compensation(analysis(Lever::split), 1e-9), UsageError);
  EXPECT_THROW(compensation(analysis(Lever::split), std::nan("")), UsageError);
  Analysis point = analysis(Lever::split);
  point.result.travel->slide_max_mm = point.result.travel->slide_min_mm;
  EXPECT_THROW(compensation(point), DataError);
  EXPECT_THROW(check_compensation_format("isgg"), UsageError);
}

}  // namespace
}  // namespace slideway::compensation_test
