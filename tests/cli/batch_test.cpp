#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>

#include "cli/bad_input.hpp"
#include "slideway/base/sanitizer.hpp"

namespace slideway::batch_test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using Json = nlohmann::ordered_json;

std::vector<std::string> sorted(std::vector<std::string> lines) {
  std::sort(lines.begin(), lines.end());
  return lines;
}

/// Every member of a brief report is that of the whole one, to its digits.
void expect_part_of(const Json& whole, const Json& brief, const std::string& place) {
  constexpr double kRounding = 5e-3;  // three digits
  if (whole.is_number_float()) {
    const double value = whole.get<double>();
    EXPECT_NEAR(brief.get<double>(), value, kRounding * std::abs(value)) << place;
  } else if (brief.is_structured()) {
    if (brief.is_array()) {
      ASSERT_EQ(brief.size(), whole.size()) << place;
    }
    for (const auto& [key, value] : brief.items()) {
      const Json::json_pointer at("/" + key);
      ASSERT_TRUE(whole.contains(at)) << place << "." << key;
      expect_part_of(whole.at(at), value, place + "." + key);
    }
  } else if (!place.ends_with(".schema")) {
    EXPECT_EQ(brief, whole) << place;
  }
}

/// One problem and faces that differ; each item has a face of its own.
class Batch : public ProgramTest {
 protected:
  static constexpr int kFaces = 12;

  Batch() {
    folder_.file("problem.toml", ProblemText{}.text());
    std::string manifest = "id,problem,profile.face.file\n";
    for (int i = 0; i < kFaces; ++i) {
      const std::string name = "face" + std::to_string(i);
      folder_.file(name + ".csv", face_csv(64 + i));
      manifest += name + ",problem.toml," + name + ".csv\n";
    }
    folder_.file("list.csv", manifest);
  }

  [[nodiscard]] ProgramRun batch(const std::string& out,
                                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"batch", "list.csv", "--out", out, "--no-trace"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  [[nodiscard]] std::vector<std::string> lines(const std::string& out) const {
    return sorted(lines_of(contents(path(out))));
  }
  /// Adds lines to the manifest.
  void add(const std::string& more) const {
    folder_.file("list.csv", contents(path("list.csv")) + more);
  }
  [[nodiscard]] Json result(const std::string& out, const std::string& id) const {
    for (const std::string& line : lines(out)) {
      Json json = Json::parse(line);
      if (json["id"] == id) return json;
    }
    return nullptr;
  }

  [[nodiscard]] Json alone() const { return Json::parse(contents(path("alone.json"))); }
};

// 1e6 samples take 16 MB as numbers alone; the program keeps a heap of 1 GB for itself.
TEST_F(Batch, AnItemBeyondTheMemoryFailsAlone) {
  if (kHasShadow) GTEST_SKIP() << "memory is not limited under a sanitizer";
  folder_.file("large.csv", face_csv(1'000'000));
  add("large,problem.toml,large.csv\n");
  EXPECT_EQ(batch("out.jsonl", {"--jobs", "1", "--memory", "12"}).exit_code, 5);
  EXPECT_EQ(result("out.jsonl", "large")["status"], "out_of_memory");
  EXPECT_EQ(result("out.jsonl", "face3")["status"], "ok");
}

TEST_F(Batch, EveryReportIsThatOfIdentifyAlone) {
  const ProgramRun done = batch("out.jsonl");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("12 items in out.jsonl: 12 ok, 0 failed"));
  for (int i = 0; i < kFaces; ++i) {
    const std::string name = "face" + std::to_string(i);
    folder_.file("alone.toml", ProblemText{.file = name + ".csv"}.text());
    ASSERT_EQ(run({"identify", "alone.toml", "--no-trace", "--json", "alone.json"}).exit_code, 0);
    const Json line = result("out.jsonl", name);
    EXPECT_EQ(line["status"], "ok");
    EXPECT_TRUE(line["reason"].is_null());
    expect_part_of(alone(), line["report"], name);
  }
}

TEST_F(Batch, TheLoopIsInTheReportUnlessItIsLeftOut) {
  folder_.file("list.csv", "problem\nproblem.toml\n");
  folder_.file("face.csv", face_csv(64));
  ASSERT_EQ(run({"batch", "list.csv", "--out", "out.jsonl"}).exit_code, 0);
  ASSERT_EQ(run({"identify", "problem.toml", "--json", "alone.json"}).exit_code, 0);
  const Json line = result("out.jsonl", "problem.toml");
  expect_part_of(alone(), line["report"], "report");
  EXPECT_TRUE(line["report"]["trace"].is_object());
}

TEST_F(Batch, WholeReportsAreThoseOfIdentify) {
  folder_.file("list.csv", "problem\nproblem.toml\n");
  folder_.file("face.csv", face_csv(64));
  ASSERT_EQ(batch("out.jsonl", {"--full"}).exit_code, 0);
  const ProgramRun identify =
      run({"identify", "problem.toml", "--no-trace", "--curves", "--json", "alone.json"});
  ASSERT_EQ(identify.exit_code, 0) << identify.err;
  EXPECT_EQ(result("out.jsonl", "problem.toml")["report"], alone());
}

TEST_F(Batch, ALineIsShort) {
  ASSERT_EQ(batch("out.jsonl").exit_code, 0);
  for (const std::string& line : lines("out.jsonl")) EXPECT_LT(line.size(), 2500U) << line;
}

TEST_F(Batch, BytesAreTheSameForAnyNumberOfJobsAndShards) {
  ASSERT_EQ(batch("one.jsonl", {"--jobs", "1"}).exit_code, 0);
  ASSERT_EQ(batch("five.jsonl", {"--jobs", "5"}).exit_code, 0);
  EXPECT_EQ(lines("five.jsonl"), lines("one.jsonl"));
  std::vector<std::string> merge{"batch", "merge", "merged.jsonl"};
  for (const char* shard : {"1/3", "2/3", "3/3"}) {
    merge.push_back("part" + std::string(1, shard[0]) + ".jsonl");
    ASSERT_EQ(batch(merge.back(), {"--shard", shard}).exit_code, 0);
    EXPECT_EQ(run({"batch", "verify", "list.csv", merge.back(), "--shard", shard}).exit_code, 0);
  }
  ASSERT_EQ(run(merge).exit_code, 0);
  EXPECT_EQ(lines_of(contents(path("merged.jsonl"))), lines("one.jsonl"));
  EXPECT_EQ(run({"batch", "verify", "list.csv", "merged.jsonl"}).exit_code, 0);
}

TEST_F(Batch, OneBadItemStopsAndChangesNoOther) {
  ASSERT_EQ(batch("good.jsonl").exit_code, 0);
  const std::vector<std::string> good = lines("good.jsonl");
  folder_.file("broken.csv", "x_mm,z_um\n0,1\n1,two\n");
  folder_.file("broken.toml", "title = \n");
  ASSERT_EQ(::mkfifo(path("endless.toml").c_str(), 0666), 0);
  add("missing,problem.toml,nowhere.csv\nbroken,problem.toml,broken.csv\n"
      "noproblem,nowhere.toml,\nbadproblem,broken.toml,face0.csv\n"
      "endless,endless.toml,\n");
  const ProgramRun done = batch("out.jsonl", {"--timeout", "3", "--json", "summary.json"});
  EXPECT_EQ(done.exit_code, 5);
  EXPECT_THAT(done.out, HasSubstr("17 items in out.jsonl: 12 ok, 5 failed"));
  std::vector<std::string> ok;
  for (const std::string& line : lines("out.jsonl"))
    if (Json::parse(line)["status"] == "ok") ok.push_back(line);
  EXPECT_EQ(ok, good);
  EXPECT_EQ(result("out.jsonl", "missing")["status"], "bad_data");
  EXPECT_THAT(result("out.jsonl", "broken")["reason"].get<std::string>(),
              HasSubstr("line 3, column 'z_um': 'two' is no number"));
  EXPECT_EQ(result("out.jsonl", "noproblem")["status"], "bad_problem");
  EXPECT_THAT(result("out.jsonl", "badproblem")["reason"].get<std::string>(),
              HasSubstr("line 17 of the manifest: broken.toml:1: no valid TOML"));
  EXPECT_EQ(result("out.jsonl", "endless")["status"], "timeout");
  EXPECT_EQ(result("out.jsonl", "endless")["reason"], "took longer than 3 s");
  EXPECT_TRUE(result("out.jsonl", "endless")["report"].is_null());
  const Json summary = Json::parse(contents(path("summary.json")));
  EXPECT_EQ(summary["counts"]["bad_problem"], 2);
  EXPECT_EQ(summary["first"]["bad_data"]["id"], "missing");
  EXPECT_EQ(run({"batch", "verify", "list.csv", "out.jsonl"}).exit_code, 5);
}

TEST_F(Batch, AnOverrideIsCheckedAndItsRowNamed) {
  folder_.file("list.csv",
               "id,problem,profile.face.file,profile.face.feed_mm_pr_min,low_band.level\n"
               "a,problem.toml,face0.csv,2,\nb,problem.toml,face0.csv,,1\n");
  EXPECT_EQ(batch("out.jsonl").exit_code, 5);
  EXPECT_THAT(result("out.jsonl", "a")["reason"].get<std::string>(),
              HasSubstr("line 2 of the manifest: problem.toml: profile.feed_mm_pr_min: unknown key "
                        "(did you mean 'feed_mm_per_min'?)"));
  // Half of 64 samples, less the value within a groove of the spindle axis.
  EXPECT_EQ(result("out.jsonl", "b")["report"]["final"]["observations"], 31);
}

// sha256sum FILES | cut -c1-64 | sha256sum
TEST_F(Batch, FingerprintsChangeWithInputAndOptionsOnly) {
  ASSERT_EQ(batch("out.jsonl").exit_code, 0);
  const Json before = result("out.jsonl", "face0"), other = result("out.jsonl", "face1");
  EXPECT_NE(before["input_sha256"], other["input_sha256"]);
  EXPECT_NE(before["options_hash"], other["options_hash"]) << "another file by override";
  EXPECT_EQ(before["version"], before["report"]["version"]);
  folder_.file("face0.csv", face_csv(65));
  ASSERT_EQ(batch("out2.jsonl").exit_code, 0);
  EXPECT_NE(result("out2.jsonl", "face0")["input_sha256"], before["input_sha256"]);
  EXPECT_EQ(result("out2.jsonl", "face0")["options_hash"], before["options_hash"]);
  ASSERT_EQ(batch("out3.jsonl", {"--ignore-checksum"}).exit_code, 0);
  EXPECT_NE(result("out3.jsonl", "face0")["options_hash"], before["options_hash"]);
}

TEST_F(Batch, ResultsAreNotWrittenOver) {
  ASSERT_EQ(batch("out.jsonl").exit_code, 0);
  const std::string before = contents(path("out.jsonl"));
  const ProgramRun again = batch("out.jsonl");
  EXPECT_TRUE(is_refused(again, 2));
  EXPECT_THAT(again.err, HasSubstr("out.jsonl: is there already; accepted: --resume, or"));
  EXPECT_EQ(contents(path("out.jsonl")), before);
}

TEST_F(Batch, ResumeDoesAgainWhatFailedChangedOrIsTorn) {
  ASSERT_EQ(batch("out.jsonl").exit_code, 0);
  const std::vector<std::string> all = lines("out.jsonl");
  std::string some = all[0] + "\n" + all[1] + "\n" + all[2] + "\n" + all[0] + "\n" +
                     all[3].substr(0, all[3].size() / 2);
  const std::string status = "\"status\":\"ok\"";
  some.replace(some.find(status, all[0].size()), status.size(), "\"status\":\"timeout\"");
  folder_.file("out.jsonl", some);
  const ProgramRun done = batch("out.jsonl", {"--resume"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("12 ok (2 from before), 0 failed"));
  EXPECT_EQ(lines("out.jsonl"), all);

  folder_.file("face3.csv", face_csv(80));
  EXPECT_THAT(batch("out.jsonl", {"--resume"}).out, HasSubstr("(11 from before)"));
  ASSERT_EQ(batch("new.jsonl").exit_code, 0);
  EXPECT_EQ(lines("out.jsonl"), lines("new.jsonl"));

  folder_.file("list.csv", "id,problem,profile.face.file\nface0,problem.toml,face0.csv\n");
  const ProgramRun other = batch("out.jsonl", {"--resume"});
  EXPECT_TRUE(is_refused(other, 2));
  EXPECT_THAT(other.err, HasSubstr("holds the id 'face"));
}

TEST_F(Batch, SurvivesBeingKilledAtAnyMoment) {
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(batch("whole.jsonl", {"--jobs", "2"}).exit_code, 0);
  const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::steady_clock::now() - begin);
  constexpr int kMoments = 20;
  for (int moment = 0; moment <= kMoments; ++moment) {
    std::filesystem::remove(path("out.jsonl"));
    const std::vector<std::string> words{"batch",    "list.csv",   "--out",  "out.jsonl",
                                         "--resume", "--no-trace", "--jobs", "2"};
    for (const int last : {moment, kMoments - moment})
      run_program(
          words,
          {.folder = folder_.path(), .signal = SIGKILL, .signal_after = whole * last / kMoments});
    const ProgramRun done = run(words);
    ASSERT_EQ(done.exit_code, 0) << done.err;
    ASSERT_EQ(lines("out.jsonl"), lines("whole.jsonl")) << "killed after " << moment;
    ASSERT_EQ(run({"batch", "verify", "list.csv", "out.jsonl"}).exit_code, 0);
  }
}

TEST_F(Batch, VerifyRefusesWhatIsNotWhole) {
  ASSERT_EQ(batch("out.jsonl", {"--shard", "1/2"}).exit_code, 0);
  const ProgramRun half = run({"batch", "verify", "list.csv", "out.jsonl"});
  EXPECT_TRUE(is_refused(half, 3));
  EXPECT_THAT(half.err, HasSubstr("12 ids expected, each once; "));
}

TEST_F(Batch, PoolsTheItemsOfAMachine) {
  // Over half a face the squareness is a tilt, which must then be known.
  std::string manifest = "id,problem,profile.face.file,machine,time,profile.face.free\n";
  for (int i = 0; i < kFaces; ++i)
    manifest += "i" + std::to_string(i) + ",problem.toml,face" + std::to_string(i) + ".csv," +
                (i % 2 == 0 ? "even" : "odd") + ",2026-01-" + std::to_string(10 + i) +
                ",\"[\"\"offset\"\"]\"\n";
  folder_.file("list.csv", manifest);
  const ProgramRun done = batch("out.jsonl", {"--pool", "machine", "--json", "pool.json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("Machine even: "));
  const Json json = Json::parse(contents(path("pool.json")));
  ASSERT_THAT(json["machines"], SizeIs(2));
  EXPECT_EQ(json["machines"][1]["machine"], "odd");
  EXPECT_THAT(json["machines"][1]["items"], SizeIs(6));
  EXPECT_EQ(json["machines"][0]["parameters"].at(0)["name"], "squareness.dbeta_xz");
  EXPECT_EQ(json["machines"][0]["trends"].at(0)["unit"], "rad/day");
}

#ifdef SLIDEWAY_MPIEXEC
class BatchRanks : public Batch, public testing::WithParamInterface<int> {
 protected:
  [[nodiscard]] int mpirun(const std::string& out, const std::string& behind = "") const {
    const std::string command =  // Open MPI leaves memory of its own behind
        "cd " + folder_.path().string() +
        " || exit; ASAN_OPTIONS=detect_leaks=0 " SLIDEWAY_MPIEXEC
        " --oversubscribe --allow-run-as-root -np " +
        std::to_string(GetParam()) + " " SLIDEWAY_PROGRAM " batch list.csv --no-trace --out " +
        out + " >mpi.log 2>&1 " + behind;
    return WEXITSTATUS(std::system(command.c_str()));
  }
};

TEST_P(BatchRanks, GiveTheSameBytes) {
  ASSERT_EQ(batch("alone.jsonl").exit_code, 0);
  ASSERT_EQ(mpirun("out.jsonl"), 0) << contents(path("mpi.log"));
  EXPECT_EQ(lines("out.jsonl"), lines("alone.jsonl"));
  EXPECT_THAT(contents(path("mpi.log")), HasSubstr("12 items in out.jsonl: 12 ok, 0 failed"));
}

TEST_P(BatchRanks, FailedItemsAreTheExitCode) {
  add("missing,problem.toml,nowhere.csv\n");
  EXPECT_EQ(mpirun("out.jsonl"), 5) << contents(path("mpi.log"));
  EXPECT_THAT(lines("out.jsonl"), SizeIs(kFaces + 1));
}

// The last process that was started is the one that is ended.
TEST_P(BatchRanks, AProcessThatDiesLosesNoFinishedResult) {
  ASSERT_EQ(batch("alone.jsonl").exit_code, 0);
  ASSERT_EQ(::mkfifo(path("endless.toml").c_str(), 0666), 0);
  const std::string good = contents(path("list.csv"));
  add("endless,endless.toml,\n");
  EXPECT_NE(
      mpirun(
          "out.jsonl",
          "& mpi=$!; for i in $(seq 200); do sleep 0.1; "
          "[ \"$(cat out.jsonl 2>/dev/null | wc -l)\" = 12 ] && break; done; "
          "for rank in $(cat /proc/$mpi/task/$mpi/children); do :; done; kill -9 $rank; wait $mpi"),
      0);
  EXPECT_EQ(lines("out.jsonl"), lines("alone.jsonl")) << contents(path("mpi.log"));
  folder_.file("list.csv", good);
  EXPECT_THAT(batch("out.jsonl", {"--resume"}).out, HasSubstr("12 ok (12 from before)"));
}

INSTANTIATE_TEST_SUITE_P(Mpi, BatchRanks, testing::Values(1, 2, 4));
#endif

// Code that lies beside a copy of the program and that anybody could have put there.
TEST_F(ProgramTest, MpiPartThatAllMayWriteIsNotLoaded) {
  namespace fs = std::filesystem;
  fs::create_directories(path("bin"));
  fs::create_directories(path("lib/slideway"));
  fs::copy(SLIDEWAY_PROGRAM, path("bin/slideway"));
  folder_.file("lib/slideway/libslideway_mpi.so", "no library");
  fs::permissions(path("lib/slideway/libslideway_mpi.so"), fs::perms::others_write,
                  fs::perm_options::add);
  folder_.file("list.csv", "id,problem\na,problem.toml\n");
  const std::string command = "cd '" + path("").string() +
                              "' && OMPI_COMM_WORLD_SIZE=1 bin/slideway batch list.csv "
                              "--out out.jsonl 2> said.txt";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_THAT(contents(path("said.txt")), HasSubstr("and written by nobody else"));
}

}  // namespace
}  // namespace slideway::batch_test
