#include "slideway/format/rows.hpp"

#include <gmock/gmock.h>

#include "slideway/base/error.hpp"

namespace slideway::rows_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal(std::string_view bytes) {
  try {
    parse_rows(bytes);
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(Rows, StandUnderTheNamesOfTheHeader) {
  const TextRows text = parse_rows("# made by hand\nid, problem\n\na,b.toml\n  c , d e.toml \n");
  EXPECT_EQ(text.line, 2U);
  EXPECT_THAT(text.names, ElementsAre("id", "problem"));
  ASSERT_EQ(text.rows.size(), 2U);
  EXPECT_EQ(text.rows[0].line, 4U);
  EXPECT_THAT(text.rows[0].fields, ElementsAre("a", "b.toml"));
  EXPECT_THAT(text.rows[1].fields, ElementsAre("c", "d e.toml"));
}

TEST(Rows, AreTheSameInEveryDialect) {
  const std::string_view utf16("\xff\xfei\0d\0;\0p\0\n\0a\0;\0\xb5\0\n\0", 20);
  for (const std::string_view bytes :
       {std::string_view("id,p\r\na,\u00b5\r\n"), std::string_view("id;p\na;\u00b5"),
        std::string_view("id\tp\na\t\u00b5\n"), std::string_view("\xef\xbb\xbfid,p\na,\u00b5,\n"),
        std::string_view("id,p\na,\xb5\n"), utf16}) {
    const TextRows text = parse_rows(bytes);
    EXPECT_THAT(text.names, ElementsAre("id", "p"));
    ASSERT_EQ(text.rows.size(), 1U);
    EXPECT_THAT(text.rows[0].fields, ElementsAre("a", "\u00b5"));
  }
}

TEST(Rows, QuotesHoldDelimitersAndQuotes) {
  const TextRows text = parse_rows("a,b\n\"x,y\",\"[\"\"offset\"\", \"\"tilt\"\"]\"\n");
  EXPECT_THAT(text.rows[0].fields, ElementsAre("x,y", "[\"offset\", \"tilt\"]"));
}

TEST(Rows, MayBeShort) {
  EXPECT_THAT(parse_rows("a,b,c\n1\n").rows[0].fields, ElementsAre("1", "", ""));
}

TEST(Rows, AreRefusedByLine) {
  EXPECT_THAT(refusal("a,b\n1,2,3\n"), HasSubstr("line 2: 3 fields, but 2 columns"));
  EXPECT_THAT(refusal("a,a\n"), HasSubstr("line 1: column 'a' is there twice"));
  EXPECT_THAT(refusal("a,,c\n"), HasSubstr("line 1: column 2 has no name"));
  EXPECT_THAT(refusal("a,b\n1,\"2\n"), HasSubstr("line 2: double quotes that do not end"));
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("holds no header line"));
}

}  // namespace
}  // namespace slideway::rows_test
