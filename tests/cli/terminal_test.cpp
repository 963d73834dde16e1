#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cstdlib>
#include <system_error>
#include <thread>

#include "cli/bad_input.hpp"

namespace slideway::terminal_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// Without the sequences ESC [ ... m.
std::string without_colours(std::string text) {
  for (std::size_t from = text.find("\033["); from != std::string::npos; from = text.find("\033["))
    text.erase(from, text.find('m', from) - from + 1);
  return text;
}

/// A terminal that keeps what is written on its screen.
class Terminal {
 public:
  Terminal() : keyboard_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    if (keyboard_ < 0 || ::grantpt(keyboard_) != 0 || ::unlockpt(keyboard_) != 0)
      throw std::system_error(errno, std::generic_category(), "posix_openpt");
    screen_ = ::open(::ptsname(keyboard_), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios bytes_as_they_are{};
    ::tcgetattr(screen_, &bytes_as_they_are);
    ::cfmakeraw(&bytes_as_they_are);
    ::tcsetattr(screen_, TCSANOW, &bytes_as_they_are);
    reader_ = std::thread([this] {
      char buffer[4096];
      for (ssize_t n = 0; (n = ::read(keyboard_, buffer, sizeof buffer)) > 0;)
        text_.append(buffer, static_cast<std::size_t>(n));
    });
  }
  ~Terminal() {
    if (reader_.joinable()) static_cast<void>(text());
    ::close(keyboard_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  [[nodiscard]] int screen() const { return screen_; }
  /// All that was written, once nobody else has the screen.
  std::string text() {
    ::close(screen_);
    reader_.join();
    return text_;
  }

 private:
  int keyboard_, screen_ = -1;
  std::string text_;
  std::thread reader_;
};

class OnTerminal : public ProgramTest {
 protected:
  [[nodiscard]] std::string shown(const std::vector<std::string>& arguments,
                                  const std::map<std::string, std::string>& environment) const {
    Terminal terminal;
    run_program(
        arguments,
        {.folder = folder_.path(), .environment = environment, .stdout_number = terminal.screen()});
    return terminal.text();
  }
  /// What a run that is ended after so long shows of its progress.
  [[nodiscard]] std::string progress(const std::vector<std::string>& arguments,
                                     std::chrono::milliseconds after) const {
    Terminal terminal;
    run_program(arguments, {.folder = folder_.path(),
                            .environment = {{"TERM", "xterm"}},
                            .stderr_number = terminal.screen(),
                            .signal = SIGTERM,
                            .signal_after = after});
    return terminal.text();
  }
};

TEST_F(OnTerminal, HeadingsAndVerdictsAreColouredAndTheTextIsTheSame) {
  const std::vector<std::string> arguments{"identify",
                                           shipped("problems/milling-machine-way/problem.toml")};
  const std::string plain = run(arguments).out;
  const std::string coloured = shown(arguments, {{"TERM", "xterm"}, {"NO_COLOR", ""}});
  EXPECT_THAT(plain, Not(HasSubstr("\033")));
  EXPECT_THAT(coloured, HasSubstr("\033[1mFinal model: straightness"));
  EXPECT_THAT(coloured, ContainsRegex("│ Verdict +\033\\[3[123]m"));
  EXPECT_EQ(without_colours(coloured), plain);
  EXPECT_EQ(shown(arguments, {{"TERM", "xterm"}, {"NO_COLOR", "1"}}), plain);
  EXPECT_EQ(shown(arguments, {{"TERM", "dumb"}, {"NO_COLOR", ""}}), plain);
}

TEST_F(OnTerminal, IdentifySaysWhatItIsAtAndSinceWhen) {
  const std::string seconds_long = shipped("problems/paper-600mm/problem.toml");
  using namespace std::chrono_literals;
  EXPECT_THAT(progress({"identify", seconds_long}, 4s),
              ContainsRegex("(fitting the declared model|closing the loop: [^,]*), [0-9]+ s"));
  EXPECT_EQ(progress({"identify", seconds_long, "--quiet"}, 2500ms), "");
  EXPECT_EQ(progress({"identify", seconds_long}, 500ms), "");  // too short to be worth a line
}

TEST_F(OnTerminal, BatchSaysHowMuchIsDoneAndLeft) {
  ASSERT_EQ(::mkfifo(path("endless.toml").c_str(), 0666), 0);
  folder_.file("problem.toml", ProblemText{}.text());
  folder_.file("face.csv", face_csv(64));
  folder_.file("list.csv",
               "id,problem,profile.face.file\na,problem.toml,face.csv\n"
               "b,endless.toml,\nc,endless.toml,\n");
  const std::vector<std::string> batch{"batch",  "list.csv", "--out",      "out.jsonl", "--resume",
                                       "--jobs", "2",        "--no-trace", "--timeout", "5"};
  using namespace std::chrono_literals;
  EXPECT_THAT(progress(batch, 8s),
              ContainsRegex("1 of 3 items, [0-9.]+ a (second|minute), [0-9]+ s left"));
  std::vector<std::string> quiet = batch;
  quiet.emplace_back("--quiet");
  EXPECT_EQ(progress(quiet, 2500ms), "");
}

}  // namespace
}  // namespace slideway::terminal_test
