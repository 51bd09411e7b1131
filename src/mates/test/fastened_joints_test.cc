#include "mates/fastened_joints.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "mates/infer.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::FeatureKind;
using product::Part;
using product::PartId;
using product::Product;
using spatial::Pose;
using testing::AddCylinder;
using testing::AddOccurrence;
using testing::AddPart;
using testing::AddRectangle;

const Pose kPlace(Quat(Eigen::AngleAxisd(0.4, Vec3(1, 2, 2) / 3)), Vec3(0.1, 0.2, 0.3));

/** A flange on a motor, face on face, with a pilot of 22 mm or none, and screws of 3 mm at the
 * given points. @param motor_radius  Of the motor's holes: by default the core of an M3. */
Product MakeFlange(const std::vector<Vec3>& points, bool has_pilot, const char* screw_name,
                   double motor_radius = 1.25e-3) {
  Product product;
  AddPart(&product, "flange");
  AddPart(&product, "motor");
  Part* flange = &product.parts[0];
  Part* motor = &product.parts[1];
  AddRectangle(flange, Vec3::Zero(), -Vec3::UnitZ(), 40e-3, 40e-3);
  AddRectangle(motor, Vec3::Zero(), Vec3::UnitZ(), 40e-3, 40e-3);
  for (const Vec3& p : points) {
    AddCylinder(flange, FeatureKind::kHole, p, Vec3::UnitZ(), 1.7e-3, 0, 5e-3);
    AddCylinder(motor, FeatureKind::kHole, p, Vec3::UnitZ(), motor_radius, -8e-3, 0);
  }
  if (has_pilot) {
    AddCylinder(flange, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 11e-3, 0, 5e-3);
    AddCylinder(motor, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 11e-3, 0, 2e-3);
  }
  Part* screw = AddPart(&product, screw_name);
  AddCylinder(screw, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 1.5e-3, -6e-3, 5e-3);
  AddOccurrence(&product, PartId(0), kPlace);
  AddOccurrence(&product, PartId(1), kPlace);
  for (const Vec3& p : points) {
    AddOccurrence(&product, PartId(2), kPlace * Pose(p));
  }
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

constexpr double kQuarter = 15.5e-3;  // Half the distance of a NEMA 17's holes [m].
const std::vector<Vec3> kSquare{{kQuarter, kQuarter, 0},
                                {-kQuarter, kQuarter, 0},
                                {-kQuarter, -kQuarter, 0},
                                {kQuarter, -kQuarter, 0}};

TEST(FastenedJoints, PilotAndBoltCircleOfAFlangeOnAMotorAreOneJointWithoutFreedom) {
  for (const bool has_pilot : {true, false}) {
    const Product product = MakeFlange(kSquare, has_pilot, "screw M3x10");
    const auto joints = FindFastenedJoints(product);
    ASSERT_EQ(joints.size(), 1U);
    EXPECT_EQ(joints[0].a.index(), 0U);
    EXPECT_EQ(joints[0].b.index(), 1U);
    EXPECT_EQ(joints[0].fasteners.size(), 4U);
    EXPECT_NEAR(joints[0].diameter, 3e-3, 1e-12);
    EXPECT_NEAR(joints[0].circle_diameter, 2 * std::sqrt(2.0) * kQuarter, 1e-9);
    EXPECT_EQ(joints[0].pilot.has_value(), has_pilot);
    EXPECT_EQ(joints[0].free_translations, 0);
    EXPECT_EQ(joints[0].free_rotations, 0);
  }
}

TEST(FastenedJoints, OneScrewOnAFaceLeavesATurnAndFourOffACircleHaveNone) {
  const auto one = FindFastenedJoints(MakeFlange({kSquare[0]}, false, "screw M3x10"));
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].free_translations, 0);
  EXPECT_EQ(one[0].free_rotations, 1);
  EXPECT_EQ(one[0].circle_diameter, 0);
  std::vector<Vec3> points = kSquare;
  points[0] *= 1.2;
  const auto off = FindFastenedJoints(MakeFlange(points, true, "screw M3x10"));
  ASSERT_EQ(off.size(), 1U);
  EXPECT_EQ(off[0].circle_diameter, 0);
}

TEST(FastenedJoints, ASingleShaftInTwoPartsIsNoFastenerAndTwoPinsAre) {
  EXPECT_TRUE(FindFastenedJoints(MakeFlange({kSquare[0]}, false, "axle")).empty());
  EXPECT_EQ(FindFastenedJoints(MakeFlange({kSquare[0], kSquare[2]}, false, "pin", 1.495e-3)).size(),
            1U);
}

/** Plates of 5 mm, one on the other, whose holes are off a line by turns, with bolts in them. The
 bolts have a thread in a nut, and names or none. */
Product MakeStack(int plates, double bolt, double hole, double off, double tilt,
                  const char* bolt_name, const char* nut_name) {
  Product product;
  const double top = 5e-3 * plates;
  for (int i = 0; i < plates; ++i) {
    AddPart(&product, "plate");
    Part* plate = &product.parts.back();
    for (const Vec3& p : kSquare) {
      const Vec3 at(p.x() + (i % 2 == 0 ? off : -off), p.y(), 0);
      AddCylinder(plate, FeatureKind::kHole, at, Vec3::UnitZ(), 0.5 * hole, 5e-3 * i,
                  5e-3 * (i + 1));
    }
    AddRectangle(plate, Vec3(0, 0, 5e-3 * i), -Vec3::UnitZ(), 40e-3, 40e-3);
    AddRectangle(plate, Vec3(0, 0, 5e-3 * (i + 1)), Vec3::UnitZ(), 40e-3, 40e-3);
    AddOccurrence(&product, PartId(product.parts.size() - 1), kPlace);
  }
  AddPart(&product, bolt_name);
  AddCylinder(&product.parts.back(), FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 0.5 * bolt,
              -0.5 * top, 0.5 * top + bolt);
  const PartId bolt_part(product.parts.size() - 1);
  AddPart(&product, nut_name);
  AddCylinder(&product.parts.back(), FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 0.5 * bolt,
              0.5 * top, 0.5 * top + 0.8 * bolt);
  const PartId nut_part(product.parts.size() - 1);
  for (const Vec3& p : kSquare) {
    const Pose X_WB =
        kPlace * Pose(Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY())), Vec3(p.x(), p.y(), 0.5 * top));
    AddOccurrence(&product, bolt_part, X_WB);
    AddOccurrence(&product, nut_part, X_WB);
  }
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

int CountPassages(const Product& product) {
  return static_cast<int>(
      std::count_if(product.mates.begin(), product.mates.end(), [](const product::Mate& mate) {
        return mate.fit && mate.fit->kind == product::FitKind::kPassage;
      }));
}

TEST(FastenedJoints, BoltsOffTheAxesOfTheirHolesPassThemAndTheOffsetIsTold) {
  struct Case {
    int plates;
    double bolt_mm, hole_mm, off_mm;
  };

  for (const Case& c :
       {Case{2, 4, 4.5, 0.075}, Case{2, 4, 4.5, 0.24}, Case{3, 6, 6.6, 0.15}, Case{4, 3, 3.4, 0.1},
        Case{2, 12, 13.5, 0.4}, Case{2, 20, 22, 0.9}, Case{2, 6.35, 7.1, 0.2}}) {
    SCOPED_TRACE(c.bolt_mm);
    const Product product = MakeStack(c.plates, 1e-3 * c.bolt_mm, 1e-3 * c.hole_mm, 1e-3 * c.off_mm,
                                      0, "bolt M4x20", "nut M4");
    EXPECT_EQ(CountPassages(product), 4 * c.plates);
    const auto joints = FindFastenedJoints(product);
    ASSERT_EQ(joints.size(), static_cast<std::size_t>(c.plates) - 1);
    for (const FastenedJoint& joint : joints) {
      EXPECT_EQ(joint.fasteners.size(), 4U);
      EXPECT_NEAR(joint.offset, 1e-3 * c.off_mm, 1e-9);
    }
  }
}

TEST(FastenedJoints, BoltsThatLeanInTheirHolesPassThem) {
  const Product product = MakeStack(3, 4e-3, 4.6e-3, 0.05e-3, 0.01, "bolt M4x20", "nut M4");
  EXPECT_EQ(CountPassages(product), 12);
  EXPECT_EQ(FindFastenedJoints(product).size(), 2U);
}

TEST(FastenedJoints, AShaftWithoutANameIsABoltWhereItIsInANut) {
  const Product product = MakeStack(2, 4e-3, 4.5e-3, 0.1e-3, 0, "part 3", "DIN 934");
  EXPECT_EQ(CountPassages(product), 8);
  EXPECT_EQ(FindFastenedJoints(product).size(), 1U);
}

TEST(FastenedJoints, ABoltThatRunsIntoTheWallOfItsHoleIsNotInItAndAPinBesideItsAxisNeither) {
  EXPECT_EQ(CountPassages(MakeStack(2, 4e-3, 4.5e-3, 0.3e-3, 0, "bolt M4x20", "nut M4")), 0);
  EXPECT_TRUE(MakeStack(2, 4e-3, 4.5e-3, 0.1e-3, 0, "pin", "cap").mates.size() < 10);
}

}  // namespace
}  // namespace hvas::mates
