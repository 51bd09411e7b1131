#include "fits/threads.h"

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace hvas::fits {
namespace {

TEST(Threads, DiametersAndAreasAreThoseOfTheTables) {
  // d2, D1, d3 [mm], A_s [mm^2]: DIN 13-1 and ISO 898-1.
  const struct {
    double d, pitch, d2, minor, core, area;
  } rows[] = {{3e-3, 0, 2.675, 2.459, 2.387, 5.03},    {6e-3, 0, 5.350, 4.917, 4.773, 20.1},
              {8e-3, 0, 7.188, 6.647, 6.466, 36.6},    {8e-3, 1e-3, 7.350, 6.917, 6.773, 39.2},
              {12e-3, 0, 10.863, 10.106, 9.853, 84.3}, {16e-3, 0, 14.701, 13.835, 13.546, 157},
              {24e-3, 0, 22.051, 20.752, 20.319, 353}};

  for (const auto& row : rows) {
    const Thread* thread = FindThread(row.d, row.pitch);
    ASSERT_NE(thread, nullptr) << row.d;
    EXPECT_NEAR(1e3 * thread->pitch_diameter(), row.d2, 1e-3);
    EXPECT_NEAR(1e3 * thread->minor_diameter(), row.minor, 1e-3);
    EXPECT_NEAR(1e3 * thread->core_diameter(), row.core, 1e-3);
    EXPECT_NEAR(1e6 * thread->stress_area() / row.area, 1, 5e-3);
  }
}

TEST(Threads, AreNamedOnceAndDrilledBetweenCoreAndPitchDiameter) {
  std::set<std::string> names;
  for (const Thread& thread : ListThreads()) {
    EXPECT_TRUE(names.insert(thread.designation).second) << thread.designation;
    EXPECT_GT(thread.tap_drill, thread.core_diameter()) << thread.designation;
    EXPECT_LT(thread.tap_drill, thread.pitch_diameter() + 0.15 * thread.pitch)
        << thread.designation;
    if (thread.clearance_fine > 0) {
      EXPECT_LT(thread.diameter, thread.clearance_fine) << thread.designation;
      EXPECT_LT(thread.clearance_fine, thread.clearance_medium) << thread.designation;
      EXPECT_LT(thread.clearance_medium, thread.clearance_coarse) << thread.designation;
    }
  }
}

TEST(Threads, AreFoundByDiameterAndPitch) {
  EXPECT_EQ(FindThread(3e-3, 0)->designation, "M3");
  EXPECT_EQ(FindThread(2.98e-3, 0.5e-3)->designation, "M3");
  EXPECT_EQ(FindThread(8e-3, 1e-3)->designation, "M8x1");
  EXPECT_EQ(FindThread(8e-3, 1.2e-3)->designation, "M8");
  EXPECT_EQ(FindThread(6.35e-3, 0)->designation, "1/4-20 UNC");
  EXPECT_EQ(FindThread(6.35e-3, 0.9e-3)->designation, "1/4-28 UNF");
  EXPECT_EQ(FindThread(4.6e-3, 0), nullptr);
  EXPECT_EQ(FindThread(0.3, 0), nullptr);
  // A size with fine pitches alone is none where no pitch is known.
  EXPECT_EQ(FindThread(15e-3, 0), nullptr);
  EXPECT_EQ(FindThread(15e-3, 1e-3)->designation, "M15x1");
}

TEST(Threads, EveryThreadIsFoundByTheTwoDiametersAtWhichItMayBeDrawn) {
  for (const Thread& thread : ListThreads()) {
    for (const double hole : {thread.minor_diameter(), thread.diameter - thread.pitch,
                              thread.core_diameter(), thread.tap_drill}) {
      const Thread* found = FindThreadOfPair(hole, thread.diameter);
      ASSERT_NE(found, nullptr) << thread.designation << " in " << hole;
      EXPECT_EQ(found->diameter, thread.diameter);
      // The tap drill of one pitch may be the core of another: then both are the drawing's.
      const bool is_drawn_too = std::abs(hole - found->minor_diameter()) < 20e-6 ||
                                std::abs(hole - found->core_diameter()) < 20e-6 ||
                                std::abs(hole - found->tap_drill) < 20e-6 ||
                                std::abs(hole - (found->diameter - found->pitch)) < 20e-6;
      EXPECT_TRUE(found->pitch == thread.pitch || is_drawn_too) << thread.designation;
    }
    EXPECT_EQ(FindThreadOfPair(thread.minor_diameter(), thread.diameter)->pitch, thread.pitch)
        << thread.designation;
  }
}

TEST(Threads, WhatIsPressedTogetherOrDrawnWrongIsNoPairOfAThread) {
  // Diameters of shaft and hole [mm]: interferences of press fits and pins, and errors.
  const std::pair<double, double> pairs[] = {{40, 39.95}, {3, 2.9},       {30, 29.9}, {6, 5.99},
                                             {40, 39},    {28.575, 25.4}, {50, 43},   {8, 8}};

  for (const auto& [shaft, hole] : pairs) {
    EXPECT_EQ(FindThreadOfPair(1e-3 * hole, 1e-3 * shaft), nullptr) << shaft << " in " << hole;
  }
  EXPECT_EQ(FindThreadOfPair(28.376e-3, 30e-3)->designation, "M30x1.5");
  EXPECT_EQ(FindThreadOfPair(28.4e-3, 30e-3)->designation, "M30x1.5");
  EXPECT_EQ(FindThreadOfPair(26.211e-3, 30e-3)->designation, "M30");
  EXPECT_EQ(FindThreadOfPair(4.92e-3, 6e-3)->designation, "M6");
  EXPECT_EQ(FindThreadOfPair(4.976e-3, 6.35e-3)->designation, "1/4-20 UNC");
}

TEST(Threads, HolesOfAScrewAreToldByTheirDiameter) {
  const Thread& m3 = *FindThread(3e-3, 0);
  EXPECT_EQ(ClassifyThreadHole(m3, 2.0e-3), ThreadHole::kUndersized);
  EXPECT_EQ(ClassifyThreadHole(m3, 2.387e-3), ThreadHole::kCore);
  EXPECT_EQ(ClassifyThreadHole(m3, 2.5e-3), ThreadHole::kCore);
  EXPECT_EQ(ClassifyThreadHole(m3, 2.9e-3), ThreadHole::kNominal);
  EXPECT_EQ(ClassifyThreadHole(m3, 3.0e-3), ThreadHole::kNominal);
  EXPECT_EQ(ClassifyThreadHole(m3, 3.2e-3), ThreadHole::kClearance);
  EXPECT_EQ(ClassifyThreadHole(m3, 3.6e-3), ThreadHole::kClearance);
  EXPECT_EQ(ClassifyThreadHole(m3, 5.0e-3), ThreadHole::kWide);
}

TEST(Threads, PreloadIsThatOfVdi2230) {
  // Published tables by VDI 2230 for property class 8.8, fine threads [kN].
  const struct {
    double d, pitch, friction, preload;
  } rows[] = {{8e-3, 1e-3, 0.10, 20.7},     {8e-3, 1e-3, 0.12, 20.2},
              {8e-3, 1e-3, 0.14, 19.7},     {10e-3, 1.25e-3, 0.12, 31.6},
              {12e-3, 1.25e-3, 0.12, 48.0}, {14e-3, 1.5e-3, 0.12, 64.8},
              {16e-3, 1.5e-3, 0.14, 85.5}};

  for (const auto& row : rows) {
    const Tightening t =
        CalcTightening(*FindThread(row.d, row.pitch), 640e6, row.friction, row.friction, row.d);
    EXPECT_NEAR(1e-3 * t.preload / row.preload, 1, 0.01) << row.d << " " << row.friction;
  }
}

TEST(Threads, TighteningTorqueIsThatOfVdi2230) {
  // Table A1 of VDI 2230-1 for shanks of property class 8.8 with coarse threads, 0.12 in the thread
  // and under a hexagonal head (ISO 4014: D_K from the washer face and the medium hole) [N m].
  const struct {
    double d, yield, head, torque;
  } rows[] = {{6e-3, 640e6, 7.75e-3, 10.1},
              {8e-3, 640e6, 10.3e-3, 24.6},
              {10e-3, 640e6, 12.8e-3, 48},
              {12e-3, 640e6, 15.1e-3, 84},
              {16e-3, 640e6, 20.0e-3, 206}};

  for (const auto& row : rows) {
    const Tightening t = CalcTightening(*FindThread(row.d, 0), row.yield, 0.12, 0.12, row.head);
    EXPECT_NEAR(t.torque / row.torque, 1, 0.02) << row.d;
  }
  // Without friction all of the torque is in the pitch: work of a turn is force times pitch, 0.16
  // standing for 1 / (2 pi).
  const Thread& m8 = *FindThread(8e-3, 0);
  const Tightening smooth = CalcTightening(m8, 640e6, 0, 0, 10e-3);
  EXPECT_NEAR(smooth.torque * 2 * 3.14159265 / (smooth.preload * m8.pitch), 1, 0.01);
}

// ISO 965-1's table for M8 6H/6g: es -28 um, T_d2 118 um, T_D2 160 um. Its formulas are rounded
// there.
TEST(Threads, FlankPlayIsThatOfTheTolerances) {
  const double table = (28 + 0.5 * (118 + 160)) * std::tan(std::numbers::pi / 6);
  EXPECT_NEAR(1e6 * CalcMeanFlankPlay(*FindThread(8e-3, 0)), table, 0.02 * table);
  // M16: -38, 160, 212.
  const double larger = (38 + 0.5 * (160 + 212)) * std::tan(std::numbers::pi / 6);
  EXPECT_NEAR(1e6 * CalcMeanFlankPlay(*FindThread(16e-3, 0)), larger, 0.03 * larger);
}

// Limits of the closed form: a long screw is a rod, and what it clamps ever stiffer beside it.
TEST(Threads, JointIsAsStiffAsARodWhereItIsLong) {
  const Thread& m8 = *FindThread(8e-3, 0);
  const double length = 2;
  const double core = 0.25 * std::numbers::pi * m8.core_diameter() * m8.core_diameter();
  const double screw = 210e9 * core / length;
  const double shortened = CalcJointStiffness(m8, length);
  EXPECT_LT(shortened, screw);
  EXPECT_GT(shortened, 0.8 * screw);
  // An M8 on 12 mm, by hand: screw 3.331e8 N/m, clamped 2.153e9 N/m.
  EXPECT_NEAR(CalcJointStiffness(m8, 12e-3), 2.885e8, 0.003e8);
}

}  // namespace
}  // namespace hvas::fits
