#include "html_plot.hpp"

#include <gmock/gmock.h>

#include "slideway/base/error.hpp"

namespace slideway::html_plot_test {
namespace {

using testing::HasSubstr;
using testing::Not;

Plot plot() { return Plot({"id", "A <title>", "What it shows", "x, mm", "y, µm"}); }

TEST(Plot, IsNamedAndDescribedForAScreenReader) {
  const std::string svg = plot().line("one", "after", {0, 1}, {0, 1}).svg().markup();
  EXPECT_THAT(svg, HasSubstr("<svg role=\"img\" aria-labelledby=\"id-t id-d\""));
  EXPECT_THAT(svg, HasSubstr("<title id=\"id-t\">A &lt;title&gt;</title>"));
  EXPECT_THAT(svg, HasSubstr("<desc id=\"id-d\">What it shows</desc>"));
}

TEST(Plot, DrawsALineFromCornerToCorner) {
  // 720 by 300: the frame goes from 62 to 698; 4 % of margin above and below.
  const std::string svg = plot().line("one", "after", {0, 10}, {0, 1}).svg().markup();
  EXPECT_THAT(svg, HasSubstr("<polyline class=\"after\" points=\"62.0,"));
  EXPECT_THAT(svg, HasSubstr(" 698.0,"));
}

TEST(Plot, KeepsTheExtremesOfALongLine) {
  std::vector<double> x(100000), y(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i);
  y[54321] = 1.0;
  const std::string svg = plot().line("one", "after", x, y).svg().markup();
  EXPECT_LT(svg.size(), 30000U);
  // The margin is 4 % of the range at both ends: the spike stands 1/27 below the top.
  const double top = 6.0 + 16.0, bottom = 260.0;
  const double spike = bottom - (bottom - top) * 1.04 / 1.08;
  EXPECT_THAT(svg, HasSubstr(std::string(",").append(std::to_string(static_cast<int>(spike)))));
}

TEST(Plot, IsDrawnForAConstantAndForASinglePoint) {
  EXPECT_THAT(plot().line("one", "after", {0, 1}, {5, 5}).svg().markup(), Not(HasSubstr("nan")));
  EXPECT_THAT(plot().line("one", "after", {3}, {5}).svg().markup(), Not(HasSubstr("nan")));
  EXPECT_THAT(plot().log_x().log_y().line("one", "after", {0, 1}, {0, 0}).svg().markup(),
              Not(HasSubstr("nan")));
}

TEST(Plot, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW((void)plot().line("one", "after", {0, 1}, {0}), DataError);
  EXPECT_THROW((void)plot().line("one", "after", {0, 1}, {-1.7e308, 1.7e308}).svg(), DataError);
}

}  // namespace
}  // namespace slideway::html_plot_test
