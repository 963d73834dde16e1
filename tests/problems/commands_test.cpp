// Every command that a document shows in a block ```sh is run, in the order of the document.

#include <gmock/gmock.h>

#include <algorithm>

#include "problems/program.hpp"

namespace slideway {
namespace {

std::vector<std::filesystem::path> documents() {
  std::vector<std::filesystem::path> all{source_folder() / "README.md"};
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() / "docs"))
    if (entry.path().extension() == ".md") all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

/// The lines of ```sh blocks that call the program, without its name.
std::vector<std::string> commands_of(const std::filesystem::path& document) {
  std::vector<std::string> commands;
  std::istringstream text{std::string(FileBytes(document).text())};
  bool shell = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) shell = line == "```sh";
    if (!shell || !line.starts_with("slideway ")) continue;
    commands.push_back(line.substr(9));
  }
  return commands;
}

class DocumentCommands : public testing::TestWithParam<std::filesystem::path> {
 protected:
  void SetUp() override {
    for (const char* shipped : {"problems", "data", "docs"})
      std::filesystem::create_directory_symlink(source_folder() / shipped,
                                                folder_.path() / shipped);
  }
  TemporaryFolder folder_;
};

TEST_P(DocumentCommands, Work) {
  std::vector<std::string> skipped;
  for (const std::string& command : commands_of(GetParam())) {
    ProgramSetup setup{folder_.path(), {}};
    if (command.find("problems/real/") != std::string::npos) {
      if (!std::filesystem::exists(measured_data())) {
        skipped.push_back(command);
        continue;
      }
      setup.environment["SLIDEWAY_DATA"] = measured_data().string();
    }
    std::istringstream words(command);
    const ProgramRun run = run_program({std::istream_iterator<std::string>(words), {}}, setup);
    EXPECT_EQ(run.exit_code, 0) << "slideway " << command << "\n" << run.err;
  }
  if (!skipped.empty()) GTEST_SKIP() << "no SLIDEWAY_DATA for: " << testing::PrintToString(skipped);
}

INSTANTIATE_TEST_SUITE_P(Of, DocumentCommands, testing::ValuesIn(documents()),
                         [](const auto& name) {
                           std::string stem = name.param.stem().string();
                           if (name.param.parent_path() == source_folder()) stem = "Root" + stem;
                           std::erase_if(stem, [](char c) { return std::isalnum(c) == 0; });
                           return stem;
                         });

TEST(DocumentCommands, AreFoundAtAll) {
  EXPECT_GE(commands_of(source_folder() / "docs/getting-started.md").size(), 5U);
  EXPECT_GE(commands_of(source_folder() / "README.md").size(), 1U);
}

}  // namespace
}  // namespace slideway
