#include "slideway/identify/fault.hpp"

#include <gtest/gtest.h>

#include "base/temporary_folder.hpp"

namespace slideway {
namespace {

/// What is marked of the only line of a file.
std::string marked(const std::string& line, const std::string& key, bool is_of_key = false) {
  const TemporaryFolder folder;
  const auto excerpt =
      excerpt_of({"wrong", folder.file("problem.toml", line + "\n").string(), 1, key, is_of_key});
  return excerpt ? excerpt->line.substr(excerpt->first, excerpt->count) : "none";
}

TEST(Excerpt, MarksTheValueOfAKeyOrTheKeyItself) {
  EXPECT_EQ(marked("feed = 2.0", "feed"), "2.0");
  EXPECT_EQ(marked("feed = 2.0", "feed", true), "feed");
  EXPECT_EQ(marked("  \"feed\" = 2.0  # fast", "feed"), "2.0");
  EXPECT_EQ(marked("name = \"a # b\"  # c", "name"), "\"a # b\"");
  EXPECT_EQ(marked("feed =", "feed"), "feed");
}

TEST(Excerpt, MarksTheWholeLineWithoutAKey) {
  EXPECT_EQ(marked("  [[profile]]  # first", ""), "[[profile]]");
  EXPECT_EQ(marked("[[profile]]", "feed"), "[[profile]]");
}

TEST(Excerpt, CountsCharactersNotBytes) {
  const TemporaryFolder folder;
  const auto excerpt =
      excerpt_of({"", folder.file("problem.toml", "\"höhe\" = \"größe\"\n").string(), 1, "höhe"});
  ASSERT_TRUE(excerpt);
  EXPECT_EQ(excerpt->first, 9U);
  EXPECT_EQ(excerpt->count, 7U);
}

TEST(Excerpt, IsNoneWithoutALine) {
  const TemporaryFolder folder;
  const std::string path = folder.file("problem.toml", "a = 1\n").string();
  EXPECT_TRUE(excerpt_of({"", path, 1}));
  EXPECT_FALSE(excerpt_of({"", path, 0}));
  EXPECT_FALSE(excerpt_of({"", path, 7}));
  EXPECT_FALSE(excerpt_of({"", path + "x", 1}));
  EXPECT_FALSE(excerpt_of({"", "", 1}));
}

}  // namespace
}  // namespace slideway
