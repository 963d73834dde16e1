#include "slideway/identify/draft.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/temporary_folder.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

/// A table of 400 readings from 5 mm to 25 mm; `form` of a place from -1 to 1.
template <typename Form>
std::string table(Form&& form) {
  std::string out = "x_mm;z_um\n";
  for (int i = 0; i < 400; ++i) {
    const double u = 2.0 * i / 399.0 - 1.0;
    out += std::to_string(15.0 + 10.0 * u) + ";" + std::to_string(form(u)) + "\n";
  }
  return out;
}

double bowl(double u) { return 5.0 * u * u; }

class Drafted : public ::testing::Test {
 protected:
  [[nodiscard]] Draft draft(const std::string& text, std::size_t files = 1) const {
    std::vector<std::filesystem::path> paths;
    for (std::size_t i = 0; i < files; ++i)
      paths.push_back(folder_.file(std::to_string(i) + ".csv", text));
    return Draft(paths);
  }

  /// Answers what is asked before a key with the guess, else with what asks least.
  static std::optional<DraftQuestion> up_to(Draft& draft, const std::string& key) {
    std::optional<DraftQuestion> asked = draft.next();
    for (; asked && asked->key != key; asked = draft.next())
      draft.answer(*asked, asked->guess.empty() ? asked->fallback : asked->guess);
    return asked;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Drafted, TakesAColumnByItsNameOrItsPlace) {
  for (const char* answer : {"0", "-1", "1.5", "3", "z"}) {
    Draft one = draft(table(bowl));
    const auto asked = up_to(one, "value-column");
    ASSERT_TRUE(asked);
    EXPECT_THROW(one.answer(*asked, answer), UsageError) << answer;
  }
  for (const char* answer : {"2", "z_um"}) {
    Draft one = draft(table(bowl));
    const auto asked = up_to(one, "value-column");
    one.answer(*asked, answer);
    ASSERT_TRUE(one.files()[0].trace) << answer;
    EXPECT_NEAR(one.files()[0].trace->values.front(), 5.0, 1e-6) << answer;
  }
}

// 3 u² - 1 and 5 u³ - 3 u, orthogonal to a line and to each other, have the mean squares 4/5 and
// 4/7: with c of the second the even share is 1 / (1 + 5/7 c²).
TEST_F(Drafted, GuessesADiameterFromNineTenthsOfAFormThatIsEven) {
  for (const auto& [c, guess] : {std::pair{0.0, "diameter"}, {0.35, "diameter"}, {0.45, ""}}) {
    Draft one = draft(table([c = c](double u) {
      return 3.0 * u * u - 1.0 + c * (5.0 * u * u * u - 3.0 * u) + 7.0 * u + 2.0;
    }));
    const auto asked = up_to(one, "trace");
    ASSERT_TRUE(asked) << c;
    EXPECT_EQ(asked->guess, guess) << c;
  }
}

// Eight of the sixty cells a ripple: compared one cell off, a seventh of it would be odd.
TEST_F(Drafted, GuessesADiameterFromARippleThatIsEven) {
  Draft one = draft(table([](double u) { return std::cos(2.0 * kPi * 3.75 * u); }));
  const auto asked = up_to(one, "trace");
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->guess, "diameter");
}

TEST_F(Drafted, AsksOfEachFileAndOfTheMachineOnce) {
  Draft two = draft(table(bowl), 2);
  std::map<std::string, int> times;
  while (const auto asked = two.next()) {
    ASSERT_LE(++times[asked->key], 2) << asked->key;
    two.answer(*asked, asked->guess.empty() ? asked->fallback : asked->guess);
  }
  EXPECT_EQ(times["kind"], 2);
  EXPECT_EQ(times["lever"], 1);
}

}  // namespace
}  // namespace slideway
