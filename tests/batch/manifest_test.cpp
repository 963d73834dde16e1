#include "slideway/batch/manifest.hpp"

#include <gmock/gmock.h>

#include "slideway/base/error.hpp"

namespace slideway::manifest_test {
namespace {

using testing::HasSubstr;

Manifest parsed(std::string_view text) { return parse_manifest(text, "shop/list.csv"); }

std::string refusal(std::string_view text) {
  try {
    parsed(text);
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(Manifest, HasAnItemALine) {
  const Manifest manifest = parsed(
      "id,problem,profile.feed2.file,low_band.level,machine,time\n"
      "a,p.toml,a.csv,,M1,2026-11-21\n"
      "b,sub/p.toml,\"b,2.csv\",4,,\n");
  ASSERT_EQ(manifest.items.size(), 2U);
  const ManifestItem& a = manifest.items[0];
  const ManifestItem& b = manifest.items[1];
  EXPECT_EQ(a.id, "a");
  EXPECT_EQ(a.line, 2U);
  EXPECT_EQ(a.problem, "shop/p.toml");
  EXPECT_EQ(a.machine, "M1");
  EXPECT_EQ(a.time, "2026-11-21");
  ASSERT_EQ(a.overrides.size(), 1U);
  EXPECT_EQ(a.overrides[0].key, "profile.feed2.file");
  ASSERT_EQ(b.overrides.size(), 2U);
  EXPECT_EQ(b.overrides[0].value, "b,2.csv");
  EXPECT_EQ(b.overrides[1].value, "4");
}

TEST(Manifest, ProblemIsTheIdWhereThereIsNone) {
  EXPECT_EQ(parsed("problem\nx/p.toml\n").items[0].id, "x/p.toml");
}

TEST(Manifest, IsRefusedByLine) {
  EXPECT_THAT(refusal("id,problem\na,p\na,q\n"), HasSubstr("line 3: id 'a' is that of line 2"));
  EXPECT_THAT(refusal("problem\np\np\n"), HasSubstr("give a column 'id'"));
  EXPECT_THAT(refusal("id,problm\na,p\n"),
              HasSubstr("line 1: unknown column 'problm' (did you mean 'problem'?); accepted: id"));
  EXPECT_THAT(refusal("id,low_band.level\na,3\n"), HasSubstr("no column 'problem'"));
  EXPECT_THAT(refusal("id,problem\n,p\n"), HasSubstr("line 2: column 'id' is empty"));
  EXPECT_THAT(refusal("id,problem\na\n"), HasSubstr("line 2: column 'problem' is empty"));
  EXPECT_THAT(refusal("id,problem\na\x1b[2J,p\n"), HasSubstr("holds control characters"));
  EXPECT_THAT(refusal("id,problem\n"), HasSubstr("lists no problems"));
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
}

// int(sha256sum(id)[:16], 16) % n + 1, by Python's hashlib.
TEST(Shard, IsTheHashOfTheId) {
  EXPECT_TRUE((Shard{5, 7}.holds("a")));
  EXPECT_TRUE((Shard{2, 3}.holds("b")));
  EXPECT_TRUE((Shard{3, 7}.holds("face-1")));
}

TEST(Shard, EveryIdIsInOneAndShardsAreEven) {
  constexpr std::size_t kShards = 7, kIds = 7000;
  std::vector<std::size_t> sizes(kShards);
  for (std::size_t i = 0; i < kIds; ++i) {
    int holders = 0;
    for (std::size_t s = 1; s <= kShards; ++s)
      if (Shard{s, kShards}.holds("item" + std::to_string(i))) ++holders, ++sizes[s - 1];
    ASSERT_EQ(holders, 1) << i;
  }
  // Binomial, mean 1000, standard deviation 29: five of them.
  for (const std::size_t size : sizes) EXPECT_NEAR(static_cast<double>(size), 1000.0, 146.0);
}

}  // namespace
}  // namespace slideway::manifest_test
