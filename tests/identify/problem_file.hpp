#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "base/temporary_folder.hpp"
#include "slideway/base/error.hpp"
#include "slideway/identify/problem.hpp"

namespace slideway {

inline constexpr const char* kMachine = "[machine]\nlever = \"paper\"\n";
inline constexpr const char* kEffect = "[[effect]]\nname = \"squareness\"\n";

inline std::string profile(const std::string& more = "", const std::string& name = "feed2") {
  return "[[profile]]\nname = \"" + name +
         "\"\nfile = \"feed2.csv\"\nposition_unit = \"mm\"\nvalue_unit = \"um\"\n" + more + "\n";
}

class ProblemFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text,
                              const std::string& name = "problem.toml") const {
    return folder_.file(name, text);
  }
  [[nodiscard]] Problem read(const std::string& text) const { return read_problem(write(text)); }

  /// The message with which a text is refused, from the line number on; "" if it is accepted.
  [[nodiscard]] std::string refusal(const std::string& text) const {
    const std::string path = write(text).string();
    try {
      read_problem(path);
    } catch (const UsageError& error) {
      const std::string what = error.what();
      EXPECT_THAT(what, ::testing::AllOf(::testing::StartsWith(path),
                                         ::testing::Not(::testing::HasSubstr("\n"))));
      return what.substr(path.size());
    }
    return "";
  }
  /// The same for a complete problem with these lines in its profile (the first is line 8) ...
  [[nodiscard]] std::string profile_refusal(const std::string& lines) const {
    return refusal(kMachine + profile("#\n" + lines) + kEffect);
  }
  /// ... or behind everything.
  [[nodiscard]] std::string refusal_behind(const std::string& lines) const {
    return refusal(kMachine + profile() + kEffect + lines);
  }

  TemporaryFolder folder_;
};

}  // namespace slideway
