#include "sequence/fit_of_mate.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "fits/iso286.h"
#include "fits/press_fit.h"

namespace hvas::sequence {
namespace {

using product::FitKind;
using product::Product;

constexpr double kRadius = 20e-3;  // W7's rig
constexpr double kHub = 40e-3;
constexpr double kMateLength = 50e-3;

/** A bore of W7's size in a hub, and a shaft, as features only. */
Product Rig(const std::string& code) {
  Product product;
  product.parts.resize(2);
  product::Part& hub = product.parts[0];
  hub.box_B.Add(Vec3(-kHub, -kHub, 0));
  hub.box_B.Add(Vec3(kHub, kHub, kMateLength));
  product::Feature bore;
  bore.kind = product::FeatureKind::kHole;
  bore.radius = kRadius;
  hub.features.push_back(bore);
  product.parts[1].features.resize(1);
  for (std::size_t i = 0; i < 2; ++i) {
    product::Occurrence occurrence;
    occurrence.id = product::OccurrenceId(i);
    occurrence.part = product::PartId(i);
    product.occurrences.push_back(occurrence);
  }
  product::Mate mate;
  mate.id = product::MateId(0);
  mate.kind = product::MateKind::kAxisHole;
  mate.a = {product::OccurrenceId(0), product::FeatureId(0), {}};
  mate.b = {product::OccurrenceId(1), product::FeatureId(0), {}};
  mate.hole_radius = mate.shaft_radius = kRadius;
  mate.overlap = kMateLength;
  mate.fit = product::Fit{FitKind::kInterference, code, 2 * kRadius, false, "for the test"};
  product.mates.push_back(mate);
  return product;
}

std::shared_ptr<const fits::FitForce> Make(const Product& product, std::uint64_t seed,
                                           Diagnostics* diagnostics = nullptr,
                                           fits::PairChoice pairs = fits::PairChoice::kAny) {
  Diagnostics own;
  return MakeFitForce(product, product.mates[0], seed, pairs,
                      diagnostics == nullptr ? &own : diagnostics);
}

/** The least and the most clearance, in diameter, of 300 seeds [m]. */
std::pair<double, double> CalcClearances(const Product& product) {
  double least = 1;
  double most = -1;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const double clearance = 2 * Make(product, seed)->mean_clearance();
    least = std::min(least, clearance);
    most = std::max(most, clearance);
  }
  return {least, most};
}

TEST(MakeFitForceTest, W2EqualSeedsDrawEqualSizesAndOthersOthers) {
  const Product product = Rig("H7/k6");
  std::set<double> clearances;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto first = Make(product, seed);
    const auto second = Make(product, seed);
    ASSERT_NE(first, nullptr);
    EXPECT_EQ(first->mean_clearance(), second->mean_clearance());
    for (double depth = 0; depth <= kMateLength; depth += 1e-3) {
      EXPECT_EQ(first->CalcClearance(depth), second->CalcClearance(depth));
      EXPECT_EQ(first->CalcAxialResistance(depth), second->CalcAxialResistance(depth));
    }
    clearances.insert(std::round(first->mean_clearance() * 1e8));
  }
  EXPECT_GT(clearances.size(), 10u);  // of about 40 half micrometres
}

TEST(MakeFitForceTest, W2SizesStayWithinTheZonesOfTheStandard) {  // W3
  for (const char* code : {"H7/g6", "H7/k6", "H7/p6"}) {
    const auto limits = fits::CalcFitLimits(*fits::ParseFit(code), 2 * kRadius);
    ASSERT_TRUE(limits.has_value());
    const auto [least, most] = CalcClearances(Rig(code));
    EXPECT_GE(least, limits->min_clearance - 1e-9) << code;
    EXPECT_LE(most, limits->max_clearance + 1e-9) << code;
    // And they fill them: normal with a sixth of each zone.
    EXPECT_GT(most - least, 0.4 * (limits->max_clearance - limits->min_clearance)) << code;
  }
}

TEST(MakeFitForceTest, MatesOfOneProductDrawTheirOwnSizes) {
  Product product = Rig("H7/k6");
  product.mates.push_back(product.mates[0]);
  product.mates[1].id = product::MateId(1);
  Diagnostics diagnostics;
  int equal = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    equal += MakeFitForce(product, product.mates[0], seed, fits::PairChoice::kAny, &diagnostics)
                         ->CalcClearance(0) == MakeFitForce(product, product.mates[1], seed,
                                                            fits::PairChoice::kAny, &diagnostics)
                                                   ->CalcClearance(0)
                 ? 1
                 : 0;
  }
  EXPECT_EQ(equal, 0);
}

/** 1 - c_0^2 as W(7) has it, from a pressure and the interference there. */
double MeasureWallTerm(const fits::FitForce& fit) {
  constexpr double kYoung = 210e9;
  for (double depth = 0; depth <= kMateLength; depth += 0.1e-3) {
    if (fit.CalcClearance(depth) < -1e-6) {
      return fit.CalcPressure(depth) / -fit.CalcClearance(depth) * 2 * kRadius / kYoung;
    }
  }
  return std::nan("");
}

TEST(MakeFitForceTest, WallOfTheHubComesFromItsOutsideOrFromItsBox) {  // W(7)
  Product product = Rig("H7/p6");
  // No outside cylinder: half the width of the box across the bore.
  EXPECT_NEAR(MeasureWallTerm(*Make(product, 3)), 1 - std::pow(kRadius / kHub, 2), 1e-9);
  // A coaxial outside: its radius; a cylinder elsewhere does not count.
  product::Feature outside;
  outside.kind = product::FeatureKind::kShaft;
  outside.radius = 30e-3;
  product.parts[0].features.push_back(outside);
  product::Feature aside = outside;
  aside.radius = 25e-3;
  aside.origin_B = Vec3(10e-3, 0, 0);
  product.parts[0].features.push_back(aside);
  EXPECT_NEAR(MeasureWallTerm(*Make(product, 3)), 1 - std::pow(kRadius / 30e-3, 2), 1e-9);
}

TEST(MakeFitForceTest, MeasuredSizesReplaceThoseDrawnByChance) {
  Product product = Rig("H7/k6");
  product.mates[0].conditions.hole_diameters = {{0, 40.012e-3}};
  product.mates[0].conditions.shaft_diameters = {{0, 40.031e-3}};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_NEAR(Make(product, seed)->mean_clearance(), 0.5 * (40.012e-3 - 40.031e-3), 1e-15);
  }
  // One side alone leaves the other's chance as it is.
  const Product free = Rig("H7/k6");
  product.mates[0].conditions.shaft_diameters.clear();
  Product shaft_only = Rig("H7/k6");
  shaft_only.mates[0].conditions.shaft_diameters = {{0, 40.031e-3}};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    // (D - d)/2 with both free is that with each free, without what is measured twice.
    EXPECT_NEAR(Make(free, seed)->mean_clearance(),
                Make(product, seed)->mean_clearance() + Make(shaft_only, seed)->mean_clearance() -
                    0.5 * (40.012e-3 - 40.031e-3),
                1e-15);
  }
  // They need no code.
  product = Rig("");
  product.mates[0].conditions.hole_diameters = {{0, 40.02e-3}};
  EXPECT_NEAR(Make(product, 1)->mean_clearance(), 0.01e-3, 1e-15);
}

TEST(MakeFitForceTest, W3ClassOfOneSideLeavesTheOtherAsDrawn) {
  const double it7 = 25e-6;  // ISO 286-1, 30 to 50 mm
  for (const bool is_hole : {true, false}) {
    const auto [least, most] = CalcClearances(Rig(is_hole ? "H7" : "h7"));
    EXPECT_GE(least, -1e-12);
    EXPECT_LE(most, it7 + 1e-12);
    EXPECT_GT(most - least, 0.5 * it7);
  }
}

TEST(MakeFitForceTest, TemperatureExpandsEachSideByItsMaterial) {
  Product product = Rig("H7/p6");
  product.parts[0].material.thermal_expansion = 23e-6;  // aluminium
  product.parts[1].material.thermal_expansion = 12e-6;  // steel
  product.mates[0].conditions.hole_diameters = {{0, 40e-3}};
  product.mates[0].conditions.shaft_diameters = {{0, 40e-3}};
  EXPECT_EQ(Make(product, 1)->mean_clearance(), 0);
  product.mates[0].conditions.hole_temperature_c = 120;
  EXPECT_NEAR(2 * Make(product, 1)->mean_clearance(), 40e-3 * 23e-6 * 100, 1e-12);
  product.mates[0].conditions.shaft_temperature_c = -180;  // in liquid nitrogen
  EXPECT_NEAR(2 * Make(product, 1)->mean_clearance(), 40e-3 * (23e-6 * 100 + 12e-6 * 200), 1e-12);
  // A hole hot enough lets a pressed shaft slide in.
  product = Rig("H7/p6");
  EXPECT_GT(Make(product, 2)->max_resistance(), 1000);
  product.mates[0].conditions.hole_temperature_c = 250;
  EXPECT_EQ(Make(product, 2)->max_resistance(), 0);
}

TEST(MakeFitForceTest, FrictionScalesTheForceAndRoughnessTheClearance) {  // W(4), W(8)
  Product product = Rig("H7/p6");
  product.mates[0].conditions.hole_diameters = {{0, 40e-3}};
  product.mates[0].conditions.shaft_diameters = {{0, 40.04e-3}};
  const auto usual = Make(product, 4);
  product.mates[0].conditions.friction = 0.3;  // twice the default
  const auto rough = Make(product, 4);
  EXPECT_NEAR(rough->max_resistance() / usual->max_resistance(), 2, 1e-12);
  const auto amplitude = [](const fits::FitForce& fit) {
    double most = 0;
    for (double depth = 0; depth <= kMateLength; depth += 0.1e-3) {
      most = std::max(most, std::abs(fit.CalcClearance(depth) - fit.mean_clearance()));
    }
    return most;
  };
  product.mates[0].conditions.hole_roughness = 2e-6;
  product.mates[0].conditions.shaft_roughness = 4.3e-6;
  // The mean of both, half of the default 6.3 um, on the same profile.
  EXPECT_NEAR(amplitude(*Make(product, 4)) / amplitude(*usual), 0.5, 1e-9);
  product.mates[0].conditions.hole_roughness = product.mates[0].conditions.shaft_roughness = 0;
  EXPECT_NEAR(amplitude(*Make(product, 4)), 0, 1e-18);
}

// N5: two materials and a hollow shaft: the force is that of the press fit, to nine digits.
TEST(MakeFitForceTest, MaterialsAndABoreMakeThePressFitOfThePair) {
  Product product = Rig("H7/p6");
  product.mates[0].conditions.hole_diameters = {{0, 40e-3}};
  product.mates[0].conditions.shaft_diameters = {{0, 40.04e-3}};
  product.mates[0].conditions.hole_roughness = product.mates[0].conditions.shaft_roughness = 0;
  product.mates[0].conditions.friction = 0.12;
  product.parts[0].material.youngs_modulus = 110e9;
  product.parts[0].material.poisson_ratio = 0.28;
  product::Feature& shaft = product.parts[1].features[0];
  shaft.kind = product::FeatureKind::kShaft;
  shaft.radius = kRadius;
  shaft.span_high = kMateLength;
  fits::PressFitParameters press;
  press.joint_diameter = 2 * kRadius;
  press.hub_diameter = 2 * kHub;
  press.length = kMateLength;
  press.interference = 0.04e-3;
  press.hub.youngs_modulus = 110e9;
  press.hub.poisson_ratio = 0.28;
  press.friction_in = press.friction_release = 0.12;
  for (const double bore : {0.0, 6e-3}) {
    if (bore > 0) {
      product::Feature hole = shaft;
      hole.kind = product::FeatureKind::kHole;
      hole.radius = bore;
      hole.axis_B = -Vec3::UnitZ();
      hole.span_low = -1.2 * kMateLength;
      hole.span_high = 0;
      product.parts[1].features.push_back(hole);
      hole.radius = 10e-3;  // A short one at its end does not make it hollow.
      hole.span_low = -0.2 * kMateLength;
      product.parts[1].features.push_back(hole);
    }
    press.shaft_bore = 2 * bore;
    const fits::PressFit closed = *fits::CalcPressFit(press);
    const auto fit = Make(product, 1);
    ASSERT_NE(fit, nullptr);
    EXPECT_NEAR(fit->CalcAxialResistance(kMateLength) / closed.press_in_force, 1, 1e-9) << bore;
    EXPECT_NEAR(fit->CalcReleaseForce(kMateLength) / closed.push_out_force, 1, 1e-9) << bore;
  }
}

// Nobody states a friction: that of steel on bronze breaks loose harder than it slides.
TEST(MakeFitForceTest, FrictionOfAPairOfMaterialsComesFromTheTable) {
  Product product = Rig("H7/p6");
  product.parts[0].material.standard = "CuSn8";
  product.parts[1].material.standard = "S235JR";
  const fits::FrictionLaw law =
      fits::FindFriction(fits::FrictionSurface::kCopperAlloy, fits::FrictionSurface::kSteel, {});
  ASSERT_GT(law.static_coefficient, law.kinetic_coefficient);
  const auto fit = Make(product, 3);
  const double normal = fit->CalcNormalForce(kMateLength);
  ASSERT_GT(normal, 1000);
  EXPECT_NEAR(fit->CalcAxialResistance(kMateLength), law.static_coefficient * normal,
              1e-9 * normal);
  EXPECT_NEAR(fit->CalcReleaseForce(kMateLength), law.static_coefficient * normal, 1e-9 * normal);
  EXPECT_NEAR(fit->CalcReleaseForce(kMateLength, 1), law.kinetic_coefficient * normal,
              1e-9 * normal);
}

// A chamfer at the end of the shaft is felt before the edge is in, one in its middle is not.
TEST(MakeFitForceTest, ChamferOfTheShaftLeadsIn) {
  Product product = Rig("H7/p6");
  product::Feature& shaft = product.parts[1].features[0];
  shaft.kind = product::FeatureKind::kShaft;
  shaft.radius = kRadius;
  shaft.span_high = kMateLength;
  EXPECT_EQ(Make(product, 3)->CalcAxialResistance(-1e-6), 0);
  product::Form chamfer;
  chamfer.kind = product::FormKind::kChamfer;
  chamfer.angle = 0.6;  // Included.
  chamfer.depth = 1e-3;
  chamfer.origin_B = Vec3(0, 0, 0.5 * kMateLength);
  product.parts[1].forms = {chamfer};
  EXPECT_EQ(Make(product, 3)->CalcAxialResistance(-1e-6), 0);
  product.parts[1].forms[0].origin_B = Vec3(0, 0, -0.5e-3);
  EXPECT_GT(Make(product, 3)->CalcAxialResistance(-1e-6), 1);
}

TEST(MakeFitForceTest, PlanesThreadsAndMatesWithoutACodeHaveNoFitForce) {
  Diagnostics diagnostics;
  Product product = Rig("");
  EXPECT_EQ(Make(product, 1, &diagnostics), nullptr);
  product = Rig("H7/p6");
  product.mates[0].fit->kind = FitKind::kThread;
  EXPECT_EQ(Make(product, 1, &diagnostics), nullptr);
  product.mates[0].fit.reset();
  product.mates[0].kind = product::MateKind::kFaceFace;
  EXPECT_EQ(Make(product, 1, &diagnostics), nullptr);
  EXPECT_TRUE(diagnostics.items().empty());
}

TEST(MakeFitForceTest, UndefinedCodeOrSizeGivesADiagnosticWithARemedy) {
  Product too_large = Rig("H7/p6");
  too_large.mates[0].fit->nominal_diameter = 5;  // [m]; the standard ends at 3.15 m
  for (const Product& product : {Rig("H7/zz9"), Rig("H77"), Rig("press"), too_large}) {
    Diagnostics diagnostics;
    EXPECT_EQ(Make(product, 1, &diagnostics), nullptr);
    ASSERT_EQ(diagnostics.items().size(), 1u);
    const Diagnostic& item = diagnostics.items()[0];
    EXPECT_EQ(item.severity, Severity::kWarning);
    EXPECT_EQ(item.code, "fit-undefined");
    EXPECT_EQ(item.entity, "mate m0");
    EXPECT_FALSE(item.message.empty());
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--fit", item.remedy);
  }
}

}  // namespace
}  // namespace hvas::sequence
