#include "slideway/base/units.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace slideway {
namespace {

TEST(Units, EveryListedNameHasAScaleAndNoOtherHas) {
  std::istringstream lengths{std::string(kLengthUnits)};
  for (std::string name; lengths >> name;) EXPECT_TRUE(length_unit(name)) << name;
  std::istringstream slopes{std::string(kSlopeUnits)};
  for (std::string name; slopes >> name;) EXPECT_TRUE(slope_unit(name)) << name;
  EXPECT_FALSE(length_unit("rad"));
  EXPECT_FALSE(length_unit("MM"));
  EXPECT_FALSE(length_unit(""));
  EXPECT_FALSE(slope_unit("mm"));
}

TEST(Units, ConvertWithOneRounding) {
  // Decimal literals on the right are the correctly rounded exact results.
  EXPECT_EQ(length_unit("um").value()(0.3), 0.0003);
  EXPECT_EQ(length_unit("nm").value()(7.0), 7e-6);
  EXPECT_EQ(length_unit("m").value()(0.6), 600.0);
  EXPECT_EQ(length_unit("inch").value()(1.0), 25.4);  // exact by definition of the inch
  EXPECT_EQ(slope_unit("mm_per_m").value()(0.02), 2e-5);
  EXPECT_EQ(slope_unit("um_per_m").value()(3.0), slope_unit("urad").value()(3.0));
  // A full turn is 1 296 000 arcseconds; two roundings are allowed.
  EXPECT_DOUBLE_EQ(slope_unit("arcsec").value()(1296000.0), 2.0 * kPi);
}

}  // namespace
}  // namespace slideway
