#include <map>
#include <nlohmann/json.hpp>

#include "problems/program.hpp"
#include "problems/reproduction.hpp"

namespace slideway {
namespace {

/// The block of that fence behind the marker that starts at `at`, replaced.
void replace_block(std::string& text, std::size_t marker_end, const std::string& fence,
                   const std::string& contents) {
  const std::size_t block = marker_end + fence.size();
  if (text.compare(marker_end, fence.size(), fence) != 0)
    throw std::logic_error("no " + fence + " behind " + text.substr(marker_end - 40, 40));
  text.replace(block, text.find("```\n", block) - block, contents);
}

/// Every block ```text behind a line <!-- output: ARGUMENTS --> replaced by what the program says,
/// every ```toml behind <!-- file: PATH --> by that file.
std::string with_current_output(std::string text) {
  const std::string output = "<!-- output: ", file = "<!-- file: ", end = " -->\n";
  for (std::size_t at = text.find("\n<!-- "); at != std::string::npos;
       at = text.find("\n<!-- ", at + 1)) {
    const std::size_t marker_end = text.find(end, at) + end.size();
    const std::string marker = text.substr(at + 1, marker_end - at - 1 - end.size());
    if (marker.starts_with(output))
      replace_block(text, marker_end, "```text\n", output_of(marker.substr(output.size())));
    else if (marker.starts_with(file))
      replace_block(text, marker_end, "```toml\n",
                    std::string(FileBytes(source_folder() / marker.substr(file.size())).text()));
  }
  return text;
}

/// The catalogue as a document.
std::string effects_document() {
  using Json = nlohmann::ordered_json;
  std::string text =
      "# The effects\n\n"
      "The catalogue, made by `slideway effects --json -` (`ctest -R Documents`). An effect is "
      "a\nfunction of one independent variable: r radius, x slide coordinate, t machining time, k "
      "turns of\nthe spindle, s cutting distance, X trace position, m measuring time, t_read "
      "reading time.\n\n"
      "<!-- output: help effects -->\n```text\n```\n";
  const Json document = Json::parse(output_of("effects --json -"));
  for (const Json& effect : document["effects"]) {
    const auto row = [&](const char* label, const char* key) {
      std::string value = effect[key];
      for (std::size_t bar = value.find('|'); bar != std::string::npos;
           bar = value.find('|', bar + 2))
        value.insert(bar, 1, '\\');
      return value.empty() ? "" : std::string("| ") + label + " | " + value + " |\n";
    };
    text += "\n## `" + effect["name"].get<std::string>() + "`\n\n| | |\n|---|---|\n" +
            row("standard name", "standard_name") + row("formula", "formula") +
            row("source", "source") + row("variable", "clock") + row("cause", "cause") +
            row("typical", "typical");
    std::string parameters;
    for (const Json& p : effect["parameters"]) {
      const std::string unit = p["unit"];
      parameters += (parameters.empty() ? "`" : ", `") + p["name"].get<std::string>() + "`" +
                    (unit.empty() ? "" : " (" + unit + ")");
    }
    text += "| parameters | " + parameters + " |\n" + row("confounded with", "confounded_with") +
            row("separated by", "separated_by");
  }
  return with_current_output(text);
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

TEST(Documents, GuidesShowWhatTheProgramSays) {
  for (const char* name : {"docs/getting-started.md", "docs/problem-file.md", "docs/plan.md",
                           "docs/causes.md", "docs/usage.md"}) {
    const std::filesystem::path guide = source_folder() / name;
    expect_current(guide, with_current_output(std::string(FileBytes(guide).text())));
  }
}

TEST(Documents, PictureOfReadmeIsWhatTheProgramDraws) {
  const TemporaryFolder folder;
  const std::string result = (folder.path() / "result.json").string();
  output_of("identify problems/demo/problem.toml --quiet --curves --json " + result);
  expect_current(source_folder() / "docs/demo.svg", output_of("report " + result + " --svg -"));
}

TEST(Documents, EffectsAreTheCatalogue) {
  expect_current(source_folder() / "docs/effects.md", effects_document());
}

}  // namespace
}  // namespace slideway
