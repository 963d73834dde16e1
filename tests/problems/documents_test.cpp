#include "problems/program.hpp"

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

TEST(Documents, ReadmeShowsWhatTheProgramSays) {
  const std::filesystem::path readme = source_folder() / "README.md";
  const std::string text(FileBytes(readme).text());
  ASSERT_NE(text.find("<!-- output: "), std::string::npos);
  expect_current(readme, with_current_output(text));
}

}  // namespace
}  // namespace slideway
