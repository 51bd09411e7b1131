// X16: forms by which tools turn fasteners.

#include "product/drive_forms.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "product/features.h"
#include "product/test/flat_face.h"

namespace hvas::product {
namespace {

using testing::AddFlatFace;

using Profile = std::vector<std::pair<double, double>>;  // Counter-clockwise in x, y.

/** The walls of a profile between two heights; facing inwards for a recess. */
void AddProfileWalls(Part* part, const Profile& profile, double low, double high, bool is_recess) {
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const auto [x0, y0] = profile[i];
    const auto [x1, y1] = profile[(i + 1) % profile.size()];
    const Vec3 a(x0, y0, low), b(x1, y1, low), c(x1, y1, high), d(x0, y0, high);
    AddFlatFace(is_recess ? std::vector<Vec3>{b, a, d, c} : std::vector<Vec3>{a, b, c, d}, part);
  }
}

void AddProfileLid(Part* part, const Profile& profile, double height, double up) {
  std::vector<Vec3> points;
  for (const auto& [x, y] : profile) {
    points.emplace_back(x, y, height);
  }
  if (up < 0) {
    points = {points.rbegin(), points.rend()};
  }
  AddFlatFace(points, part);
}

Profile MakeHexagon(double across, double turn = 0) {
  Profile profile;
  for (int i = 0; i < 6; ++i) {
    const double angle = turn + std::numbers::pi / 3 * i + std::numbers::pi / 6;
    profile.emplace_back(across / std::numbers::sqrt3 * std::cos(angle),
                         across / std::numbers::sqrt3 * std::sin(angle));
  }
  return profile;
}

Profile MakeRectangle(double x, double y) {
  return {{-0.5 * x, -0.5 * y}, {0.5 * x, -0.5 * y}, {0.5 * x, 0.5 * y}, {-0.5 * x, 0.5 * y}};
}

std::vector<DriveForm> Find(const Part& part) {
  RecognitionLimits limits;
  auto drives = FindDriveForms(part, 1e-7, &limits);
  EXPECT_TRUE(limits.items().empty());
  return drives;
}

void Rotate(Part* part, const Quat& q) {
  part->box_B = {};
  for (Vec3& p : part->mesh.vertices) {
    p = q * p;
    part->box_B.Add(p);
  }
  for (Face& face : part->faces) {
    face.surface.axis = q * face.surface.axis;
    face.surface.origin = q * face.surface.origin;
    face.box_B = {};
    for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
      for (const std::uint32_t v : part->mesh.triangles[face.first_triangle + t]) {
        face.box_B.Add(part->mesh.vertices[v]);
      }
    }
  }
}

TEST(DriveFormsX16, ASocketIsFoundWithItsWidthDepthAndMouthHoweverItIsTurned) {
  Part screw;
  const Profile socket = MakeHexagon(5e-3, 0.3);
  AddProfileWalls(&screw, MakeRectangle(11e-3, 11e-3), 0, 6e-3, false);
  AddProfileLid(&screw, MakeRectangle(11e-3, 11e-3), 0, -1);
  AddProfileWalls(&screw, socket, 3e-3, 6e-3, true);
  AddProfileLid(&screw, socket, 3e-3, 1);
  for (const Quat& q : {Quat::Identity(), Quat(0.5, 0.5, -0.5, 0.5),
                        Quat(Quat(0.9, 0.1, 0.3, -0.2).normalized())}) {
    Part part = screw;
    Rotate(&part, q);
    const auto drives = Find(part);
    ASSERT_EQ(drives.size(), 1);
    EXPECT_EQ(drives[0].kind, DriveKind::kHexagon);
    EXPECT_TRUE(drives[0].is_recess);
    EXPECT_FALSE(drives[0].is_through);
    EXPECT_NEAR(drives[0].width, 5e-3, 1e-12);
    EXPECT_NEAR(drives[0].depth, 3e-3, 1e-12);
    EXPECT_NEAR((drives[0].origin_B - q * Vec3(0, 0, 6e-3)).norm(), 0, 1e-12);
    EXPECT_NEAR((drives[0].axis_B + q * Vec3::UnitZ()).norm(), 0, 1e-9);
    EXPECT_EQ(drives[0].faces.size(), 6);
  }
}

TEST(DriveFormsX16, AHexagonOnAPlateIsEnteredFromItsFreeEnd) {
  Part part;
  AddProfileWalls(&part, MakeHexagon(10e-3), 0, 4e-3, false);
  AddProfileLid(&part, MakeHexagon(10e-3), 4e-3, 1);
  AddProfileWalls(&part, MakeRectangle(30e-3, 20e-3), -5e-3, 0, false);
  AddProfileLid(&part, MakeRectangle(30e-3, 20e-3), 0, 1);
  AddProfileLid(&part, MakeRectangle(30e-3, 20e-3), -5e-3, -1);
  const auto drives = Find(part);
  ASSERT_EQ(drives.size(), 1);
  EXPECT_FALSE(drives[0].is_recess);
  EXPECT_FALSE(drives[0].is_through);
  EXPECT_NEAR((drives[0].origin_B - Vec3(0, 0, 4e-3)).norm(), 0, 1e-12);
  EXPECT_NEAR(drives[0].axis_B.z(), -1, 1e-12);
}

TEST(DriveFormsX16, FiveFlatsOfSixAreNoHexagon) {
  Part part;
  Profile profile = MakeHexagon(10e-3);
  profile[0].first += 1e-3;  // Two flats are turned.
  AddProfileWalls(&part, profile, 0, 4e-3, false);
  EXPECT_TRUE(Find(part).empty());
}

/** The axis on which slots and crosses are looked for. */
void AddShank(Part* part) {
  Feature shank;
  shank.kind = FeatureKind::kShaft;
  shank.axis_B = Vec3(0, 0, -1);
  shank.origin_B = Vec3(0, 0, -0.02);
  shank.radius = 2e-3;
  part->features.push_back(shank);
}

TEST(DriveFormsX16, ASlotAcrossAHeadAndACrossAreToldApart) {
  Part slotted;
  AddShank(&slotted);
  AddProfileWalls(&slotted, MakeRectangle(14e-3, 14e-3), 0, 5e-3, false);
  AddProfileLid(&slotted, MakeRectangle(14e-3, 14e-3), 0, -1);
  AddProfileWalls(&slotted, MakeRectangle(8e-3, 1.2e-3), 3e-3, 5e-3, true);
  AddProfileLid(&slotted, MakeRectangle(8e-3, 1.2e-3), 3e-3, 1);
  auto drives = Find(slotted);
  ASSERT_EQ(drives.size(), 1);
  EXPECT_EQ(drives[0].kind, DriveKind::kSlot);
  EXPECT_NEAR(drives[0].width, 1.2e-3, 1e-12);
  EXPECT_NEAR(drives[0].span, 8e-3, 1e-12);
  EXPECT_NEAR(drives[0].depth, 2e-3, 1e-12);
  EXPECT_NEAR(drives[0].axis_B.z(), -1, 1e-12);

  Part crossed;
  AddShank(&crossed);
  const double a = 0.6e-3;
  const double b = 4e-3;
  const Profile cross{{b, -a}, {b, a},   {a, a},   {a, b},   {-a, b}, {-a, a},
                      {-b, a}, {-b, -a}, {-a, -a}, {-a, -b}, {a, -b}, {a, -a}};
  AddProfileWalls(&crossed, MakeRectangle(14e-3, 14e-3), 0, 5e-3, false);
  AddProfileLid(&crossed, MakeRectangle(14e-3, 14e-3), 0, -1);
  AddProfileWalls(&crossed, cross, 3e-3, 5e-3, true);
  AddProfileLid(&crossed, MakeRectangle(2 * b, 2 * a), 3e-3, 1);
  AddProfileLid(&crossed, MakeRectangle(2 * a, 2 * b), 3e-3, 1);
  drives = Find(crossed);
  ASSERT_EQ(drives.size(), 1);
  EXPECT_EQ(drives[0].kind, DriveKind::kCross);
  EXPECT_NEAR(drives[0].width, 2 * a, 1e-12);
  EXPECT_NEAR(drives[0].span, 2 * b, 1e-12);
  EXPECT_EQ(drives[0].faces.size(), 8);
}

}  // namespace
}  // namespace hvas::product
