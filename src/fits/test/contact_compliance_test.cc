// Compliance of a contact by the moduli of both parts.
#include "fits/contact_compliance.h"

#include <gtest/gtest.h>

namespace hvas::fits {
namespace {

constexpr Elasticity kSteel{210e9, 0.3};
constexpr Elasticity kAluminium{70e9, 0.33};
constexpr Elasticity kRigid{1e30, 0};

TEST(ContactCompliance, X11ReducedModulusOfEqualBodiesIsHalfOfThePlaneStrainModulus) {
  EXPECT_NEAR(CalcReducedModulus(kSteel, kSteel), 0.5 * 210e9 / (1 - 0.09), 1);
  EXPECT_NEAR(CalcReducedModulus(kSteel, kRigid), 210e9 / (1 - 0.09), 1);
}

TEST(ContactCompliance, X11SteelOnSteelHasTheComplianceOfAllContacts) {
  EXPECT_NEAR(CalcContactCompliance(kSteel, kSteel), 5e-7, 1e-18);
  EXPECT_NEAR(CalcContactRadius(), 8.667e-6, 1e-8);
}

TEST(ContactCompliance, X11HalvesAddUpAsSpringsInSeries) {
  const double steel = CalcContactCompliance(kSteel, kRigid);
  const double aluminium = CalcContactCompliance(kAluminium, kRigid);
  EXPECT_NEAR(CalcContactCompliance(kSteel, kAluminium), steel + aluminium, 1e-18);
  EXPECT_NEAR(CalcContactCompliance(kAluminium, kSteel), steel + aluminium, 1e-18);
}

TEST(ContactCompliance, X11PunchOfKnownRadiusSinksInByItsForceOverItsStiffness) {
  // Johnson 1985, eq. 3.36: P = 2 a E* delta. 1 mm, E* = 100 GPa: 2e8 N/m.
  EXPECT_DOUBLE_EQ(CalcPunchCompliance(1e-3, 100e9), 5e-9);
}

}  // namespace
}  // namespace hvas::fits
