#include "cli/bad_batch.hpp"
#include "problems/program.hpp"
#include "slideway/base/text.hpp"

namespace slideway::faults_document_test {
namespace {

/// "MarkOfAMissingValue" as "mark of a missing value".
std::string in_words(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const bool begins_word = c >= 'A' && c <= 'Z';
    if (begins_word && !text.empty()) text += ' ';
    text += begins_word ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return text;
}

std::string header(const std::string& test) {
  return "\n`cli/" + test + "`\n\n| what goes wrong | what slideway says | exit code | test |\n" +
         "|---|---|---|---|\n";
}

std::string row(const std::string& name, const ProgramRun& run) {
  constexpr std::size_t kPrefix = std::string_view("slideway: ").size();
  constexpr std::size_t kLongest = 140;
  std::string said = printable(run.err.substr(kPrefix, run.err.size() - kPrefix - 1), kLongest);
  for (std::size_t at = 0; (at = said.find('|', at)) != std::string::npos; at += 2)
    said.insert(at, 1, '\\');
  return "| " + in_words(name) + " | `" + said + "` | " + std::to_string(run.exit_code) + " | `" +
         name + "` |\n";
}

std::string section(const std::string& title, const std::vector<BadInputs>& lists) {
  std::string text = "\n## " + title + "\n";
  for (const BadInputs& list : lists) {
    text += header(list.test + ".IsRefusedInOneLine");
    for (const BadInput& input : list.cases) {
      const TemporaryFolder folder;
      text += row(input.name, run_on(input, folder));
    }
  }
  return text;
}

std::string section(const std::string& title, const std::string& test,
                    std::span<const BadUsage> list) {
  std::string text = "\n## " + title + "\n" + header(test);
  for (const BadUsage& usage : list) {
    const TemporaryFolder folder;
    std::string line =
        row(usage.name, run_program(usage.arguments, {folder.path(), usage.stdout_to}));
    if (const std::size_t at = line.find(SLIDEWAY_SOURCE_DIR "/"); at != std::string::npos)
      line.erase(at, std::string_view(SLIDEWAY_SOURCE_DIR "/").size());
    text += line;
  }
  return text;
}

std::string section(const std::string& title, std::span<const BadManifest> list) {
  std::string text = "\n## " + title + "\n" + header("Bad/BadManifests.IsRefusedInOneLine");
  for (const BadManifest& bad : list) {
    const TemporaryFolder folder;
    text += row(bad.name, run_on(bad, folder));
  }
  return text;
}

// From the lists of the tests and from what the program says to each case.
TEST(Documents, FaultsAreWhatTheProgramSays) {
  const std::string text =
      "# Faults\n\n"
      "Faults of the input, and the message of each: one line on standard error after `slideway: "
      "`,\n"
      "nothing on standard output, no file written. Long messages are cut here. Each row is a case "
      "of\n"
      "the test named above its table; the tests write the tables.\n\n"
      "Exit codes: 0 done, 1 failed while working, 2 bad usage or bad problem file, 3 unreadable "
      "or\n"
      "invalid data, 4 negative verdict (`--strict` only), 5 batch finished with failed items.\n\n"
      "If an item of a batch fails, its line of the results has a `status` and a `reason`, and all "
      "other\n"
      "items are run. `bad_problem`, `bad_data` and `failed` correspond to the exit codes 2, 3 and "
      "1 of\n"
      "`identify`; the others are `timeout`, `out_of_memory` and `crashed`\n"
      "(`cli/Batch.OneBadItemStopsAndChangesNoOther`, `batch/ProcessPool`).\n\n"
      "A file is written completely or not at all, also when a signal ends the program, the power "
      "fails or the disk\n"
      "is full at any of its bytes (`cli/Signal/Interrupted`, `base/WriteFile`, `faults`). Lines "
      "of "
      "a batch are appended one by\n"
      "one: after a power failure the last of them may be missing, and `--resume` makes them. A "
      "file that changes while it is\n"
      "read is refused; one of more than 64 MiB that is cut short ends the program with exit code "
      "3. Every reader is\n"
      "fuzzed: `./dev fuzz`.\n"
      "\n"
      "## Bounds\n"
      "\n"
      "Time and memory of reading grow with the points of a file and with nothing else. A point "
      "takes about 75 bytes while a\n"
      "file is read whole (9e6 points of an X3P file of 21 MB: 656 MB); delimited text is read in "
      "parts, "
      "with the low band alone kept\n"
      "([performance.md](performance.md)). An entry of an X3P archive that expands more than 100 "
      "to 1 is refused, its\n"
      "`main.xml` at 1 MiB or 20 times the archive; the count of points that it declares must be "
      "that of the bytes there.\n"
      "Devices, pipes and folders are no profiles. An effect has at most 100 priors. A message has "
      "at most 2000 bytes: of a\n"
      "longer one its two ends are kept.\n"
      "\n"
      "The closed loop keeps the columns of its candidates: 8 bytes for each low-band value, each "
      "amplitude and each of up to\n"
      "8192 shapes. Three faces in the low band of the paper take 100 to 200 MB; three readings of "
      "900 values each without a\n"
      "low band, at feeds of 1 to 5, take 1 to 2 GB. `search_values` in `[trace]` bounds the "
      "values "
      "that a profile is searched\n"
      "with. `batch` and `serve` end an item at `--timeout` and `--memory`, the loop ends at "
      "`--time-limit`.\n" +
      section("Problem file", bad_problems()) + section("Data", bad_data()) +
      section("File formats", bad_formats()) +
      section("Command line", "Bad/Usage.IsRefusedInOneLine", bad_usages()) +
      section("Manifest of a batch", bad_manifests()) +
      section("Command line of a batch", "Bad/BatchUsage.IsRefusedInOneLine", bad_batch_usages()) +
      section("Output", "Bad/BadOutputs.FailInOneLine", bad_outputs());
  expect_current(source_folder() / "docs/faults.md", text);
}

}  // namespace
}  // namespace slideway::faults_document_test
