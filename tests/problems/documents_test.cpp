#include <map>

#include "problems/program.hpp"
#include "problems/reproduction.hpp"

namespace slideway {
namespace {

/// Every block ```text behind a line <!-- output: ARGUMENTS --> replaced by what the program says.
std::string with_current_output(std::string text) {
  const std::string marker = "<!-- output: ", fence = "```text\n";
  for (std::size_t at = text.find(marker); at != std::string::npos;
       at = text.find(marker, at + 1)) {
    const std::size_t arguments = at + marker.size();
    const std::size_t arguments_end = text.find(" -->\n", arguments);
    const std::size_t block = arguments_end + 5 + fence.size();
    if (text.compare(block - fence.size(), fence.size(), fence) != 0)
      throw std::logic_error("no ```text behind " + marker);
    const std::size_t block_end = text.find("```\n", block);
    text.replace(block, block_end - block,
                 output_of(text.substr(arguments, arguments_end - arguments)));
  }
  return text;
}

/// Every @name@ replaced by its number; each must be used, and none may be missing.
std::string filled(std::string text, const std::map<std::string, std::string>& numbers) {
  for (const auto& [name, number] : numbers) {
    const std::string mark = "@" + name + "@";
    std::size_t at = text.find(mark);
    EXPECT_NE(at, std::string::npos) << mark << " is in no line";
    for (; at != std::string::npos; at = text.find(mark, at + number.size()))
      text.replace(at, mark.size(), number);
  }
  EXPECT_EQ(text.find('@'), std::string::npos) << text.substr(text.find('@')).substr(0, 40);
  return text;
}

TEST(Documents, ReproductionStatesWhatTheLibraryFindsToday) {
  const std::string text(FileBytes(source_folder() / "tests/problems/reproduction.md.in").text());
  expect_current(source_folder() / "docs/reproduction.md", filled(text, reproduced_numbers()));
}

TEST(Documents, ReadmeShowsWhatTheProgramSays) {
  const std::filesystem::path readme = source_folder() / "README.md";
  const std::string text(FileBytes(readme).text());
  ASSERT_NE(text.find("<!-- output: "), std::string::npos);
  expect_current(readme, with_current_output(text));
}

}  // namespace
}  // namespace slideway
