#include "structure.hpp"

#include <gtest/gtest.h>

namespace slideway::structure_test {
namespace {

TEST(ClockOf, IsTheTraceWhereEachProfileHasAProcessOfItsOwn) {
  Unnamed left;
  for (const auto& [clock, variable] : {std::pair{"r", IndependentVariable::slide},
                                        {"t", IndependentVariable::time},
                                        {"X", IndependentVariable::trace},
                                        {"per profile", IndependentVariable::trace}}) {
    left.clock = clock;
    EXPECT_EQ(clock_of(left).variable, variable) << clock;
  }
}

}  // namespace
}  // namespace slideway::structure_test
