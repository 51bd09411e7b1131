#include "fits/thermal_joining.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "fits/materials.h"

namespace hvas::fits {
namespace {

// N4: 60 mm, U 60 um, alpha 11.5e-6, S_f = D / 1000: 173.9 K above room temperature.
TEST(ThermalJoining, HubTemperatureEqualsAPublishedExample) {
  const ThermalJoint joint{0.06, 60e-6, 11.5e-6, 8.5e-6, 20};
  EXPECT_NEAR(CalcHubTemperature(joint, CalcJoiningClearance(0.06), 20) - 20, 173.9, 0.05);
}

TEST(ThermalJoining, TemperaturesGiveTheClearanceTheyWereAskedFor) {
  const ThermalJoint joint{0.04, 42e-6, 23e-6, 8.5e-6, 20};
  for (const double shaft_c : {20.0, -78.0, -196.0}) {
    const double hub_c = CalcHubTemperature(joint, 40e-6, shaft_c);
    EXPECT_NEAR(CalcHotClearance(joint, hub_c, shaft_c), 40e-6, 1e-15);
    EXPECT_NEAR(CalcShaftTemperature(joint, 40e-6, hub_c), shaft_c, 1e-9);
  }
  // Cooling the shaft spares the hub some of its heat.
  EXPECT_LT(CalcHubTemperature(joint, 40e-6, -196), CalcHubTemperature(joint, 40e-6, 20));
  EXPECT_NEAR(CalcHotClearance(joint, 20, 20), -42e-6, 1e-18);
}

/** The same by small steps of time, with both temperatures as unknowns. */
double IntegrateStickingDepth(const ThermalJoint& joint, double hub_c, double shaft_c,
                              const HeatExchange& exchange, double dt) {
  for (double depth = 0; depth < 10; depth += exchange.speed * dt) {
    if (CalcHotClearance(joint, hub_c, shaft_c) <= 0) {
      return depth;
    }
    const double area = std::numbers::pi * joint.joint_diameter * depth;
    const double heat = exchange.conductance * area * (hub_c - shaft_c) * dt;
    hub_c -= heat / exchange.hub_capacity;
    shaft_c += heat / exchange.shaft_capacity;
  }
  return std::numeric_limits<double>::infinity();
}

TEST(ThermalJoining, StickingDepthIsTheLimitOfAnIntegrationInTime) {
  const ThermalJoint joint{0.04, 42e-6, 11e-6, 11e-6, 20};
  const HeatExchange exchange{800, 230, 3000, 0.02};
  const double exact = CalcStickingDepth(joint, 220, 20, exchange);
  const double coarse = IntegrateStickingDepth(joint, 220, 20, exchange, 1e-3);
  const double fine = IntegrateStickingDepth(joint, 220, 20, exchange, 1e-5);
  EXPECT_NEAR(fine, exact, 1e-4 * exact);
  EXPECT_LT(std::abs(fine - exact), std::abs(coarse - exact));
  EXPECT_GT(exact, 0.01);
  EXPECT_LT(exact, 1);
}

TEST(ThermalJoining, SticksAtOnceWithoutClearanceAndNeverWhereItLasts) {
  const HeatExchange exchange{800, 230, 3000, 0.02};
  const ThermalJoint steel{0.04, 42e-6, 11e-6, 11e-6, 20};
  EXPECT_EQ(CalcStickingDepth(steel, 60, 20, exchange), 0);
  // An aluminium hub on steel is still wide when both have the mean temperature.
  const ThermalJoint aluminium{0.04, 42e-6, 23e-6, 11e-6, 20};
  EXPECT_EQ(CalcStickingDepth(aluminium, 300, 20, exchange),
            std::numeric_limits<double>::infinity());
  // Faster goes deeper.
  HeatExchange fast = exchange;
  fast.speed *= 4;
  EXPECT_NEAR(CalcStickingDepth(steel, 220, 20, fast),
              2 * CalcStickingDepth(steel, 220, 20, exchange), 1e-12);
}

// DIN 7190 by the WHZ sheet and Autodesk Inventor's table, heating / cooling in 1e-6/K.
TEST(ThermalJoining, CoefficientsOfDinForHeatingAndForCooling) {
  const auto expect = [](const char* name, double heating, double cooling) {
    const JoiningMaterial m = FindJoiningMaterial(*FindMaterial(name)->material);
    EXPECT_NEAR(m.heating, heating * 1e-6, 1e-12) << name;
    EXPECT_NEAR(m.cooling, cooling * 1e-6, 1e-12) << name;
    EXPECT_FALSE(m.source.empty());
  };
  expect("S355", 11, 8.5);
  expect("42CrMo4", 11, 8.5);
  expect("EN-GJL-250", 10, 8);
  expect("AW-6061", 23, 18);
  expect("CuSn8", 16, 14);
  expect("CuAl10Ni", 16, 14);
  expect("CuZn37", 18, 16);
  expect("AZ91D", 26, 21);
  expect("1.4301", 17, 0.77 * 17);
  for (const Material& material : Materials()) {
    const JoiningMaterial m = FindJoiningMaterial(material);
    // Things shrink less for each kelvin the colder they are.
    EXPECT_LT(m.cooling, m.heating) << material.name;
    EXPECT_GE(m.hottest_c, 80) << material.name;
    EXPECT_LE(m.hottest_c, 350) << material.name;
  }
}

TEST(ThermalJoining, HubsAreHeatedNoFurtherThanTheirTempering) {
  const auto hottest_c = [](const char* name) {
    return FindJoiningMaterial(*FindMaterial(name)->material).hottest_c;
  };
  EXPECT_EQ(hottest_c("S355"), 350);
  EXPECT_EQ(hottest_c("C45"), 300);
  EXPECT_EQ(hottest_c("34CrNiMo6"), 200);
  EXPECT_EQ(hottest_c("16MnCr5"), 200);
  EXPECT_EQ(hottest_c("AW-6061"), 150);
  EXPECT_EQ(hottest_c("POM-C"), 80);
}

TEST(ThermalJoining, EachSideTakesTheCoefficientOfItsOwnSideOfRoomTemperature) {
  const ThermalJoint joint{0.04, 42e-6, 11e-6, 8.5e-6, 20};
  EXPECT_NEAR(CalcHotClearance(joint, -80, 20), 0.04 * 8.5e-6 * -100 - 42e-6, 1e-15);
  EXPECT_NEAR(CalcHotClearance(joint, 20, 120), 0.04 * 11e-6 * -100 - 42e-6, 1e-15);
  for (const double hub_c : {-80.0, 20.0, 300.0}) {
    for (const double clearance : {-300e-6, 40e-6}) {
      const double shaft_c = CalcShaftTemperature(joint, clearance, hub_c);
      EXPECT_NEAR(CalcHotClearance(joint, hub_c, shaft_c), clearance, 1e-15);
      EXPECT_NEAR(CalcHubTemperature(joint, clearance, shaft_c), hub_c, 1e-9);
    }
  }
}

TEST(ThermalJoining, HeatOfEveryMaterialIsThatOfItsKind) {
  for (const Material& material : Materials()) {
    const double heat = SpecificHeatOf(material.group);
    EXPECT_GE(heat, 390) << material.name;
    EXPECT_LE(heat, 1500);
    // Dulong and Petit: of metals about 25 J/(mol K), so rho c is 2 to 4 MJ/(m3 K).
    EXPECT_NEAR(heat * material.density, 2.9e6, 1.2e6) << material.name;
  }
  EXPECT_NEAR(CalcGapConductance(40e-6), 1500, 1e-9);
}

}  // namespace
}  // namespace hvas::fits
