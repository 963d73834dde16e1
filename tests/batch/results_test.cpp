#include "slideway/batch/results.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "base/temporary_folder.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/batch/pool.hpp"

namespace slideway::results_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string line(const std::string& id, const std::string& status = "ok",
                 const std::string& more = "") {
  return R"({"id":")" + id + R"(","status":")" + status +
         R"(","reason":null,"input_sha256":"12","options_hash":"34","version":"0.1.0",)"
         R"("evidence":null,"report":{"more":")" +
         more + "\"}}\n";
}

class Results : public testing::Test {
 protected:
  std::vector<std::string> ids(const std::filesystem::path& path, std::size_t* torn = nullptr) {
    std::vector<std::string> out;
    const std::size_t left_out = read_results(
        path, [&](const ResultHead& head, std::string_view) { out.push_back(head.id); });
    if (torn != nullptr) *torn = left_out;
    return out;
  }
  static std::string text(const std::filesystem::path& path) {
    return std::string(FileBytes(path).text());
  }
  template <typename Call>
  static std::string refusal(const Call& call) {
    try {
      call();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }
  TemporaryFolder folder_;
};

TEST_F(Results, WholeLinesAreReadAndTornOnesCounted) {
  const std::string whole = line("a") + line("b"), last = line("c");
  for (std::size_t size = 0; size < last.size(); ++size) {
    std::size_t torn = 9;
    EXPECT_THAT(ids(folder_.file("r", whole + last.substr(0, size)), &torn), ElementsAre("a", "b"));
    EXPECT_EQ(torn, size > 0 ? 1U : 0U) << size;
  }
}

TEST_F(Results, ALineWithoutStatusIsTorn) {
  std::string without = line("a");
  without.replace(without.find(R"("ok")"), 4, "null");
  std::size_t torn = 0;
  EXPECT_THAT(ids(folder_.file("r", without + line("b")), &torn), ElementsAre("b"));
  EXPECT_EQ(torn, 1U);
}

// Found by the fuzz target `results`: the JSON library's own error left the program.
TEST_F(Results, DamagedEvidenceIsRefusedWithItsId) {
  const Manifest manifest = parse_manifest("id,problem,machine\na,p.toml,M\n", "m.csv");
  for (const char* evidence :
       {"null", "{}", "3", R"({"parameters":{},"units":[],"rows":[],"values":[]})",
        R"({"parameters":["p"],"units":["m"],"rows":[[1,2]],"values":[1]})",
        R"({"parameters":["p"],"units":["m"],"rows":[[null]],"values":[1]})",
        R"({"parameters":["p"],"units":["m"],"rows":[[1]],"values":["x"]})",
        R"({"parameters":["p"],"units":["m"],"rows":[[1]],"values":[1e300]})"}) {
    std::string damaged = line("a");
    damaged.replace(damaged.find(R"("evidence":null)"), 15,
                    R"("evidence":)" + std::string(evidence));
    const auto path = folder_.file("r", damaged);
    EXPECT_EQ(refusal([&] { pool_machines(manifest, path); }),
              path.string() + ": id 'a': its evidence is damaged")
        << evidence;
  }
}

// Workers write their lines in the order in which they are ready.
TEST_F(Results, MachinesAreTheSameInAnyOrderOfTheLines) {
  const auto of = [](const std::string& id, const std::string& machine, const std::string& time) {
    std::string out = line(id);
    const std::string none = R"("evidence":null)";
    out.replace(out.find(none), none.size(),
                R"("machine":")" + machine + R"(","time":")" + time +
                    R"(","evidence":{"parameters":["squareness.dbeta_xz"],"units":["rad"],)"
                    R"("rows":[[1]],"values":[2]})");
    return out;
  };
  std::vector<std::string> lines{of("a", "N", "2026-01-09"), of("b", "M", "2026-01-11"),
                                 of("c", "M", "7"), of("d", "N", "2026-01-01")};
  std::ranges::sort(lines);
  do {
    std::string told;
    const PooledResults pooled =
        pool_machines(folder_.file("r", lines[0] + lines[1] + lines[2] + lines[3]));
    for (const PooledMachine& machine : pooled.machines) {
      told += machine.machine + ":";
      for (const PooledItem& item : machine.items) told += " " + item.id;
      told += "; ";
    }
    EXPECT_EQ(told, "M: c b; N: d a; ");  // no time, then by time
    EXPECT_TRUE(pooled.are_dates);
  } while (std::ranges::next_permutation(lines).found);
}

TEST_F(Results, WhatLooksLikeAnEndInATextIsNone) {
  const auto path = folder_.file("r", line(R"(x\",\"evidence\":)"));
  EXPECT_THAT(ids(path), ElementsAre("x\",\"evidence\":"));
}

TEST_F(Results, LinesOfOtherKindsAreTorn) {
  std::size_t torn = 0;
  EXPECT_THAT(
      ids(folder_.file("r", "\n{}\n[1]\nnull\n{\"id\":\"a\"}\n" + line("") + line("b")), &torn),
      ElementsAre("b"));
  EXPECT_EQ(torn, 6U);
}

TEST_F(Results, KeepDropsTornUnwantedAndRepeatedLines) {
  const auto path = folder_.file("r", line("a") + line("b", "timeout") + line("a") + "{\"id\":\"c");
  ResultsFile file(path);
  file.keep([](const ResultHead& head) { return head.status == "ok"; });
  file.append(line("b"));
  EXPECT_EQ(text(path), line("a") + line("b"));
}

TEST_F(Results, TwoRunsDoNotWriteOneFile) {
  const ResultsFile first(folder_.path() / "r");
  EXPECT_THAT(refusal([&] { const ResultsFile second(folder_.path() / "r"); }),
              HasSubstr("another run is writing it"));
}

TEST_F(Results, MergeIsSortedAndTheSameForEveryPartition) {
  const auto one = folder_.file("one", line("c") + line("a"));
  const auto two = folder_.file("two", line("b"));
  const auto other = folder_.file("other", line("b") + line("a") + line("c") + "{\"id");
  const MergeSummary summary = merge_results(folder_.path() / "out", {one, two});
  EXPECT_EQ(summary.lines, 3U);
  EXPECT_EQ(text(folder_.path() / "out"), line("a") + line("b") + line("c"));
  EXPECT_EQ(merge_results(folder_.path() / "out2", {other}).torn, 1U);
  EXPECT_EQ(text(folder_.path() / "out2"), text(folder_.path() / "out"));
}

TEST_F(Results, MergePrefersWhatWentWellAndRefusesTwoTruths) {
  const auto one = folder_.file("one", line("a", "timeout") + line("b"));
  const auto two = folder_.file("two", line("a") + line("b"));
  EXPECT_EQ(merge_results(folder_.path() / "out", {one, two}).repeated, 2U);
  EXPECT_EQ(text(folder_.path() / "out"), line("a") + line("b"));
  const auto three = folder_.file("three", line("b", "ok", "else"));
  EXPECT_THAT(refusal([&] {
                merge_results(folder_.path() / "out3", {one, three});
              }),
              HasSubstr("id 'b' has one result in"));
  EXPECT_FALSE(exists(folder_.path() / "out3"));
}

TEST_F(Results, VerifyWantsEveryIdOnce) {
  const Manifest manifest = parse_manifest("id,problem\na,p\nb,p\nc,p\n", "m.csv");
  const auto verified = [&](const std::string& contents) {
    return verify_results(manifest, {}, folder_.file("r", contents));
  };
  EXPECT_EQ(verified(line("b") + line("a") + line("c", "timeout")),
            (StatusCounts{{"ok", 2}, {"timeout", 1}}));
  EXPECT_THAT(refusal([&] { verified(line("a") + line("c")); }),
              HasSubstr("3 ids expected, each once; 1 missing (first 'b')"));
  EXPECT_THAT(refusal([&] { verified(line("a") + line("c") + line("b") + line("c")); }),
              HasSubstr("1 more than once (first 'c')"));
  EXPECT_THAT(refusal([&] { verified(line("a") + line("c") + line("b") + line("d")); }),
              HasSubstr("1 not in the manifest (first 'd')"));
  EXPECT_THAT(refusal([&] { verified(line("a") + line("c") + line("b") + "{"); }),
              HasSubstr("1 torn line"));
}

}  // namespace
}  // namespace slideway::results_test
