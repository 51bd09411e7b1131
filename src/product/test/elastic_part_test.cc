// Parts that push back: what they are by name and form, and how large.

#include "product/elastic_part.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "product/product.h"
#include "product/test/coil_mesh.h"
#include "product/test/mesh_mass.h"

namespace hvas::product {
namespace {

constexpr double kElasticMm = 1e-3;

/** Volume, inertia and box of a part's mesh, and one face of all its triangles. */
void MeasureMesh(Part* part) {
  part->mass = testing::CalcMass(part->mesh, 1);
  for (const Vec3& p : part->mesh.vertices) {
    part->box_B.Add(p);
  }
  Face face;
  face.surface.kind = SurfaceKind::kFreeform;
  face.triangle_count = static_cast<std::uint32_t>(part->mesh.triangles.size());
  face.box_B = part->box_B;
  part->faces.push_back(face);
}

Part MakeCoilPart(const testing::Coil& coil, const std::string& name,
                  const Quat& turned = Quat::Identity()) {
  Part part;
  part.name = name;
  testing::CoilMesh mesh = testing::MakeCoil(coil);
  part.mesh.vertices = std::move(mesh.vertices);
  part.mesh.triangles = std::move(mesh.triangles);
  for (Vec3& p : part.mesh.vertices) {
    p = turned * p;
  }
  MeasureMesh(&part);
  return part;
}

/** A ring about z from profile points (r, z), in order around its material. */
Part MakeTurned(const std::vector<std::pair<double, double>>& profile, const std::string& name,
                SurfaceKind kind = SurfaceKind::kFreeform) {
  constexpr int kSegments = 96;
  Part part;
  part.name = name;
  const auto count = profile.size();
  for (int i = 0; i < kSegments; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSegments;
    for (const auto& [r, z] : profile) {
      part.mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
  const auto corner = [count](int i, std::size_t k) {
    return static_cast<std::uint32_t>(static_cast<std::size_t>(i % kSegments) * count + k % count);
  };
  for (int i = 0; i < kSegments; ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      part.mesh.triangles.push_back({corner(i, k), corner(i + 1, k), corner(i + 1, k + 1)});
      part.mesh.triangles.push_back({corner(i, k), corner(i + 1, k + 1), corner(i, k + 1)});
    }
  }
  MeasureMesh(&part);
  part.faces.clear();
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [r, z] = profile[k];
    const auto& [r2, z2] = profile[(k + 1) % count];
    Face face;
    face.surface.axis = Vec3::UnitZ();
    face.surface.kind = std::abs(z - z2) < 1e-12   ? SurfaceKind::kPlane
                        : std::abs(r - r2) < 1e-12 ? SurfaceKind::kCylinder
                                                   : kind;
    face.area = std::numbers::pi * (r + r2) * std::hypot(r - r2, z - z2);
    part.faces.push_back(face);
  }
  return part;
}

Part MakeFlatRing(double inner, double outer, double height, const std::string& name) {
  return MakeTurned({{inner / 2, 0}, {outer / 2, 0}, {outer / 2, height}, {inner / 2, height}},
                    name);
}

/** A disc of DIN 2093: its section is a parallelogram. */
Part MakeDiscPart(double outer, double inner, double t, double h0, const std::string& name) {
  return MakeTurned({{inner / 2, h0}, {outer / 2, 0}, {outer / 2, t}, {inner / 2, h0 + t}}, name,
                    SurfaceKind::kCone);
}

TEST(ElasticPartTest, ACoilIsASpringByItsFormWithItsWireDiameterAndActiveCoils) {
  const testing::Coil coil;
  const auto spring = FindElasticPart(MakeCoilPart(coil, "part 7"));
  ASSERT_TRUE(spring);
  EXPECT_EQ(spring->kind, ElasticKind::kCoilSpring);
  EXPECT_NEAR(spring->thickness, coil.wire, 0.01 * coil.wire);
  EXPECT_NEAR(0.5 * (spring->outer + spring->inner), coil.mean_diameter, 0.05 * kElasticMm);
  EXPECT_NEAR(spring->coils, coil.active, 0.1);
  EXPECT_NEAR(spring->length, testing::MakeCoil(coil).length, 0.01 * kElasticMm);
  EXPECT_EQ(spring->free_size, spring->length);
  EXPECT_GT(std::abs(spring->axis_B.z()), 0.9999);
  EXPECT_EQ(spring->modulus, 206e9);
  EXPECT_FALSE(spring->reason.empty());
}

TEST(ElasticPartTest, ACoilIsASpringHoweverItStands) {
  const testing::Coil coil{1e-3, 10e-3, 8, 2.5e-3, 1};
  const Quat turned(Eigen::AngleAxisd(0.7, Vec3(1, 2, 0.5).normalized()));
  const auto spring = FindElasticPart(MakeCoilPart(coil, "feder", turned));
  ASSERT_TRUE(spring);
  EXPECT_NEAR(std::abs(spring->axis_B.dot(turned * Vec3::UnitZ())), 1, 1e-3);
  EXPECT_NEAR(spring->coils, 8, 0.6);
  EXPECT_NEAR(spring->thickness, 1e-3, 0.3e-3);
}

// Without closed ends all of its turns are active.
TEST(ElasticPartTest, PlainEndsAreActive) {
  const testing::Coil coil{1.5e-3, 12e-3, 6, 4e-3, 0};
  const auto spring = FindElasticPart(MakeCoilPart(coil, "spring"));
  ASSERT_TRUE(spring);
  EXPECT_NEAR(spring->coils, 6, 0.2);
}

TEST(ElasticPartTest, TubesAndTensionSpringsAreNoCompressionSprings) {
  EXPECT_FALSE(FindElasticPart(MakeFlatRing(10e-3, 14e-3, 20e-3, "bushing")));
  EXPECT_FALSE(FindElasticPart(MakeCoilPart({2e-3, 14e-3, 5, 4e-3, 1}, "tension spring 3")));
  // Its coils touch.
  EXPECT_FALSE(FindElasticPart(MakeCoilPart({2e-3, 14e-3, 5, 2.04e-3, 1}, "spring")));
}

TEST(ElasticPartTest, ADiscSpringIsACone) {
  for (const std::string name : {"part 3", "Tellerfeder DIN 2093 - A 20"}) {
    const auto disc = FindElasticPart(MakeDiscPart(20e-3, 10.2e-3, 1.1e-3, 0.45e-3, name));
    ASSERT_TRUE(disc) << name;
    EXPECT_EQ(disc->kind, ElasticKind::kDiscSpring);
    EXPECT_NEAR(disc->outer, 20e-3, 1e-6);
    EXPECT_NEAR(disc->inner, 10.2e-3, 1e-6);
    EXPECT_NEAR(disc->thickness, 1.1e-3, 5e-6);
    EXPECT_NEAR(disc->free_size, 1.55e-3, 1e-6);
  }
  // Drawn flat, it has the free height of the standard; without a name it is a plain washer.
  const auto flat = FindElasticPart(MakeFlatRing(10.2e-3, 20e-3, 1.1e-3, "disc spring"));
  ASSERT_TRUE(flat);
  EXPECT_NEAR(flat->free_size, 1.55e-3, 1e-6);
  EXPECT_NEAR(flat->length, 1.1e-3, 1e-6);
  EXPECT_FALSE(FindElasticPart(MakeFlatRing(10.2e-3, 20e-3, 1.1e-3, "washer")));
}

TEST(ElasticPartTest, ALockWasherThatIsDrawnFlatIsAsHighAsItIsThickUntilStated) {
  for (const std::string name : {"Federring DIN 127 - A8", "spring washer M8"}) {
    const auto washer = FindElasticPart(MakeFlatRing(8.1e-3, 14.8e-3, 2e-3, name));
    ASSERT_TRUE(washer) << name;
    EXPECT_EQ(washer->kind, ElasticKind::kLockWasher);
    EXPECT_NEAR(washer->free_size, 2e-3, 1e-6);
    EXPECT_NEAR(washer->thickness, 2e-3, 1e-6);
  }
}

TEST(ElasticPartTest, AGasketIsASheetWithItsAreaAndEdges) {
  const auto gasket = FindElasticPart(MakeFlatRing(40e-3, 60e-3, 1.5e-3, "gasket"));
  ASSERT_TRUE(gasket);
  EXPECT_EQ(gasket->kind, ElasticKind::kGasket);
  const double area = std::numbers::pi / 4 * (60e-3 * 60e-3 - 40e-3 * 40e-3);
  EXPECT_NEAR(gasket->area, area, 0.01 * area);
  const double edges = std::numbers::pi * 100e-3 * 1.5e-3;
  EXPECT_NEAR(gasket->free_area, edges, 0.01 * edges);
  EXPECT_EQ(gasket->modulus, 5e6);
  // A ring of square section is no sheet.
  EXPECT_FALSE(FindElasticPart(MakeFlatRing(40e-3, 48e-3, 8e-3, "seal")));
}

TEST(ElasticPartTest, ASlitPinHasTheDiameterOfItsStandard) {
  const auto pin = FindElasticPart(MakeFlatRing(2.4e-3, 4e-3, 20e-3, "Spannstift ISO 8752 4x20"));
  ASSERT_TRUE(pin);
  EXPECT_EQ(pin->kind, ElasticKind::kSlitPin);
  EXPECT_NEAR(pin->free_size, 4.5e-3, 1e-6);
  EXPECT_NEAR(pin->thickness, 0.8e-3, 1e-6);
  const auto free = FindElasticPart(MakeFlatRing(2.8e-3, 4.4e-3, 20e-3, "roll pin"));
  ASSERT_TRUE(free);
  EXPECT_NEAR(free->free_size, 4.4e-3, 1e-6);
}

TEST(ElasticPartTest, ATubeOfRubberIsASleeve) {
  Part part = MakeFlatRing(10e-3, 18e-3, 20e-3, "bushing");
  EXPECT_FALSE(FindElasticPart(part));
  part.material.name = "NBR rubber";
  const auto sleeve = FindElasticPart(part);
  ASSERT_TRUE(sleeve);
  EXPECT_EQ(sleeve->kind, ElasticKind::kSleeve);
  EXPECT_NEAR(sleeve->thickness, 4e-3, 1e-6);
}

TEST(ElasticPartTest, ALeafSpringIsAStripByItsName) {
  Part part = MakeFlatRing(10e-3, 18e-3, 20e-3, "leaf spring");
  part.box_B = {Vec3::Zero(), Vec3(40e-3, 10e-3, 4e-3)};
  part.mass.volume = 40e-3 * 10e-3 * 0.5e-3;
  const auto leaf = FindElasticPart(part);
  ASSERT_TRUE(leaf);
  EXPECT_EQ(leaf->kind, ElasticKind::kLeafSpring);
  EXPECT_NEAR(leaf->thickness, 0.5e-3, 1e-9);
  EXPECT_NEAR(leaf->outer, 40e-3, 1e-9);
  EXPECT_NEAR(leaf->inner, 10e-3, 1e-9);
}

/** A seal of 35 x 20 x 8 mm: a casing, its floor, and a lip that stands on the floor. */
Part MakeSealPart(double edge, const std::string& name) {
  const auto mm = [](double r, double z) { return std::pair(r * kElasticMm, z * kElasticMm); };
  Part part = MakeTurned({mm(12, 0), mm(17.5, 0), mm(17.5, 8), mm(16.5, 8), mm(16.5, 1.2),
                          mm(13.2, 1.2), mm(edge + 1.2, 6), mm(edge, 5), mm(edge, 4.9)},
                         name);
  part.faces.clear();
  MeasureMesh(&part);
  return part;
}

TEST(ElasticPartTest, ALipIsMeasuredFromItsRootToItsEdge) {
  const auto seal = FindElasticPart(MakeSealPart(9.6, "oil seal 20x35x8"));
  ASSERT_TRUE(seal);
  EXPECT_EQ(seal->kind, ElasticKind::kLipSeal);
  EXPECT_NEAR(seal->free_size, 19.2e-3, 1e-6);
  EXPECT_NEAR(seal->lip_length(), 3.8e-3, 0.2e-3);
  EXPECT_NEAR(seal->thickness, 1.5e-3, 0.3e-3);
  // The edge is at 4.95 mm of 8; whichever way the axis was taken, the root is below it.
  EXPECT_NEAR(std::abs(seal->lip_at), 0.95e-3, 0.1e-3);
  EXPECT_GT((seal->lip_at - seal->lip_root) * seal->axis_B.z(), 3.5e-3);
  EXPECT_GT(seal->lip_radius, 11e-3);
  EXPECT_LT(seal->lip_radius, 13.3e-3);
  EXPECT_EQ(seal->modulus, 5e6);
}

TEST(ElasticPartTest, ASealWithoutALipHasNone) {
  const auto seal = FindElasticPart(MakeFlatRing(20e-3, 35e-3, 8e-3, "Wellendichtring"));
  ASSERT_TRUE(seal);
  EXPECT_EQ(seal->kind, ElasticKind::kLipSeal);
  EXPECT_EQ(seal->lip_length(), 0);
  // What is named after a seal is something else.
  EXPECT_FALSE(FindElasticPart(MakeFlatRing(20e-3, 35e-3, 8e-3, "oil seal housing")));
}

}  // namespace
}  // namespace hvas::product
