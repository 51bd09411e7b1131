#include "mates/propose_fit.h"

#include <gtest/gtest.h>

namespace hvas::mates {
namespace {

using product::FitKind;

TEST(ClassifyName, ReadsTheNamesOfRealLibraries) {
  for (const char* name : {"Screw", "hex-bolt_2", "BOLTS", "M3x16", "BHCS M4 x 8", "DIN 912 - 20",
                           "ISO4762", "iso_7380 M3", "STAR_SCREW M2", "SHCS_M2.5X6"}) {
    EXPECT_EQ(ClassifyName(name), FastenerKind::kScrew) << name;
  }
  for (const char* name :
       {"nut", "NUT_M2", "Hex Nut M10", "heat-set M3", "Heatset insert", "DIN934", "ISO 4032 M5"}) {
    EXPECT_EQ(ClassifyName(name), FastenerKind::kNut) << name;
  }
  for (const char* name : {"plate", "minute hand", "donut", "rod", "MR126ZZ", "arm3", "Motor",
                           "M5stack", "washer M5", "ISO 286", "DIN 9120", ""}) {
    EXPECT_EQ(ClassifyName(name), FastenerKind::kNone) << name;
  }
}

TEST(ProposeFit, FollowsItsTable) {
  const auto propose = [](double hole_mm, double shaft_mm, FastenerKind hole = FastenerKind::kNone,
                          FastenerKind shaft = FastenerKind::kNone, bool nut_on_shaft = false) {
    return ProposeFit({hole_mm / 2e3, shaft_mm / 2e3, hole, shaft, nut_on_shaft});
  };
  EXPECT_EQ(propose(40, 40).code, "H7/g6");
  EXPECT_EQ(propose(40, 40).kind, FitKind::kClearance);
  EXPECT_DOUBLE_EQ(propose(40, 40).nominal_diameter, 0.04);
  EXPECT_EQ(propose(40.03, 40).code, "H7/g6");
  EXPECT_EQ(propose(40.08, 40).code, "H8/f7");
  EXPECT_EQ(propose(40.15, 40).code, "H9/d9");
  EXPECT_EQ(propose(3.4, 3).code, "H11/c11");
  EXPECT_EQ(propose(40, 40.03).code, "H7/p6");
  EXPECT_EQ(propose(40, 40.03).kind, FitKind::kInterference);
  // H7/p6 may have clearance at 2 mm; beyond 3150 mm ISO 286 has nothing to say.
  EXPECT_EQ(propose(2, 2.01).code, "H7/r6");
  EXPECT_EQ(propose(600, 602).code, "H7/p6");
  EXPECT_EQ(propose(600.5, 600).code, "H9/d9");
  EXPECT_EQ(propose(4000, 4000).code, "");
  // A tapped hole drawn with its minor diameter, without any name.
  EXPECT_EQ(propose(2.5, 3).kind, FitKind::kThread);
  EXPECT_EQ(propose(2.5, 3).code, "");
  EXPECT_DOUBLE_EQ(propose(2.5, 3).nominal_diameter, 0.003);
  // The same in a large shaft is no thread.
  EXPECT_EQ(propose(39, 40).kind, FitKind::kInterference);
  EXPECT_EQ(propose(3, 3, FastenerKind::kNone, FastenerKind::kScrew).kind, FitKind::kThread);
  EXPECT_EQ(propose(3.4, 3, FastenerKind::kNone, FastenerKind::kScrew).kind, FitKind::kClearance);
  EXPECT_EQ(propose(3, 3, FastenerKind::kNone, FastenerKind::kScrew, true).kind,
            FitKind::kClearance);
  EXPECT_EQ(propose(5, 5, FastenerKind::kNut).kind, FitKind::kThread);
  EXPECT_EQ(propose(5.1, 5, FastenerKind::kNut, FastenerKind::kScrew).kind, FitKind::kThread);
  EXPECT_TRUE(propose(5, 5).is_proposed);
  EXPECT_FALSE(propose(5, 5).reason.empty());
}

TEST(ProposeFit, ARivetPassesThroughHolesThatAreDrawnEqual) {
  FitEvidence evidence;
  evidence.hole_radius = evidence.shaft_radius = 2e-3;
  evidence.may_pass = true;
  EXPECT_EQ(ProposeFit(evidence).kind, FitKind::kClearance);
  evidence.is_rivet = true;
  EXPECT_EQ(ProposeFit(evidence).kind, FitKind::kPassage);
}

TEST(ProposeFit, PinInAHoleThatIsSlightlySmallerIsPressed) {
  FitEvidence evidence;
  evidence.hole_radius = 1.45e-3;
  evidence.shaft_radius = 1.5e-3;
  // 2.9 mm is above the pitch diameter of M3 (2.675 mm, ISO 724): no thread is drawn so.
  EXPECT_EQ(ProposeFit(evidence).kind, FitKind::kInterference);
  evidence.hole_radius = 1.25e-3;
  EXPECT_EQ(ProposeFit(evidence).kind, FitKind::kThread);
  evidence.is_pressed = true;
  EXPECT_EQ(ProposeFit(evidence).kind, FitKind::kInterference);
  for (const char* name : {"Dowel Pin 3x10", "ISO 2338 - 4 m6 x 20", "pin_2", "Zylinderstift"}) {
    EXPECT_TRUE(product::IsPinName(name)) << name;
  }
  for (const char* name : {"spindle", "pinion", "DIN 912", "pin header M3 screw", "DIN 71412"}) {
    EXPECT_FALSE(product::IsPinName(name)) << name;
  }
}

TEST(ProposeFit, ThreadsCountWhateverTheSizes) {
  const auto propose = [](double hole_mm, double shaft_mm, product::ThreadKind hole,
                          product::ThreadKind shaft, FastenerKind part = FastenerKind::kNone) {
    FitEvidence evidence;
    evidence.hole_radius = hole_mm / 2e3;
    evidence.shaft_radius = shaft_mm / 2e3;
    evidence.shaft_part = part;
    evidence.hole_thread = hole;
    evidence.shaft_thread = shaft;
    return ProposeFit(evidence).kind;
  };
  constexpr auto kNone = product::ThreadKind::kNone;
  constexpr auto kNominal = product::ThreadKind::kNominal;
  EXPECT_EQ(propose(20.1, 20, kNominal, kNominal), FitKind::kThread);
  EXPECT_EQ(propose(20.1, 20, kNominal, kNone, FastenerKind::kScrew), FitKind::kThread);
  EXPECT_EQ(propose(19.9, 20, kNominal, kNone), FitKind::kThread);
  EXPECT_EQ(propose(19.9, 20, kNone, kNominal), FitKind::kThread);
  // A threaded rod through a clearance hole, and a plain pin in a wide threaded one.
  EXPECT_EQ(propose(20.5, 20, kNone, kNominal), FitKind::kClearance);
  EXPECT_EQ(propose(20.1, 20, kNominal, kNone), FitKind::kClearance);
  EXPECT_EQ(propose(19.9, 20, kNone, kNone), FitKind::kInterference);
}

TEST(ProposeFit, AScrewIsNeverPressedInEvenWithANutBehindIt) {
  FitEvidence evidence;
  evidence.hole_radius = 9.99e-3;
  evidence.shaft_radius = 10e-3;
  evidence.shaft_part = FastenerKind::kScrew;
  evidence.nut_on_shaft = true;
  EXPECT_EQ(ProposeFit(evidence).kind, FitKind::kThread);
  evidence.shaft_part = FastenerKind::kNut;  // An insert in its pocket.
  evidence.nut_on_shaft = false;
  EXPECT_EQ(ProposeFit(evidence).kind, FitKind::kInsert);
}

}  // namespace
}  // namespace hvas::mates
