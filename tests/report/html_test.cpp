#include "html.hpp"

#include <gtest/gtest.h>

namespace slideway::html_test {
namespace {

TEST(Html, EscapesEveryTextAndAttribute) {
  const std::string evil = "<b>\"&'\x01";
  EXPECT_EQ(Html(evil).markup(), "&lt;b&gt;&quot;&amp;&#39;\xEF\xBF\xBD");
  EXPECT_EQ(element("i", {{"title", evil}}, evil).markup(),
            "<i title=\"&lt;b&gt;&quot;&amp;&#39;\xEF\xBF\xBD\">&lt;b&gt;&quot;&amp;&#39;"
            "\xEF\xBF\xBD</i>");
}

TEST(Html, NestsElementsWithoutEscapingThemAgain) {
  EXPECT_EQ(element("td", "x < " + element("sup", "−4")).markup(), "<td>x &lt; <sup>−4</sup></td>");
}

TEST(Html, ClosesWhatHoldsNothing) {
  EXPECT_EQ(element("br").markup(), "<br/>");
  EXPECT_EQ(element("td").markup(), "<td></td>");
}

TEST(Html, JoinsPieces) {
  EXPECT_EQ(joined({Html("a"), Html("b")}, element("br")).markup(), "a<br/>b");
  EXPECT_TRUE(joined({}, ", ").empty());
}

}  // namespace
}  // namespace slideway::html_test
