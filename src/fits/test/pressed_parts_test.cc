// Parts that are pressed along their axis, against published tables and other ways to the number.

#include "fits/pressed_parts.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace hvas::fits {
namespace {

constexpr double kPressedMm = 1e-3;

struct CatalogueDisc {
  double outer, inner, thickness, cone_height, compression;  // [mm]
  double force;                                              // [N], as printed.
};

// Series A of DIN 2093 at 0.75 h_0, as printed by xmdiscsprings.com for 206 GPa and 0.3; the
// compression is printed to 0.01 mm and the force to three digits.
constexpr std::array<CatalogueDisc, 11> kSeriesA{{{8, 4.2, 0.4, 0.2, 0.15, 210},
                                                  {10, 5.2, 0.5, 0.25, 0.19, 329},
                                                  {12.5, 6.2, 0.7, 0.3, 0.23, 673},
                                                  {14, 7.2, 0.8, 0.3, 0.23, 813},
                                                  {16, 8.2, 0.9, 0.35, 0.26, 1000},
                                                  {18, 9.2, 1, 0.4, 0.3, 1250},
                                                  {20, 10.2, 1.1, 0.45, 0.34, 1530},
                                                  {22.5, 11.2, 1.25, 0.5, 0.38, 1950},
                                                  {25, 12.2, 1.5, 0.55, 0.41, 2910},
                                                  {28, 14.2, 1.5, 0.65, 0.49, 2850},
                                                  {31.5, 16.3, 1.75, 0.7, 0.53, 3900}}};

DiscSpring MakeDisc(const CatalogueDisc& disc) {
  return {disc.outer * kPressedMm,
          disc.inner * kPressedMm,
          disc.thickness * kPressedMm,
          disc.cone_height * kPressedMm,
          206e9,
          0.3};
}

TEST(DiscSpring, HasTheForcesOfTheCatalogue) {
  for (const CatalogueDisc& disc : kSeriesA) {
    EXPECT_NEAR(CalcPressForce(MakeDisc(disc), disc.compression * kPressedMm), disc.force,
                0.0042 * disc.force)
        << disc.outer;
  }
}

// Pressed flat, it has 4 E h_0 t^3 / ((1 - nu^2) K_1 D_e^2).
TEST(DiscSpring, IsFlatByItsClosedForm) {
  const DiscSpring disc = MakeDisc(kSeriesA[0]);
  EXPECT_NEAR(CalcDiscShape(disc), 0.673361, 1e-6);
  EXPECT_NEAR(CalcPressForce(disc, disc.cone_height), 268.948, 0.001);
  const double flat = 4 * disc.modulus / (1 - 0.09) * disc.cone_height *
                      std::pow(disc.thickness, 3) / (CalcDiscShape(disc) * disc.outer * disc.outer);
  EXPECT_NEAR(CalcPressForce(disc, disc.cone_height), flat, 1e-9 * flat);
  EXPECT_GT(CalcPressForce(disc, 1.1 * disc.cone_height), flat);
  EXPECT_EQ(CalcPressForce(disc, 0), 0);
  EXPECT_EQ(CalcPressForce(disc, -1e-3), 0);
}

// Inputs of FOSSEE Scilab textbook companion 764, example 10.19, and Shigley's example 10-1, whose
// rate is printed as 4.13 lbf/in.
TEST(CoilSpring, HasTheRateOfTextbooks) {
  EXPECT_NEAR(CalcCoilStiffness({6 * kPressedMm, 36 * kPressedMm, 10, 81.37e9}), 28253.5, 0.1);
  EXPECT_NEAR(CalcCoilStiffness({5 * kPressedMm, 30 * kPressedMm, 8, 81.37e9}), 29430.7, 0.1);
  EXPECT_NEAR(CalcCoilStiffness({0.9398 * kPressedMm, 10.16 * kPressedMm, 10.5, 81.7029e9}), 723.27,
              0.3);
}

// The torque F D / 2 twists the whole wire by G I_p: energy of the twist, summed up.
TEST(CoilSpring, StoresTheEnergyOfItsTwistedWire) {
  const CoilSpring spring{2 * kPressedMm, 20 * kPressedMm, 7, 80e9};
  const double force = 50;
  const double torque = force * spring.diameter / 2;
  const double wire = spring.active_coils * std::numbers::pi * spring.diameter;
  const double polar = std::numbers::pi * std::pow(spring.wire, 4) / 32;
  const double energy = 0.5 * torque * torque * wire / (spring.shear_modulus * polar);
  const double s = force / CalcCoilStiffness(spring);
  EXPECT_NEAR(0.5 * force * s, energy, 1e-9 * energy);
}

// Wahl's factor for springs of square wire: s = 44.5 F r^3 n / (G b^4).
TEST(LockWasher, IsATurnOfSquareWire) {
  const double side = 2 * kPressedMm;
  const double radius = 5 * kPressedMm;
  const LockWasher washer{2 * radius + side, 2 * radius - side, side, 79.3e9};
  const double wahl = 79.3e9 * std::pow(side, 4) / (44.5 * std::pow(radius, 3));
  EXPECT_NEAR(CalcLockWasherStiffness(washer), wahl, 0.01 * wahl);
}

TEST(LeafSpring, IsACantilever) {
  const LeafSpring leaf{40 * kPressedMm, 10 * kPressedMm, 0.8 * kPressedMm, 206e9};
  const double inertia = leaf.width * std::pow(leaf.thickness, 3) / 12;
  const double exact = 3 * leaf.modulus * inertia / std::pow(leaf.length, 3);
  EXPECT_NEAR(CalcLeafStiffness(leaf), exact, 1e-9 * exact);
}

// A disc of rubber with 50 mm across and 10 mm high has S = D / (4 t) = 1.25 and E_c = E (1 + 2
// S^2), lowered by its bulk modulus by 1.0 %.
TEST(FlatGasket, IsABondedBlock) {
  const double d = 50 * kPressedMm;
  const double t = 10 * kPressedMm;
  const FlatGasket block{std::numbers::pi * d * d / 4, std::numbers::pi * d * t, t, 5e6};
  const double apparent = 5e6 * (1 + 2 * 1.25 * 1.25);
  EXPECT_NEAR(CalcPadModulus(block), apparent, 0.011 * apparent);
  EXPECT_LT(CalcPadModulus(block), apparent);
  // Small compressions follow E_c A s / t; at a quarter it is 1.37 times as stiff.
  const double small = 1e-4 * t;
  EXPECT_NEAR(CalcPressForce(block, small), CalcPadModulus(block) * block.area * 1e-4,
              2e-4 * CalcPressForce(block, small));
  const double ratio =
      CalcPressForce(block, 0.25 * t) / (CalcPadModulus(block) * block.area * 0.25);
  EXPECT_NEAR(ratio, (1 / (0.75 * 0.75) - 0.75) / (3 * 0.25), 1e-9);
  // However thin, it is no stiffer than its bulk, and a sheet of fibre has its own modulus.
  const FlatGasket thin{block.area, std::numbers::pi * d * 0.1 * kPressedMm, 0.1 * kPressedMm, 5e6};
  EXPECT_LT(CalcPadModulus(thin), 2e9);
  EXPECT_EQ(CalcPadModulus({1e-3, 1e-4, 1e-3, 0.5e9}), 0.5e9);
}

TEST(PressedPart, ForcesRiseWithoutAJumpWhereTheFormulaEnds) {
  const DiscSpring disc = MakeDisc(kSeriesA[4]);
  const FlatGasket gasket{2e-3, 1e-3, 1e-3, 5e6};
  for (const PressedPart& part : {PressedPart(disc), PressedPart(gasket)}) {
    const double most = FindMostPressed(part);
    const double before = CalcPressForce(part, most * (1 - 1e-7));
    const double after = CalcPressForce(part, most * (1 + 1e-7));
    EXPECT_GT(after, before);
    EXPECT_NEAR(after, before, 1e-5 * after);
  }
}

// Nested springs of FOSSEE example 10.19 in parallel are two parts; one behind the other they have
// k1 k2 / (k1 + k2).
TEST(PressTable, OfSpringsInSeriesHasTheirCommonForce) {
  const std::array<PressedPart, 2> both{StatedSpring{28253.5}, StatedSpring{29430.7}};
  const std::vector<double> table = MakePressTable(both, 10 * kPressedMm, 10);
  ASSERT_EQ(table.size(), 11U);
  const double rate = 28253.5 * 29430.7 / (28253.5 + 29430.7);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double force = rate * kPressedMm * static_cast<double>(i);
    EXPECT_NEAR(table[i], force, 1e-9 * force + 1e-9) << i;
  }
}

// DIN 2092: i discs one behind the other have i times the compression of one at its force.
TEST(PressTable, OfDiscsInSeriesHasTheForceOfOneAtItsShare) {
  const DiscSpring disc = MakeDisc(kSeriesA[8]);
  const std::array<PressedPart, 3> stack{disc, disc, disc};
  const double all = 3 * 0.41 * kPressedMm;
  const std::vector<double> table = MakePressTable(stack, all, 4);
  ASSERT_EQ(table.size(), 5U);
  EXPECT_NEAR(table.back(), CalcPressForce(disc, all / 3), 1e-6 * table.back());
  EXPECT_NEAR(table[2], CalcPressForce(disc, all / 6), 1e-6 * table.back());
  DiscSpring steep = disc;
  steep.cone_height = 1.6 * disc.thickness;
  const std::array<PressedPart, 2> snapping{disc, steep};
  EXPECT_TRUE(MakePressTable(snapping, all, 4).empty());
  EXPECT_EQ(MakePressTable(std::array<PressedPart, 1>{steep}, all, 4).size(), 5U);
  EXPECT_TRUE(MakePressTable({}, all, 4).empty());
}

}  // namespace
}  // namespace hvas::fits
