#include "slideway/identify/problem_tree.hpp"

#include <cmath>

#include "problem_file.hpp"

namespace slideway {
namespace {

using Table = TomlValue::Table;

TomlEntry entry(std::string key, decltype(TomlValue::data) data) {
  return {std::move(key), 0, {0, std::move(data)}};
}

/// The problem of kMachine + profile() + kEffect as a program has it in memory, without a file.
TomlValue tree(Table more = {}) {
  Table profile{entry("name", "feed2"), entry("position_unit", "mm"), entry("value_unit", "um")};
  profile.insert(profile.end(), more.begin(), more.end());
  const TomlValue effect{0, Table{entry("name", "squareness")}};
  return {0, Table{entry("machine", Table{entry("lever", "paper")}),
                   entry("profile", TomlValue::Array{{0, profile}}),
                   entry("effect", TomlValue::Array{effect})}};
}

template <typename Error, typename Function>
std::string message_of(Function&& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

class GivenNumbers : public ProblemFile {};

TEST_F(GivenNumbers, MakeTheProfileThatAFileOfThemMakes) {
  write("x,z\n3,1.5\n2,nan\n1,0.25\n0,-1\n", "feed2.csv");
  const GivenTraces given{{"feed2", {{3, 2, 1, 0}, {1.5, NAN, 0.25, -1}}}};
  const Problem file = read_problem(write(kMachine + profile() + kEffect));
  const Profile expected = read_profiles(file).at(0);
  for (const Problem& problem : {file, read_problem(tree())}) {
    const Profile made = read_profiles(problem, given).at(0);
    EXPECT_EQ(made.positions, expected.positions);
    EXPECT_EQ(made.values, expected.values);
    EXPECT_EQ(made.missing, 1U);
    EXPECT_EQ(made.setup.cut_radius_mm, expected.setup.cut_radius_mm);
    EXPECT_EQ(made.file, "arrays");
  }
}

TEST_F(GivenNumbers, AreRefusedByTheNameOfTheirProfile) {
  const Problem problem = read_problem(tree());
  EXPECT_EQ(message_of<UsageError>([&] {
              read_profiles(problem, {{"feed3", {}}});
            }),
            "problem: numbers for 'feed3', which is no [[profile]] (did you mean 'feed2'?); "
            "accepted: feed2");
  EXPECT_EQ(message_of<DataError>([&] {
              read_profiles(problem, {{"feed2", {{0, NAN}, {1, 2}}}});
            }),
            "profile 'feed2': data row 2: the position is nan; accepted: a finite number");
  EXPECT_EQ(message_of<UsageError>([&] { read_profiles(problem); }),
            "problem: profile 'feed2': no numbers; accepted: arrays, or file");
}

TEST(ProblemTree, IsRefusedByKeyAndPlaceInTheList) {
  EXPECT_EQ(message_of<UsageError>([] { read_problem(tree({entry("kind", "disc")})); }),
            "problem: profile[0].kind: \"disc\" is not accepted; accepted: face slide");
}

}  // namespace
}  // namespace slideway
