#include "mates/prismatic_fits.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/diagnostics.h"
#include "mates/infer.h"
#include "mates/test/test_product.h"
#include "spatial/test/random_pose.h"

namespace hvas::mates {
namespace {

using product::Mate;
using product::MateKind;
using product::Part;
using product::Product;

constexpr double kHalfLength = 20e-3;  // Of all joints along x [m].

/** A flat convex face; its corners turn left as seen from outside. */
void AddPolygon(Part* part, const std::vector<Vec3>& corners) {
  const product::FaceId id = testing::AddFace(part);
  product::Face& face = part->faces[id.index()];
  const auto first = static_cast<std::uint32_t>(part->mesh.vertices.size());
  Vec3 twice_area = Vec3::Zero();
  Vec3 centre = Vec3::Zero();
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    part->mesh.vertices.push_back(corners[i]);
    face.box_B.Add(corners[i]);
    centre += corners[i] / static_cast<double>(corners.size());
    if (i >= 2) {
      part->mesh.triangles.push_back({first, first + i - 1, first + i});
      twice_area += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
    }
  }
  face.triangle_count = static_cast<std::uint32_t>(corners.size() - 2);
  face.area = 0.5 * twice_area.norm();
  face.surface = {product::SurfaceKind::kPlane, centre, twice_area.normalized(), 0, 0, 1};
  part->box_B.Add(face.box_B);
  product::Feature feature;
  feature.faces = {id};
  feature.origin_B = centre;
  feature.axis_B = face.surface.axis;
  feature.area = face.area;
  part->features.push_back(feature);
}

using Outline = std::vector<Eigen::Vector2d>;  // y, z

/** The faces over the edges of an outline, along x; the material is on the left of each edge. */
void Extrude(Part* part, const Outline& outline, double half_length = kHalfLength) {
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    const auto at = [&](std::size_t k, double x) {
      return Vec3(x, outline[k].x(), outline[k].y());
    };
    AddPolygon(part, {at(i, -half_length), at(i + 1, -half_length), at(i + 1, half_length),
                      at(i, half_length)});
  }
}

/** The outline the other way round: the material is on the other side. */
Outline Reverse(Outline outline) {
  std::reverse(outline.begin(), outline.end());
  return outline;
}

/** The sides of a box, from its underside upwards. */
void AddBlock(Part* part, const Vec3& half, double bottom, double top) {
  const Outline around{{-half.y(), bottom},
                       {half.y(), bottom},
                       {half.y(), top},
                       {-half.y(), top},
                       {-half.y(), bottom}};
  Extrude(part, around, half.x());
  for (const double x : {-half.x(), half.x()}) {
    std::vector<Vec3> end{
        {x, -half.y(), bottom}, {x, half.y(), bottom}, {x, half.y(), top}, {x, -half.y(), top}};
    if (x < 0) {
      std::reverse(end.begin(), end.end());
    }
    AddPolygon(part, end);
  }
}

/** The faces that a block of this size would leave in a part, open at its top. */
void AddCavity(Part* part, const Vec3& half, double bottom, double top) {
  Part block;
  AddBlock(&block, half, bottom, top);
  for (const product::Face& face : block.faces) {
    std::vector<Vec3> corners;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t k = block.mesh.triangles[face.first_triangle][0] + i;
      corners.insert(corners.begin(), block.mesh.vertices[k]);
    }
    if (face.surface.axis.z() < 0.5) {
      AddPolygon(part, corners);
    }
  }
}

struct DrawnWidth {
  double width;    // Of the slot [m].
  double engaged;  // [m]
  Vec3 way;        // Out of the slot, of either sign where it is open at both ends.
};

struct JointForm {
  std::string name;
  void (*add)(double clearance, Part* outer, Part* inner);
  std::vector<DrawnWidth> widths;
};

void AddTongueAndSlot(double c, Part* outer, Part* inner) {
  Extrude(
      outer,
      Reverse({{-15e-3, 8e-3}, {-5e-3, 8e-3}, {-5e-3, 0}, {5e-3, 0}, {5e-3, 8e-3}, {15e-3, 8e-3}}));
  const double half = 5e-3 - 0.5 * c;
  Extrude(inner, {{-half, 0}, {half, 0}, {half, 12e-3}, {-half, 12e-3}, {-half, 0}});
}

void AddPocketAndBlock(double c, Part* outer, Part* inner) {
  AddCavity(outer, Vec3(12e-3, 8e-3, 0), 0, 6e-3);
  AddBlock(inner, Vec3(12e-3 - 0.5 * c, 8e-3 - 0.5 * c, 0), 0, 15e-3);
}

void AddRecess(double c, Part* outer, Part* inner) {
  AddCavity(outer, Vec3(15e-3, 9e-3, 0), 0, 1.5e-3);
  AddBlock(inner, Vec3(15e-3 - 0.5 * c, 9e-3 - 0.5 * c, 0), 0, 1.2e-3);
}

void AddSandwich(double c, Part* outer, Part* inner) {
  // A fork around the edge of a plate.
  Extrude(
      outer,
      Reverse(
          {{-5e-3, 30e-3}, {-2e-3, 30e-3}, {-2e-3, 0}, {2e-3, 0}, {2e-3, 30e-3}, {5e-3, 30e-3}}));
  const double half = 2e-3 - 0.5 * c;
  Extrude(inner, {{-half, 5e-3}, {half, 5e-3}, {half, 50e-3}, {-half, 50e-3}, {-half, 5e-3}});
}

void AddTSlot(double c, Part* outer, Part* inner) {
  Extrude(outer, Reverse({{-15e-3, 12e-3},
                          {-5e-3, 12e-3},
                          {-5e-3, 6e-3},
                          {-10e-3, 6e-3},
                          {-10e-3, 0},
                          {10e-3, 0},
                          {10e-3, 6e-3},
                          {5e-3, 6e-3},
                          {5e-3, 12e-3},
                          {15e-3, 12e-3}}));
  const double neck = 5e-3 - 0.5 * c;
  const double head = 10e-3 - 0.5 * c;
  const double top = 6e-3 - c;
  Extrude(inner, {{-head, 0},
                  {head, 0},
                  {head, top},
                  {neck, top},
                  {neck, 20e-3},
                  {-neck, 20e-3},
                  {-neck, top},
                  {-head, top},
                  {-head, 0}});
}

constexpr double kFlank = 8e-3 / std::numbers::sqrt3;  // Overhang of 60 degrees over 8 mm [m].

void AddDovetail(double c, Part* outer, Part* inner) {
  const double mouth = 15e-3 - kFlank;
  Extrude(
      outer,
      Reverse(
          {{-25e-3, 8e-3}, {-mouth, 8e-3}, {-15e-3, 0}, {15e-3, 0}, {mouth, 8e-3}, {25e-3, 8e-3}}));
  const double p = 0.5 * c;
  Extrude(
      inner,
      {{-15e-3 + p, 0}, {15e-3 - p, 0}, {mouth - p, 8e-3}, {-mouth + p, 8e-3}, {-15e-3 + p, 0}});
}

Outline MakeHexagon(double across_flats, bool is_hole) {
  Outline corners;
  for (int i = 0; i <= 6; ++i) {
    const double angle = (is_hole ? -1 : 1) * i * std::numbers::pi / 3;
    corners.push_back(across_flats / std::numbers::sqrt3 *
                      Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return corners;
}

void AddHexagon(double c, Part* outer, Part* inner) {
  Extrude(outer, MakeHexagon(13e-3, true));
  Extrude(inner, MakeHexagon(13e-3 - c, false));
  std::vector<Vec3> floor;
  for (const Eigen::Vector2d& corner : MakeHexagon(13e-3, false)) {
    floor.emplace_back(-kHalfLength, corner.x(), corner.y());
  }
  floor.pop_back();
  AddPolygon(outer, floor);
}

void AddKey(double c, Part* outer, Part* inner) {
  AddCavity(outer, Vec3(16e-3, 3e-3, 0), 0, 3.5e-3);
  AddBlock(inner, Vec3(15e-3, 3e-3 - 0.5 * c, 0), 0, 6e-3);
}

void AddRoundedPocket(double c, Part* outer, Part* inner) {
  // Walls that end before the corners, where the pocket is round.
  const auto add = [](Part* part, double half_x, double half_y, double top, bool is_pocket) {
    constexpr double kRound = 3e-3;
    const auto add_wall = [&](const Vec3& centre, const Vec3& along) {
      std::vector<Vec3> corners{centre - along, centre + along,
                                centre + along + top * Vec3::UnitZ(),
                                centre - along + top * Vec3::UnitZ()};
      if (is_pocket) {
        std::reverse(corners.begin(), corners.end());
      }
      AddPolygon(part, corners);
    };
    const Vec3 x = (half_x - kRound) * Vec3::UnitX();
    const Vec3 y = (half_y - kRound) * Vec3::UnitY();
    add_wall(-half_y * Vec3::UnitY(), x);
    add_wall(half_y * Vec3::UnitY(), -x);
    add_wall(half_x * Vec3::UnitX(), y);
    add_wall(-half_x * Vec3::UnitX(), -y);
    std::vector<Vec3> bottom{-x - y, -x + y, x + y, x - y};
    if (is_pocket) {
      std::reverse(bottom.begin(), bottom.end());
    }
    AddPolygon(part, bottom);
  };
  add(outer, 14e-3, 9e-3, 7e-3, true);
  add(inner, 14e-3 - 0.5 * c, 9e-3 - 0.5 * c, 9e-3, false);
}

void AddLid(double c, Part* outer, Part* inner) {
  AddCavity(outer, Vec3(25e-3, 18e-3, 0), 0, 20e-3);
  AddBlock(inner, Vec3(25e-3 - 0.5 * c, 18e-3 - 0.5 * c, 0), 17e-3, 20e-3);
}

const std::vector<JointForm>& ListJoints() {
  static const Vec3 x = Vec3::UnitX();
  static const Vec3 z = Vec3::UnitZ();
  static const std::vector<JointForm> joints{
      {"tongue and slot", AddTongueAndSlot, {{10e-3, 8e-3, z}}},
      {"pocket and block", AddPocketAndBlock, {{16e-3, 6e-3, z}, {24e-3, 6e-3, z}}},
      {"recess", AddRecess, {{18e-3, 1.2e-3, z}, {30e-3, 1.2e-3, z}}},
      {"sandwich", AddSandwich, {{4e-3, 25e-3, z}}},
      {"T slot", AddTSlot, {{6e-3, 40e-3, x}, {10e-3, 40e-3, x}, {20e-3, 40e-3, x}}},
      {"dovetail", AddDovetail, {{30e-3 - kFlank, 40e-3, x}}},
      {"hexagon", AddHexagon, {{13e-3, 40e-3, x}, {13e-3, 40e-3, x}, {13e-3, 40e-3, x}}},
      {"key", AddKey, {{6e-3, 3.5e-3, z}}},
      {"rounded pocket", AddRoundedPocket, {{18e-3, 7e-3, z}, {28e-3, 7e-3, z}}},
      {"lid with lip", AddLid, {{36e-3, 3e-3, z}, {50e-3, 3e-3, z}}}};
  return joints;
}

Product MakeProduct(const JointForm& joint, double clearance, const spatial::Pose& X_WA) {
  Product product;
  testing::AddPart(&product, "outer");
  testing::AddPart(&product, "inner");
  joint.add(clearance, &product.parts[0], &product.parts[1]);
  testing::AddOccurrence(&product, product::PartId(0), X_WA);
  testing::AddOccurrence(&product, product::PartId(1), X_WA);
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

std::vector<Mate> ListPrismatic(const Product& product) {
  std::vector<Mate> mates;
  std::copy_if(product.mates.begin(), product.mates.end(), std::back_inserter(mates),
               [](const Mate& mate) { return mate.kind == MateKind::kPrismatic; });
  std::stable_sort(mates.begin(), mates.end(),
                   [](const Mate& x, const Mate& y) { return x.hole_radius < y.hole_radius; });
  return mates;
}

TEST(PrismaticFits, X2JointsHaveTheirWidthsClearanceDepthAndWayOutInAnyFrame) {
  Random random(5);
  for (const JointForm& joint : ListJoints()) {
    for (const double clearance : {0.0, 20e-6, 50e-6, 0.2e-3, -20e-6, -40e-6}) {
      SCOPED_TRACE(joint.name + " " + std::to_string(1e6 * clearance));
      const spatial::Pose X_WA = spatial::RandomPose(&random, 1);
      const Product product = MakeProduct(joint, clearance, X_WA);
      const std::vector<Mate> mates = ListPrismatic(product);
      ASSERT_EQ(mates.size(), joint.widths.size());
      for (std::size_t i = 0; i < mates.size(); ++i) {
        const Mate& mate = mates[i];
        const DrawnWidth& width = joint.widths[i];
        // The width of a dovetail is that in the middle of the contact, which its clearance moves.
        const double near = joint.name == "dovetail" ? 0.13 * std::abs(clearance) + 1e-7 : 1e-7;
        EXPECT_EQ(mate.a.occurrence, product::OccurrenceId(0));
        EXPECT_NEAR(2 * mate.hole_radius, width.width, near);
        EXPECT_NEAR(2 * (mate.hole_radius - mate.shaft_radius), clearance, 1e-7);
        EXPECT_NEAR(mate.overlap, width.engaged, 0.5e-3);
        const Vec3 way = X_WA.q().conjugate() * ((X_WA * mate.a.X_BM).q() * Vec3::UnitX());
        EXPECT_NEAR(width.way.z() > 0 ? way.dot(width.way) : std::abs(way.dot(width.way)), 1, 1e-6);
        ASSERT_TRUE(mate.fit.has_value());
        EXPECT_EQ(mate.fit->kind,
                  clearance < 0 ? product::FitKind::kInterference : product::FitKind::kClearance);
        EXPECT_FALSE(mate.fit->code.empty());
        EXPECT_NEAR(mate.fit->nominal_diameter, width.width, near);
      }
    }
  }
}

TEST(PrismaticFits, AHexagonPocketIsLeftAtItsOpenEnd) {
  const Product product = MakeProduct(ListJoints()[6], 0, spatial::Pose());
  for (const Mate& mate : ListPrismatic(product)) {
    EXPECT_NEAR((mate.a.X_BM.q() * Vec3::UnitX()).x(), 1, 1e-9);
  }
}

TEST(PrismaticFits, AJointDrawnEqualGetsARunningFitThatSaysSo) {
  for (const JointForm& joint : ListJoints()) {
    for (const Mate& mate : ListPrismatic(MakeProduct(joint, 0, spatial::Pose()))) {
      EXPECT_EQ(mate.fit->code, "H7/g6");
      EXPECT_EQ(mate.fit->reason, "drawn equal");
    }
  }
}

/** A slot along x, 10 mm wide across y, and a tongue in it that is drawn `shift` off the middle. */
Product MakeShiftedTongue(double tongue_width, double shift) {
  Product product;
  Part* slot = testing::AddPart(&product, "slot");
  testing::AddRectangle(slot, Vec3(0, -5e-3, 0), Vec3::UnitY(), 4e-3, 20e-3);
  testing::AddRectangle(slot, Vec3(0, 5e-3, 0), -Vec3::UnitY(), 4e-3, 20e-3);
  Part* tongue = testing::AddPart(&product, "tongue");
  const double half = 0.5 * tongue_width;
  testing::AddRectangle(tongue, Vec3(0, -half, 0), -Vec3::UnitY(), 4e-3, 20e-3);
  testing::AddRectangle(tongue, Vec3(0, half, 0), Vec3::UnitY(), 4e-3, 20e-3);
  testing::AddOccurrence(&product, product::PartId(0), spatial::Pose());
  testing::AddOccurrence(&product, product::PartId(1), spatial::Pose(Vec3(0, shift, 0)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

TEST(PrismaticFits, ATongueDrawnAgainstAWallIsShiftedFromTheMiddle) {
  for (const double shift : {0.0, 20e-6, 50e-6}) {
    const Product product = MakeShiftedTongue(9.9e-3, shift);
    const std::vector<Mate> mates = ListPrismatic(product);
    ASSERT_EQ(mates.size(), 1U);
    EXPECT_NEAR(2 * (mates[0].hole_radius - mates[0].shaft_radius), 0.1e-3, 1e-9);
    const double z = (mates[0].a.X_BM.q() * Vec3::UnitZ()).y();
    EXPECT_NEAR(z * CalcDrawnShift(product, mates[0]), shift, 1e-9);
  }
}

TEST(PrismaticFits, AnotherWayHasItsOwnLengthAndTheSameArea) {
  const Product product = MakeProduct(ListJoints()[0], 0, spatial::Pose());
  const Mate mate = ListPrismatic(product).at(0);
  EXPECT_NEAR(mate.overlap, 8e-3, 1e-9);
  EXPECT_NEAR(mate.breadth, 40e-3, 1e-9);
  const Mate along = TurnToWay(product, mate, Vec3::UnitX());
  EXPECT_NEAR(along.overlap, 40e-3, 1e-9);
  EXPECT_NEAR(along.breadth, 8e-3, 1e-9);
  EXPECT_NEAR((along.a.X_BM.q() * Vec3::UnitX()).x(), 1, 1e-12);
  const Mate back = TurnToWay(product, along, Vec3::UnitZ());
  EXPECT_NEAR(back.hole_high, mate.hole_high, 1e-12);
  EXPECT_NEAR(back.breadth, mate.breadth, 1e-12);
}

TEST(PrismaticFits, AChamferOfTheTongueOrTheSlotLeadsIn) {
  for (const bool is_tongue : {true, false}) {
    Product product;
    Part* slot = testing::AddPart(&product, "slot");
    const double mouth = is_tongue ? 0 : 1e-3;
    Extrude(slot, Reverse({{-5e-3 - mouth, 8e-3},
                           {-5e-3, 8e-3 - 2 * mouth},
                           {-5e-3, 0},
                           {5e-3, 0},
                           {5e-3, 8e-3 - 2 * mouth},
                           {5e-3 + mouth, 8e-3}}));
    Part* tongue = testing::AddPart(&product, "tongue");
    const double edge = is_tongue ? 1e-3 : 0;
    Outline outline{{-5e-3 + edge, 0}, {5e-3 - edge, 0}};
    if (is_tongue) {
      outline.emplace_back(5e-3, 2 * edge);
    }
    outline.insert(outline.end(), {{5e-3, 12e-3}, {-5e-3, 12e-3}});
    if (is_tongue) {
      outline.emplace_back(-5e-3, 2 * edge);
    }
    outline.push_back(outline.front());
    Extrude(tongue, outline);
    testing::AddOccurrence(&product, product::PartId(0), spatial::Pose());
    testing::AddOccurrence(&product, product::PartId(1), spatial::Pose());
    Diagnostics diagnostics;
    Infer(&product, &diagnostics);
    const std::vector<Mate> mates = ListPrismatic(product);
    ASSERT_EQ(mates.size(), 1U);
    const LeadIn lead_in = FindLeadIn(product, mates[0]);
    EXPECT_NEAR(lead_in.width, 1e-3, 1e-9);
    EXPECT_NEAR(lead_in.angle, std::atan(0.5), 1e-9);
  }
}

TEST(PrismaticFits, LegsThatTouchAPlateSideBySideAreNone) {
  // One leg on its upper face, the other below, where the first one ends: they grip nothing.
  Product product;
  AddBlock(testing::AddPart(&product, "plate"), Vec3(20e-3, 8e-3, 0), -1e-3, 1e-3);
  Part* rod = testing::AddPart(&product, "bent rod");
  testing::AddRectangle(rod, Vec3(-5e-3, 0, 1e-3), -Vec3::UnitZ(), 5e-3, 3e-3);
  testing::AddRectangle(rod, Vec3(5e-3, 0, -1e-3), Vec3::UnitZ(), 5e-3, 3e-3);
  testing::AddOccurrence(&product, product::PartId(0), spatial::Pose());
  testing::AddOccurrence(&product, product::PartId(1), spatial::Pose());
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  EXPECT_TRUE(ListPrismatic(product).empty());
  EXPECT_EQ(product.mates.size(), 2U);
}

TEST(PrismaticFits, TwoBlocksOnEachOtherAreNone) {
  Product product;
  for (const char* name : {"lower", "upper"}) {
    Part* part = testing::AddPart(&product, name);
    testing::AddRectangle(part, Vec3(0, 0, -2e-3), -Vec3::UnitZ(), 4e-3, 4e-3);
    testing::AddRectangle(part, Vec3(0, 0, 2e-3), Vec3::UnitZ(), 4e-3, 4e-3);
  }
  testing::AddOccurrence(&product, product::PartId(0), spatial::Pose());
  testing::AddOccurrence(&product, product::PartId(1), spatial::Pose(Vec3(0, 0, 4e-3)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  ASSERT_EQ(product.mates.size(), 1U);
  EXPECT_EQ(product.mates[0].kind, MateKind::kFaceFace);
}

}  // namespace
}  // namespace hvas::mates
