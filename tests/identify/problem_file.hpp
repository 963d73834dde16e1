#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

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
  ProblemFile()
      : directory_(std::filesystem::path(::testing::TempDir()) /
                   ::testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(directory_);
  }
  ~ProblemFile() override { std::filesystem::remove_all(directory_); }

  std::filesystem::path write(const std::string& text, const std::string& name = "problem.toml") {
    std::ofstream(directory_ / name, std::ios::binary) << text;
    return directory_ / name;
  }
  Problem read(const std::string& text) { return read_problem(write(text)); }

  /// The message with which a text is refused, from the line number on; "" if it is accepted.
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const UsageError& error) {
      const std::string what = error.what();
      EXPECT_THAT(what,
                  ::testing::AllOf(::testing::StartsWith((directory_ / "problem.toml").string()),
                                   ::testing::Not(::testing::HasSubstr("\n"))));
      return what.substr((directory_ / "problem.toml").string().size());
    }
    return "";
  }
  /// The same for a complete problem with these lines in its profile (the first is line 8) ...
  std::string profile_refusal(const std::string& lines) {
    return refusal(kMachine + profile("#\n" + lines) + kEffect);
  }
  /// ... or behind everything.
  std::string refusal_behind(const std::string& lines) {
    return refusal(kMachine + profile() + kEffect + lines);
  }

  std::filesystem::path directory_;
};

}  // namespace slideway
