#pragma once

#include <gmock/gmock.h>

#include <span>

#include "cli/run_program.hpp"

namespace slideway {

/// A small problem that is accepted, in parts that a case replaces by what is not.
struct ProblemText {
  std::string machine = "[machine]\nlever = \"paper\"\n";
  std::string low_band = "[low_band]\nlevel = 2\n";
  std::string file = "face.csv";
  std::string columns = "position_column = \"x_mm\"\nvalue_column = \"z_um\"\n";
  std::string units = "position_unit = \"mm\"\nvalue_unit = \"um\"\n";
  std::string profile_more;
  std::string effect = "[[effect]]\nname = \"squareness\"\n";
  std::string more;

  [[nodiscard]] std::string text() const {
    return machine + low_band + "[[profile]]\nname = \"face\"\nfile = \"" + file + "\"\n" +
           columns + units + profile_more + effect + more;
  }
};

/// Rows of a face at 0, 1, 2, ... mm; `odd_row` is written instead of data row `odd`.
inline std::string face_csv(int rows, int odd = -1, const std::string& odd_row = "") {
  std::string text = "x_mm,z_um\n";
  for (int i = 0; i < rows; ++i)
    text += (i == odd ? odd_row : std::to_string(i) + ",0." + std::to_string(i * 37 % 101)) + "\n";
  return text;
}

struct BadInput {
  std::string name;
  std::string problem, csv;
  int exit_code;
  std::vector<std::string> fragments;  // of the message: the place, what is wrong, what is accepted
};

inline void PrintTo(const BadInput& input, std::ostream* out) { *out << input.name; }

/// A list of cases by the name of its tests: "BadField/Data".
struct BadInputs {
  std::string test;
  std::span<const BadInput> cases;
};

std::vector<BadInputs> bad_problems(), bad_data(), bad_formats();

/// Arguments that a command refuses.
struct BadUsage {
  std::string name;
  std::vector<std::string> arguments;
  std::vector<std::string> fragments;  // of the message
  std::string stdout_to = {};
};

inline void PrintTo(const BadUsage& usage, std::ostream* out) { *out << usage.name; }

std::span<const BadUsage> bad_usages(), bad_outputs();

/// Runs identify on the case.
inline ProgramRun run_on(const BadInput& input, const TemporaryFolder& folder) {
  folder.file("problem.toml", input.problem);
  folder.file("face.csv", input.csv);
  return run_program({"identify", "problem.toml", "--json", "report.json"}, {folder.path(), {}});
}

/// Refused in one line that says where and what, and nothing written.
class BadInputTest : public ProgramTest, public testing::WithParamInterface<BadInput> {
 protected:
  void expect_refused() const {
    const ProgramRun refused = run_on(GetParam(), folder_);
    EXPECT_TRUE(is_refused(refused, GetParam().exit_code));
    EXPECT_THAT(refused.err, testing::StartsWith("slideway: "));
    for (const std::string& fragment : GetParam().fragments)
      EXPECT_THAT(refused.err, testing::HasSubstr(fragment));
    EXPECT_THAT(names_in(folder_.path()), testing::ElementsAre("face.csv", "problem.toml"));
  }
};

}  // namespace slideway
