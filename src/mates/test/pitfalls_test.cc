#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <gtest/gtest.h>

#include "mates/infer.h"
#include "mates/test/test_product.h"
#include "product/features.h"

/** What real files do to the search for mates (N1), letter by letter, each on a made product. */
namespace hvas::mates {
namespace {

using product::FeatureKind;
using product::FitKind;
using product::Mate;
using product::MateKind;
using product::Part;
using product::Product;
using product::SurfaceKind;
using spatial::Pose;
using testing::AddCylinder;
using testing::AddOccurrence;
using testing::AddPart;
using testing::AddRectangle;
using testing::AddRoundFace;
using testing::CountMates;

Diagnostics InferInto(Product* product) {
  Diagnostics diagnostics;
  Infer(product, &diagnostics);
  return diagnostics;
}

int CountCode(const Diagnostics& diagnostics, const std::string& code) {
  return static_cast<int>(
      std::count_if(diagnostics.items().begin(), diagnostics.items().end(),
                    [&code](const Diagnostic& item) { return item.code == code; }));
}

/** A part of cylinder faces about z, each over an arc; its features are built from the faces. */
struct Arc {
  double begin, sweep, outward;
};

void AddArcs(Product* product, const std::string& name, double radius, const std::vector<Arc>& arcs,
             double low, double high) {
  Part* part = AddPart(product, name);
  for (const Arc& arc : arcs) {
    const product::FaceId id = AddRoundFace(part, radius, radius, low, high, arc.begin, arc.sweep);
    product::Face& face = part->faces[id.index()];
    face.surface = {SurfaceKind::kCylinder, Vec3::Zero(), Vec3::UnitZ(), radius, 0, arc.outward};
    face.area = radius * arc.sweep * (high - low);
  }
  product::BuildFeatures(part);
}

void AddInPlace(Product* product) {
  for (std::size_t i = 0; i < product->parts.size(); ++i) {
    AddOccurrence(product, product::PartId(i), Pose());
  }
}

/** A part with one hole or shaft along z. */
Part* AddRound(Product* product, const std::string& name, FeatureKind kind, double radius,
               double low, double high) {
  Part* part = AddPart(product, name);
  AddCylinder(part, kind, Vec3::Zero(), Vec3::UnitZ(), radius, low, high);
  return part;
}

TEST(PitfallA, AHoleInTwoHalvesAndAShaftInFourQuartersMakeOneMateWithItsFacingFaces) {
  Product product;
  AddArcs(&product, "housing", 5e-3,
          {{0, std::numbers::pi, -1}, {std::numbers::pi, std::numbers::pi, -1}}, 0, 20e-3);
  AddArcs(&product, "shaft", 5e-3,
          {{0, std::numbers::pi / 2, 1},
           {std::numbers::pi / 2, std::numbers::pi / 2, 1},
           {std::numbers::pi, std::numbers::pi / 2, 1},
           {1.5 * std::numbers::pi, std::numbers::pi / 2, 1}},
          5e-3, 40e-3);
  AddInPlace(&product);
  InferInto(&product);
  ASSERT_EQ(product.mates.size(), 1U);
  EXPECT_NEAR(product.mates[0].overlap, 15e-3, 1e-12);
  // Each half faces two quarters: X2 down to the surfaces.
  EXPECT_EQ(product.mates[0].surfaces.size(), 4U);
}

TEST(PitfallB, AFilletAndTheEndsOfASlotAreNoHolesButASplitClampIs) {
  Product product;
  AddArcs(&product, "fillet", 5e-3, {{0, std::numbers::pi / 2, -1}}, 0, 20e-3);
  AddArcs(&product, "slot end", 5e-3, {{0, std::numbers::pi, -1}}, 0, 20e-3);
  AddArcs(&product, "clamp", 5e-3, {{0.2, 2 * std::numbers::pi - 0.4, -1}}, 0, 20e-3);
  AddArcs(&product, "two jaws", 5e-3, {{-0.6, 1.2, -1}, {std::numbers::pi - 0.6, 1.2, -1}}, 0,
          20e-3);
  AddArcs(&product, "shaft", 5e-3, {{0, 2 * std::numbers::pi, 1}}, 0, 20e-3);
  AddInPlace(&product);
  InferInto(&product);
  ASSERT_EQ(CountMates(product, MateKind::kAxisHole), 2);
  EXPECT_EQ(product.mates[0].a.occurrence.index(), 2U);
  EXPECT_EQ(product.mates[1].a.occurrence.index(), 3U);
}

/** The ends of teeth on a cylinder about z, each over 6 degrees. */
void AddTeeth(Product* product, const std::string& name, int count, double radius, double outward) {
  std::vector<Arc> arcs;
  for (int i = 0; i < count; ++i) {
    arcs.push_back({2 * std::numbers::pi * i / count, std::numbers::pi / 30, outward});
  }
  AddArcs(product, name, radius, arcs, 0, 4e-3);
}

TEST(PitfallB, AHornOnTheTeethOfItsServoTurnsAboutThemAndAGearInABoreDoesNot) {
  struct Case {
    int hole_teeth;  // 0: smooth.
    double hole_mm;
    int shaft_teeth;
    double shaft_mm;
    bool is_mated;
  };

  for (const Case& c : {Case{25, 2.475, 25, 2.45, true}, Case{24, 2.475, 25, 2.45, false},
                        Case{25, 3.0, 0, 3.0, true}, Case{25, 3.2, 0, 3.0, false},
                        Case{0, 2.3, 25, 2.45, true}, Case{0, 20.05, 25, 20.0, false}}) {
    Product product;
    const Arc whole{0, 2 * std::numbers::pi, 1};
    if (c.hole_teeth > 0) {
      AddTeeth(&product, "horn", c.hole_teeth, 1e-3 * c.hole_mm, -1);
    } else {
      AddArcs(&product, "horn", 1e-3 * c.hole_mm, {{0, whole.sweep, -1}}, 0, 4e-3);
    }
    if (c.shaft_teeth > 0) {
      AddTeeth(&product, "servo", c.shaft_teeth, 1e-3 * c.shaft_mm, 1);
    } else {
      AddArcs(&product, "servo", 1e-3 * c.shaft_mm, {whole}, 0, 4e-3);
    }
    AddInPlace(&product);
    InferInto(&product);
    ASSERT_EQ(product.mates.size(), c.is_mated ? 1U : 0U)
        << c.hole_teeth << " in " << c.shaft_teeth;
    if (c.is_mated) {
      EXPECT_EQ(product.mates[0].fit->kind, FitKind::kInsert);
      EXPECT_EQ(product.joints[0].free_rotations, 1);
    }
  }
}

TEST(PitfallD, HolesInLineAreAnAlignmentUntilABoltPassesBoth) {
  Product product;
  AddRound(&product, "upper", FeatureKind::kHole, 2.75e-3, 0, 5e-3);
  AddRound(&product, "lower", FeatureKind::kHole, 2.5e-3, -5e-3, -0.5e-3);
  AddRectangle(&product.parts[0], Vec3::Zero(), -Vec3::UnitZ(), 20e-3, 20e-3);
  AddRectangle(&product.parts[1], Vec3::Zero(), Vec3::UnitZ(), 20e-3, 20e-3);
  AddInPlace(&product);
  InferInto(&product);
  EXPECT_EQ(CountMates(product, MateKind::kAxisHole), 0);
  ASSERT_EQ(product.alignments.size(), 1U);
  EXPECT_EQ(product.alignments[0].a.occurrence.index(), 0U);
  EXPECT_EQ(product.alignments[0].b.occurrence.index(), 1U);
  EXPECT_LT(product.alignments[0].a.X_BM.p().head<2>().norm(), 1e-15);
  AddRound(&product, "bolt M5", FeatureKind::kShaft, 2.5e-3, -5e-3, 8e-3);
  AddOccurrence(&product, product::PartId(2), Pose());
  InferInto(&product);
  EXPECT_EQ(CountMates(product, MateKind::kAxisHole), 2);
  EXPECT_TRUE(product.alignments.empty());
}

TEST(PitfallE, AScrewWithShankThreadAndHeadHasOneMateWithItsHoleOnTheWorkingDiameter) {
  Product product;
  Part* plate = AddRound(&product, "plate", FeatureKind::kHole, 1.7e-3, 0, 10e-3);
  AddCylinder(plate, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 3.2e-3, 10e-3, 13e-3);
  Part* screw = AddRound(&product, "SHCS M3x16", FeatureKind::kShaft, 1.5e-3, -6e-3, 4e-3);
  AddCylinder(screw, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 1.45e-3, 4e-3, 5e-3);
  AddCylinder(screw, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 1.55e-3, 5e-3, 10e-3);
  AddCylinder(screw, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 2.75e-3, 10e-3, 13e-3);
  AddInPlace(&product);
  InferInto(&product);
  ASSERT_EQ(product.mates.size(), 1U);
  EXPECT_DOUBLE_EQ(product.mates[0].shaft_radius, 1.55e-3);
  EXPECT_DOUBLE_EQ(product.mates[0].hole_radius, 1.7e-3);
}

struct Tapped {
  const char* screw;
  const char* plate;
  double shaft, hole;  // Radii [m].
  product::ThreadKind hole_thread;
};

class PitfallF : public ::testing::TestWithParam<Tapped> {};

TEST(PitfallE, APinThroughSeveralBoresOfOnePartHasAMateWithEachOfThem) {
  Product product;
  Part* leaf = AddRound(&product, "leaf with two knuckles", FeatureKind::kHole, 2e-3, 0, 20e-3);
  AddCylinder(leaf, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 2e-3, 40e-3, 60e-3);
  // A passage that is wider by more than the bores differ does not guide beside them.
  AddCylinder(leaf, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 2.2e-3, 65e-3, 80e-3);
  AddRound(&product, "pin", FeatureKind::kShaft, 2e-3, -1e-3, 90e-3);
  AddInPlace(&product);
  InferInto(&product);
  ASSERT_EQ(CountMates(product, MateKind::kAxisHole), 2);
  EXPECT_NEAR(product.mates[0].overlap, 20e-3, 1e-12);
  EXPECT_NEAR(product.mates[1].overlap, 20e-3, 1e-12);
  EXPECT_NE(product.mates[0].a.feature, product.mates[1].a.feature);
}

TEST_P(PitfallF, AScrewInATappedHoleIsAThreadNeverAPressFit) {
  const Tapped& tapped = GetParam();
  Product product;
  AddRound(&product, tapped.plate, FeatureKind::kHole, tapped.hole, 0, 10e-3);
  product.parts[0].features[0].thread = tapped.hole_thread;
  AddRound(&product, tapped.screw, FeatureKind::kShaft, tapped.shaft, 2e-3, 20e-3);
  AddInPlace(&product);
  const Diagnostics diagnostics = InferInto(&product);
  ASSERT_EQ(product.mates.size(), 1U);
  ASSERT_TRUE(product.mates[0].fit.has_value());
  EXPECT_EQ(product.mates[0].fit->kind, FitKind::kThread) << product.mates[0].fit->reason;
  EXPECT_EQ(CountCode(diagnostics, "drawn-interference"), 0);
}

constexpr auto kPlain = product::ThreadKind::kNone;

INSTANTIATE_TEST_SUITE_P(
    DrawnAnyhow, PitfallF,
    ::testing::Values(Tapped{"M3 screw", "plate", 1.5e-3, 1.25e-3, kPlain},
                      Tapped{"DIN 912", "plate", 1.5e-3, 1.5e-3, kPlain},
                      Tapped{"M20 bolt", "plate", 10e-3, 9.99e-3, kPlain},
                      Tapped{"part 7", "plate", 1.5e-3, 1.25e-3, kPlain},
                      Tapped{"part 7", "plate", 10e-3, 9.9e-3, product::ThreadKind::kNominal},
                      Tapped{"M3 screw", "plate", 1.5e-3, 1.52e-3, product::ThreadKind::kModelled},
                      Tapped{"M3 screw", "heat-set insert", 1.5e-3, 1.6e-3, kPlain}));

/** A shaft and a hole of radii in mm by their names. */
Product MakeShaftInHole(const char* shaft_name, double shaft_mm, const char* hole_name,
                        double hole_mm) {
  Product product;
  AddRound(&product, hole_name, FeatureKind::kHole, 1e-3 * hole_mm, 0, 6e-3);
  AddRound(&product, shaft_name, FeatureKind::kShaft, 1e-3 * shaft_mm, -2e-3, 5e-3);
  AddInPlace(&product);
  return product;
}

TEST(PitfallF, WhatIsMeltedInGivesOrPassesHasNoFitOfIso286) {
  struct Case {
    const char* shaft;
    double shaft_mm;
    const char* hole;
    double hole_mm;
    FitKind kind;
  };

  for (const Case& c : {Case{"threaded insert", 2.3, "plate", 2.29, FitKind::kInsert},
                        Case{"heat-set M3", 2.3, "plate", 2.0, FitKind::kInsert},
                        Case{"Heatset insert", 2.3, "plate", 2.3, FitKind::kInsert},
                        Case{"heat set M3", 2.3, "plate", 2.35, FitKind::kInsert},
                        Case{"heat set M3", 2.3, "plate", 2.8, FitKind::kPassage},
                        Case{"cable 3x0.75", 3.0, "gland", 3.0, FitKind::kInsert},
                        Case{"rod", 3.0, "cable clip", 2.9, FitKind::kInsert},
                        Case{"hose", 3.0, "plate", 3.5, FitKind::kPassage},
                        Case{"M3 screw", 1.5, "plate", 1.7, FitKind::kPassage},
                        Case{"M3 screw", 1.5, "washer", 1.6, FitKind::kPassage},
                        Case{"pin", 1.5, "plate", 1.505, FitKind::kClearance},
                        Case{"pin", 1.5, "plate", 1.495, FitKind::kInterference}}) {
    Product product = MakeShaftInHole(c.shaft, c.shaft_mm, c.hole, c.hole_mm);
    const Diagnostics diagnostics = InferInto(&product);
    ASSERT_EQ(product.mates.size(), 1U) << c.shaft;
    ASSERT_TRUE(product.mates[0].fit.has_value());
    EXPECT_EQ(product.mates[0].fit->kind, c.kind) << c.shaft << " in " << c.hole;
    EXPECT_EQ(product.mates[0].fit->code.empty(), !product::IsIsoFit(c.kind)) << c.shaft;
    EXPECT_EQ(CountCode(diagnostics, "drawn-interference"), c.kind == FitKind::kInterference);
  }
}

TEST(PitfallF, ANamelessHollowPartInATooSmallHoleIsAnInsertAndASolidOneAThread) {
  for (const double bore_mm : {1.25, 0.0}) {
    Product product = MakeShaftInHole("part 7", 2.3, "plate", 2.0);
    if (bore_mm > 0) {
      AddCylinder(&product.parts[1], FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(),
                  1e-3 * bore_mm, -2e-3, 5e-3);
    }
    InferInto(&product);
    ASSERT_EQ(product.mates.size(), 1U);
    EXPECT_EQ(product.mates[0].fit->kind, bore_mm > 0 ? FitKind::kInsert : FitKind::kThread);
  }
}

TEST(PitfallF, APinMuchSmallerThanItsHoleIsNoMateAndACoarseClearanceHoleIs) {
  // ISO 273, coarse: 1.3 for M1, 2.6 for M2, 3.6 for M3, 12 for M10.
  for (const auto& [shaft_mm, hole_mm, expected] :
       {std::tuple(0.5, 1.0, 0U), std::tuple(0.25, 0.5, 0U), std::tuple(0.4, 0.65, 0U),
        std::tuple(0.5, 0.65, 1U), std::tuple(1.0, 1.3, 1U), std::tuple(1.5, 1.8, 1U),
        std::tuple(5.0, 6.0, 1U)}) {
    Product product = MakeShaftInHole("pin", shaft_mm, "plate", hole_mm);
    InferInto(&product);
    EXPECT_EQ(product.mates.size(), expected) << shaft_mm;
  }
}

TEST(PitfallE, AShortPilotCentresAFlangeAndTheWideHoleForTheShaftDoesNot) {
  Product product;
  Part* flange = AddRound(&product, "flange", FeatureKind::kHole, 11e-3, 0, 2e-3);
  AddCylinder(flange, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 3e-3, 2e-3, 8e-3);
  Part* motor = AddRound(&product, "motor", FeatureKind::kShaft, 11e-3, -20e-3, 2e-3);
  AddCylinder(motor, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 2.5e-3, 2e-3, 24e-3);
  AddInPlace(&product);
  InferInto(&product);
  ASSERT_EQ(CountMates(product, MateKind::kAxisHole), 1);
  EXPECT_DOUBLE_EQ(product.mates[0].shaft_radius, 11e-3);
}

/** A hexagon of flats about z, outside (+1) or as a socket (-1). */
void AddHexagon(Part* part, double across, double sense, double low, double high) {
  for (int i = 0; i < 6; ++i) {
    const double angle = std::numbers::pi / 3 * i;
    const Vec3 n(std::cos(angle), std::sin(angle), 0);
    AddRectangle(part, Vec3(0.5 * across * n + Vec3(0, 0, 0.5 * (low + high))), sense * n,
                 0.5 * (high - low), 0.25 * across);
  }
}

TEST(PitfallF, AHexagonMakesAScrewOfANamelessPart) {
  for (const double sense : {1.0, -1.0}) {
    Product product;
    AddRound(&product, "block", FeatureKind::kHole, 9.95e-3, 0, 30e-3);
    Part* screw = AddRound(&product, "part 7", FeatureKind::kShaft, 10e-3, 5e-3, 60e-3);
    AddHexagon(screw, sense > 0 ? 30e-3 : 14e-3, sense, 60e-3, 70e-3);
    AddInPlace(&product);
    InferInto(&product);
    ASSERT_EQ(CountMates(product, MateKind::kAxisHole), 1);
    EXPECT_EQ(product.mates[0].fit->kind, FitKind::kThread);
  }
  // Without one the same drawing is a press fit.
  Product pin;
  AddRound(&pin, "block", FeatureKind::kHole, 9.95e-3, 0, 30e-3);
  AddRound(&pin, "part 7", FeatureKind::kShaft, 10e-3, 5e-3, 60e-3);
  AddInPlace(&pin);
  InferInto(&pin);
  EXPECT_EQ(pin.mates[0].fit->kind, FitKind::kInterference);
}

TEST(PitfallF, AHexagonalPocketMakesNoNutAndABoreWithSixFlatsNoScrew) {
  // A holder with a pocket for a nut around a clearance hole; a bolt goes through it.
  Product pocket;
  Part* holder = AddRound(&pocket, "part 1", FeatureKind::kHole, 4.2e-3, 0, 5e-3);
  AddHexagon(holder, 13.2e-3, -1, 5e-3, 12e-3);
  AddRound(&pocket, "bolt M8x20", FeatureKind::kShaft, 4e-3, -5e-3, 15e-3);
  AddInPlace(&pocket);
  InferInto(&pocket);
  ASSERT_EQ(CountMates(pocket, MateKind::kAxisHole), 1);
  EXPECT_EQ(pocket.mates[0].fit->kind, FitKind::kPassage);
  // A ring whose bore has six flats all along is in its seat by a fit.
  Product seat;
  AddRound(&seat, "part 1", FeatureKind::kHole, 14.29e-3, 0, 6e-3);
  Part* ring = AddRound(&seat, "part 2", FeatureKind::kShaft, 14.28e-3, 0, 6.35e-3);
  AddHexagon(ring, 12.7e-3, -1, 0, 6.35e-3);
  AddInPlace(&seat);
  InferInto(&seat);
  ASSERT_EQ(CountMates(seat, MateKind::kAxisHole), 1);
  EXPECT_EQ(seat.mates[0].fit->kind, FitKind::kClearance);
}

TEST(PitfallF, AHexagonWithAThreadInItsBoreIsANutAndOneWithAPlainBoreIsNot) {
  for (const bool is_threaded : {true, false}) {
    Product product;
    Part* nut = AddRound(&product, "part 1", FeatureKind::kHole, 4e-3, 0, 6.8e-3);
    AddHexagon(nut, 13e-3, 1, 0, 6.8e-3);
    nut->features[0].thread =
        is_threaded ? product::ThreadKind::kNominal : product::ThreadKind::kNone;
    AddRound(&product, "part 2", FeatureKind::kShaft, 4e-3, -5e-3, 15e-3);
    AddInPlace(&product);
    InferInto(&product);
    ASSERT_EQ(CountMates(product, MateKind::kAxisHole), 1);
    EXPECT_EQ(product.mates[0].fit->kind, is_threaded ? FitKind::kThread : FitKind::kClearance);
  }
}

TEST(PitfallG, NeitherABushingBetweenNorATubeAroundATubeIsPassedOver) {
  Product bushed;
  AddRound(&bushed, "housing", FeatureKind::kHole, 10e-3, 0, 40e-3);
  Part* bushing = AddRound(&bushed, "bushing", FeatureKind::kShaft, 10e-3, 0, 40e-3);
  AddCylinder(bushing, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 8e-3, 0, 40e-3);
  AddRound(&bushed, "shaft", FeatureKind::kShaft, 8e-3, -10e-3, 50e-3);
  AddInPlace(&bushed);
  InferInto(&bushed);
  EXPECT_EQ(bushed.mates.size(), 2U);
  // The inner tube's bore and the outer tube's outside do not touch, near as their radii are.
  Product tubes;
  Part* inner = AddRound(&tubes, "inner", FeatureKind::kHole, 67e-3, 0, 30e-3);
  AddCylinder(inner, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 68e-3, 0, 30e-3);
  Part* outer = AddRound(&tubes, "outer", FeatureKind::kHole, 72e-3, 0, 30e-3);
  AddCylinder(outer, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 73e-3, 0, 30e-3);
  AddInPlace(&tubes);
  InferInto(&tubes);
  ASSERT_EQ(tubes.mates.size(), 1U);
  EXPECT_DOUBLE_EQ(tubes.mates[0].hole_radius, 72e-3);
  EXPECT_DOUBLE_EQ(tubes.mates[0].shaft_radius, 68e-3);
}

TEST(PitfallH, PadsOnABoardMakeOneMateForAChipAndSliversNone) {
  Product product;
  Part* board = AddPart(&product, "board");
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      AddRectangle(board, Vec3(1e-3 * i, 1e-3 * j, 0), Vec3::UnitZ(), 0.3e-3, 0.3e-3);
    }
  }
  Part* chip = AddPart(&product, "chip");
  for (int i = 0; i < 8; ++i) {
    AddRectangle(chip, Vec3(1e-3 * i, 0, 0), -Vec3::UnitZ(), 0.2e-3, 0.2e-3);
  }
  Part* shield = AddPart(&product, "shield");  // Touches along a sliver of 0.5 um.
  AddRectangle(shield, Vec3(10e-3, 19.3e-3 + 5e-3 - 0.5e-6, 0), -Vec3::UnitZ(), 15e-3, 5e-3);
  AddInPlace(&product);
  InferInto(&product);
  ASSERT_EQ(product.mates.size(), 1U);
  EXPECT_EQ(product.mates[0].b.occurrence.index(), 1U);
  EXPECT_NEAR(product.mates[0].overlap, 8 * 0.16e-6, 1e-12);
  EXPECT_EQ(product.mates[0].surfaces.size(), 8U);
}

TEST(PitfallI, FloatingAndSunkenPartsAreToldAndNothingIsMoved) {
  Product product;
  AddPart(&product, "plate");
  AddRectangle(&product.parts[0], Vec3::Zero(), Vec3::UnitZ(), 50e-3, 50e-3);
  AddPart(&product, "nut");
  AddRectangle(&product.parts[1], Vec3::Zero(), -Vec3::UnitZ(), 5e-3, 5e-3);
  AddRectangle(&product.parts[1], Vec3(0, 0, 4e-3), Vec3::UnitZ(), 5e-3, 5e-3);
  const std::vector<double> heights{0, 80e-6, -100e-6, -60e-6, 30e-3};
  AddOccurrence(&product, product::PartId(0), Pose());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    AddOccurrence(&product, product::PartId(1),
                  Pose(Vec3(-40e-3 + 20e-3 * static_cast<double>(i), 0, heights[i])));
  }
  const std::vector<product::Occurrence> drawn = product.occurrences;
  const Diagnostics diagnostics = InferInto(&product);
  EXPECT_EQ(product.mates.size(), 1U);
  EXPECT_EQ(CountCode(diagnostics, "no-mate"), 4);
  EXPECT_EQ(CountCode(diagnostics, "drawn-overlap"), 1);  // Both sunken nuts in one line.
  bool tells_depth = false;
  bool tells_gap = false;
  for (const Diagnostic& item : diagnostics.items()) {
    tells_depth |= item.message.find("0.100 mm into") != std::string::npos &&
                   item.message.find("and 1 more") != std::string::npos;
    tells_gap |=
        item.entity == drawn[2].path && item.message.find("0.080 mm away") != std::string::npos;
  }
  EXPECT_TRUE(tells_depth);
  EXPECT_TRUE(tells_gap);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    EXPECT_EQ(product.occurrences[i].X_WB.p(), drawn[i].X_WB.p());
  }
}

TEST(PitfallJ, AShaftInAShaftAndAHoleInAHoleAreNoMates) {
  for (const FeatureKind kind : {FeatureKind::kHole, FeatureKind::kShaft}) {
    Product product;
    AddRound(&product, "one", kind, 5e-3, 0, 20e-3);
    AddRound(&product, "other", kind, 5e-3, 0, 20e-3);
    AddInPlace(&product);
    InferInto(&product);
    EXPECT_TRUE(product.mates.empty());
    EXPECT_TRUE(product.alignments.empty());  // In each other, not behind each other.
  }
}

TEST(PitfallK, AMotorDrawnAThousandTimesTooLargeHasTheMatesOfTheRealOne) {
  for (const double scale : {1.0, 1e3}) {
    Product product;
    Part* housing =
        AddRound(&product, "housing", FeatureKind::kHole, scale * 8e-3, 0, scale * 20e-3);
    AddRectangle(housing, Vec3(0, 0, scale * 20e-3), Vec3::UnitZ(), scale * 30e-3, scale * 30e-3);
    Part* rotor =
        AddRound(&product, "rotor", FeatureKind::kShaft, scale * 7.99e-3, 0, scale * 40e-3);
    // A little beside the axis and above the face, in proportion to its size.
    AddRectangle(rotor, Vec3(0, 0, scale * 20.0005e-3), -Vec3::UnitZ(), scale * 10e-3,
                 scale * 10e-3);
    AddOccurrence(&product, product::PartId(0), Pose());
    AddOccurrence(&product, product::PartId(1), Pose(Vec3(scale * 1e-6, 0, 0)));
    InferInto(&product);
    EXPECT_EQ(CountMates(product, MateKind::kAxisHole), 1) << scale;
    EXPECT_EQ(CountMates(product, MateKind::kFaceFace), 1) << scale;
  }
}

}  // namespace
}  // namespace hvas::mates
