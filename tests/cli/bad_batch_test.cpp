#include "cli/bad_batch.hpp"

namespace slideway {
namespace {

const BadManifest kBadManifests[] = {
    {"Empty", "", {"list.csv: is empty"}},
    {"NoItems", "id,problem\n", {"list.csv: lists no problems"}},
    {"NoProblemColumn", "id,low_band.level\na,3\n", {"line 1: no column 'problem'", "accepted:"}},
    {"UnknownColumn",
     "id,problem,titel\na,p.toml,x\n",
     {"list.csv: line 1: unknown column 'titel' (did you mean 'title'?)", "accepted: id problem"}},
    {"ColumnTwice", "id,problem,id\na,p.toml,b\n", {"line 1: column 'id' is there twice"}},
    {"IdTwice",
     "id,problem\na,p.toml\nb,p.toml\na,q.toml\n",
     {"list.csv: line 4: id 'a' is that of line 2", "accepted: one of its own"}},
    {"ProblemTwiceWithoutIds",
     "problem\np.toml\np.toml\n",
     {"line 3: id 'p.toml' is that of line 2", "give a column 'id'"}},
    {"EmptyId", "id,problem\n,p.toml\n", {"line 2: column 'id' is empty"}},
    {"MoreFieldsThanColumns", "id,problem\na,p.toml,3\n", {"line 2: 3 fields, but 2 columns"}},
    {"QuoteThatDoesNotEnd", "id,problem\na,\"p.toml\n", {"line 2: double quotes that do not end"}},
    {"ControlCharacters", "id,problem\na\x1b[2J,p.toml\n", {"holds control characters"}},
    {"PoolWithoutMachines",
     "id,problem\na,p.toml\n",
     {"list.csv: names no machine; accepted: a column 'machine'"},
     {"--pool", "machine"}},
    {"PoolWithATimeThatIsNone",
     "id,problem,machine,time\na,p.toml,M1,yesterday\n",
     {"list.csv: line 2: column 'time': 'yesterday' is not accepted", "accepted: 2026-11-21"},
     {"--pool", "machine"}},
};

class BadManifests : public ProgramTest, public testing::WithParamInterface<BadManifest> {};

TEST_P(BadManifests, IsRefusedInOneLine) {
  const ProgramRun refused = run_on(GetParam(), folder_);
  EXPECT_TRUE(is_refused(refused, 3));
  for (const std::string& fragment : GetParam().fragments)
    EXPECT_THAT(refused.err, testing::HasSubstr(fragment));
  EXPECT_THAT(names_in(folder_.path()), testing::ElementsAre("list.csv"));
}

INSTANTIATE_TEST_SUITE_P(Bad, BadManifests, testing::ValuesIn(kBadManifests),
                         [](const auto& bad) { return bad.param.name; });

const BadUsage kBadBatchUsages[] = {
    {"BatchWithoutManifest", {"batch"}, {"batch: MANIFEST is missing", "'problem'"}},
    {"BatchWithoutOut", {"batch", "m.csv"}, {"batch: --out RESULTS.jsonl is missing"}},
    {"BatchWithTwoManifests",
     {"batch", "m.csv", "n.csv", "--out", "r"},
     {"batch: too many arguments; accepted: one MANIFEST"}},
    {"BatchShard",
     {"batch", "m.csv", "--out", "r", "--shard", "5/4"},
     {"batch: --shard: '5/4' is not accepted; accepted: i/n, 1/4 to 4/4"}},
    {"BatchJobs", {"batch", "m.csv", "--out", "r", "--jobs", "0"}, {"--jobs: from 1 to 4096"}},
    {"BatchTimeout",
     {"batch", "m.csv", "--out", "r", "--timeout", "-1"},
     {"--timeout: a number of seconds above 0 and below 1e7"}},
    {"BatchMemory",
     {"batch", "m.csv", "--out", "r", "--memory", "nan"},
     {"--memory: a finite number of megabytes above 0"}},
    {"BatchPool",
     {"batch", "m.csv", "--out", "r", "--pool", "lathe"},
     {"--pool: 'lathe' is not accepted; accepted: machine"}},
    {"BatchMergeOfNothing", {"batch", "merge", "out"}, {"merge needs OUT and one or more IN"}},
    {"BatchMergeWithAnOption",
     {"batch", "merge", "out", "in", "--resume"},
     {"--resume does not belong to batch merge"}},
    {"BatchVerifyOfOneFile", {"batch", "verify", "m.csv"}, {"verify needs two files"}},
};

class BatchUsage : public ProgramTest, public testing::WithParamInterface<BadUsage> {};

TEST_P(BatchUsage, IsRefusedInOneLine) {
  const ProgramRun refused = run(GetParam().arguments);
  EXPECT_TRUE(is_refused(refused, 2));
  for (const std::string& fragment : GetParam().fragments)
    EXPECT_THAT(refused.err, testing::HasSubstr(fragment));
  EXPECT_THAT(names_in(folder_.path()), testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Bad, BatchUsage, testing::ValuesIn(kBadBatchUsages),
                         [](const auto& bad) { return bad.param.name; });

}  // namespace

std::span<const BadManifest> bad_manifests() { return kBadManifests; }
std::span<const BadUsage> bad_batch_usages() { return kBadBatchUsages; }

}  // namespace slideway
