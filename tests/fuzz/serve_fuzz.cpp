#include "serve/draft_session.hpp"
#include "serve/http_server.hpp"
#include "serve/results_view.hpp"
#include "slideway/base/file.hpp"
#include "slideway/identify/draft.hpp"
#include "torture/drawn_json.hpp"

namespace slideway {
namespace {

const std::vector<std::string>& names() {
  static const std::vector<std::string> kNames{"a.csv",
                                               "run",
                                               "../a.csv",
                                               "",
                                               "problem.toml",
                                               "b.jsonl",
                                               ".",
                                               "a\\b",
                                               "/etc/passwd",
                                               "\xC3\xA4 b.csv",
                                               std::string(200, 'n') + ".csv",
                                               "result.json"};
  return kNames;
}

std::string drawn_table(Draw& draw) {
  std::string text = draw.once_in(2) ? "x_mm,z_um\n" : "";
  for (std::size_t left = draw.below(20); left > 0; --left)
    text += shortest(draw.between(-5.0, 50.0)) + draw.one_of(std::array{",", ";", "\t", ""}) +
            shortest(draw.between(-5.0, 5.0)) + "\n";
  return text;
}

std::string drawn_answers(Draw& draw) {
  constexpr std::array kValues{"\"40\"", "\"unknown\"", "\"mm\"",    "\"um\"", "\"1\"",     "\"2\"",
                               "\"\"",   "\"face\"",    "\"slide\"", "1",      "\"1e999\"", "null"};
  std::string text = "[";
  for (const std::string& key : Draft::keys())
    if (draw.once_in(2))
      text += std::string(text.size() > 1 ? ", " : "") + "{\"key\": \"" + key +
              "\", \"file\": " + std::to_string(draw.below(3)) +
              ", \"value\": " + draw.one_of(kValues) + "}";
  return text + (draw.once_in(20) ? "" : "]");
}

/// A request ends as those of the server do: with an answer, or an error that the reply says.
template <typename Request>
void ask(const Request& request) {
  try {
    ends_well(request);
  } catch (const HttpFailure& failure) {
    require(failure.status >= 400 && failure.status < 500, "a status that is none of the client's");
  }
}

void ask_draft(Draw& draw, DraftSession& draft) {
  const std::string& name = draw.one_of(names());
  switch (draw.below(5)) {
    case 0:
      return ask([&] { require(draft.add(name, drawn_table(draw)).size() <= 80, "a long name"); });
    case 1:
      return ask([&] { draft.remove(name); });
    case 2:
      return ask([&] {
        static_cast<void>(draft.traces(ProblemFiles(draw_problem(draw, Intent::hostile)).text()));
      });
    case 3:
      return ask([&] {
        static_cast<void>(
            draft.traces("[machine]\nlever = \"paper\"\n[[profile]]\nname = \"p\"\n"
                         "file = \"a.csv\"\nposition_unit = \"mm\"\n"
                         "value_unit = \"um\"\n[[effect]]\nname = \"cup\"\n"));
      });
    default:
      return ask([&] { static_cast<void>(draft.questions(drawn_answers(draw))); });
  }
}

/// A body as it came: answers, and a problem.
void ask_with(const std::string& text, DraftSession& draft) {
  ask([&] { draft.add("a.csv", "x_mm,z_um\n0,1\n1,2\n2,1\n"); });
  ask([&] { static_cast<void>(draft.questions(text)); });
  ask([&] { static_cast<void>(draft.traces(text)); });
}

void ask_results(Draw& draw, Workspace& workspace, ResultsView& results) {
  const std::filesystem::path run = workspace.folder() / "run";
  std::filesystem::create_directory(run);
  write_file(run / "result.json", draw_json(draw, sound_report()));
  write_file(workspace.folder() / "b.jsonl", draw_json(draw, sound_line("a")) + "\n");
  ask([&] { static_cast<void>(results.list()); });
  ask([&] { static_cast<void>(results.difference("run", draw.one_of(names()))); });
  ask([&] { static_cast<void>(results.table(draw.one_of(names()), "isg")); });
  ask([&] { static_cast<void>(results.batch_rows("b.jsonl")); });
  ask([&] { static_cast<void>(results.batch_page("b.jsonl", "a")); });
}

}  // namespace
}  // namespace slideway

// What the requests of `serve` do, without a socket: files and answers of a draft, runs and batches
// whose files are damaged. A text that begins with [ is a body as it is.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  static Workspace workspace(std::filesystem::temp_directory_path() /
                             ("slideway_serve_fuzz_" + std::to_string(::getpid())));
  static ResultsView results(workspace);
  Drafts drafts(workspace);
  const auto draft = drafts.at(drafts.open());
  if (size > 0 && data[0] == '[') {
    ask_with(std::string(text_of(data, size)), *draft);
    return 0;
  }
  Draw draw({data, size});
  if (draw.once_in(3)) ask_results(draw, workspace, results);
  for (std::size_t left = draw.below(12); left > 0; --left) ask_draft(draw, *draft);
  return 0;
}
