// Parts that cannot come apart, or are one thing drawn in pieces, become one occurrence.

#include "product/welded_units.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <gtest/gtest.h>

#include "product/bought_name.h"
#include "product/features.h"
#include "product/product_io.h"
#include "product/test/flat_face.h"
#include "product/test/round_face.h"
#include "product/validate.h"
#include "product/variants.h"

namespace hvas::product {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/** The corners of the side of a box that faces along axis k. */
void AddSide(const Vec3& low, const Vec3& high, int k, bool is_high, Part* part) {
  const int u = (k + 1) % 3;
  const int v = (k + 2) % 3;
  std::vector<Vec3> corners;
  for (const auto& [a, b] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
    Vec3 p;
    p[k] = is_high ? high[k] : low[k];
    p[u] = a != 0 ? high[u] : low[u];
    p[v] = b != 0 ? high[v] : low[v];
    corners.push_back(p);
  }
  if (!is_high) {
    std::reverse(corners.begin(), corners.end());
  }
  testing::AddFlatFace(corners, part);
}

/** A box about the origin; with a cavity, one that is closed. */
Part MakeBox(const Vec3& size, const Vec3& cavity = Vec3::Zero()) {
  Part part;
  for (int k = 0; k < 3; ++k) {
    AddSide(-0.5 * size, 0.5 * size, k, true, &part);
    AddSide(-0.5 * size, 0.5 * size, k, false, &part);
  }
  if (cavity.norm() > 0) {
    for (int k = 0; k < 3; ++k) {
      AddSide(0.5 * cavity, -0.5 * cavity, k, true, &part);
      AddSide(0.5 * cavity, -0.5 * cavity, k, false, &part);
    }
  }
  part.solid_count = 1;
  part.mass.volume = size.prod() - cavity.prod();
  part.mass.mass = 1000 * part.mass.volume;
  const Vec3 s = size.cwiseAbs2();
  part.mass.I_BBcm_B =
      part.mass.mass / 12 *
      Vec3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()).asDiagonal().toDenseMatrix();
  part.shape_hash = "box" + std::to_string(size.x()) + std::to_string(size.y()) +
                    std::to_string(size.z()) + std::to_string(cavity.x());
  BuildFeatures(&part);
  return part;
}

/** A face of revolution about z, as quads between two circles. */
void AddRevolved(const Surface& surface, double r0, double z0, double r1, double z1, Part* part) {
  testing::StartFace(part, surface);
  constexpr int kSteps = 48;
  for (int i = 0; i < kSteps; ++i) {
    const double a = kTurn * i / kSteps;
    const double b = kTurn * (i + 1) / kSteps;
    const auto at = [](double r, double angle, double z) {
      return Vec3(r * std::cos(angle), r * std::sin(angle), z);
    };
    testing::AddQuad(part, at(r0, a, z0), at(r0, b, z0), at(r1, b, z1), at(r1, a, z1));
  }
  part->faces.back().area = std::numbers::pi * (r0 + r1) * std::hypot(r1 - r0, z1 - z0);
}

Surface MakeSurface(SurfaceKind kind, double radius, double outward) {
  Surface surface;
  surface.kind = kind;
  surface.axis = Vec3::UnitZ();
  surface.radius = radius;
  surface.outward = outward;
  return surface;
}

/** A tube about z, middle at the origin. */
Part MakeRing(double inner, double outer, double length) {
  Part part;
  const double z = 0.5 * length;
  AddRevolved(MakeSurface(SurfaceKind::kCylinder, outer, 1), outer, -z, outer, z, &part);
  AddRevolved(MakeSurface(SurfaceKind::kCylinder, inner, -1), inner, z, inner, -z, &part);
  Surface end = MakeSurface(SurfaceKind::kPlane, 0, 1);
  end.origin = {0, 0, z};
  AddRevolved(end, outer, z, inner, z, &part);
  end.origin = {0, 0, -z};
  end.axis = -Vec3::UnitZ();
  AddRevolved(end, inner, -z, outer, -z, &part);
  part.solid_count = 1;
  part.mass.volume = std::numbers::pi * (outer * outer - inner * inner) * length;
  part.mass.mass = 1000 * part.mass.volume;
  part.shape_hash = "ring" + std::to_string(1e6 * inner) + std::to_string(1e6 * outer);
  BuildFeatures(&part);
  return part;
}

Part MakeBall(double radius) {
  Part part;
  constexpr int kRows = 12;
  for (int i = 0; i < kRows; ++i) {
    const double a = -std::numbers::pi / 2 + std::numbers::pi * i / kRows;
    const double b = -std::numbers::pi / 2 + std::numbers::pi * (i + 1) / kRows;
    AddRevolved(MakeSurface(SurfaceKind::kSphere, radius, 1), radius * std::cos(a),
                radius * std::sin(a), radius * std::cos(b), radius * std::sin(b), &part);
  }
  // One face, as files have it.
  Face whole = part.faces.front();
  whole.triangle_count = static_cast<std::uint32_t>(part.mesh.triangles.size());
  whole.box_B = part.box_B;
  whole.area = 2 * kTurn * radius * radius;
  part.faces = {whole};
  part.solid_count = 1;
  part.mass.volume = 2 * kTurn / 3 * std::pow(radius, 3);
  part.mass.mass = 1000 * part.mass.volume;
  part.shape_hash = "ball" + std::to_string(1e6 * radius);
  BuildFeatures(&part);
  return part;
}

/** Two triangles without volume. */
Part MakeSheet(double side) {
  Part part;
  const double h = 0.5 * side;
  testing::AddFlatFace({{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}, &part);
  part.shape_hash = "sheet" + std::to_string(1e6 * side);
  Face& face = part.faces.front();
  part.display_mesh = part.mesh;
  face.display_triangle_count = face.triangle_count;
  return part;
}

class Builder {
 public:
  Builder() {
    product_.name = product_.source = "rig";
    Subassembly root;
    root.id = SubassemblyId(0);
    root.name = "rig";
    product_.subassemblies.push_back(root);
    paths_.emplace_back("rig");
  }

  PartId AddPart(const std::string& name, Part part) {
    part.id = PartId(product_.parts.size());
    part.name = name;
    product_.parts.push_back(std::move(part));
    return product_.parts.back().id;
  }

  SubassemblyId AddNode(const std::string& name, SubassemblyId parent = SubassemblyId(0)) {
    Subassembly node;
    node.id = SubassemblyId(product_.subassemblies.size());
    node.parent = parent;
    node.name = name;
    product_.subassemblies[parent.index()].subassemblies.push_back(node.id);
    product_.subassemblies.push_back(node);
    paths_.push_back(paths_[parent.index()] + "/" + name);
    return node.id;
  }

  OccurrenceId Place(PartId part, const Pose& X_WB, SubassemblyId parent = SubassemblyId(0),
                     const std::string& name = {}) {
    Occurrence occurrence;
    occurrence.id = OccurrenceId(product_.occurrences.size());
    occurrence.part = part;
    occurrence.parent = parent;
    occurrence.name = name.empty() ? product_.parts[part.index()].name : name;
    const std::string path = paths_[parent.index()] + "/" + occurrence.name;
    occurrence.path = path;
    for (int n = 2; std::any_of(product_.occurrences.begin(), product_.occurrences.end(),
                                [&](const auto& o) { return o.path == occurrence.path; });
         ++n) {
      occurrence.path = path + "#" + std::to_string(n);
    }
    occurrence.X_WB = X_WB;
    product_.subassemblies[parent.index()].occurrences.push_back(occurrence.id);
    product_.occurrences.push_back(occurrence);
    return occurrence.id;
  }

  /** A deep groove bearing of two rings and eight balls at X_WU. */
  void PlaceBearing(const Pose& X_WU, SubassemblyId parent, int balls = 8, double sector = kTurn) {
    if (!inner_.is_valid()) {
      inner_ = AddPart("inner", MakeRing(4e-3, 6e-3, 7e-3));
      outer_ = AddPart("outer", MakeRing(9e-3, 11e-3, 7e-3));
      ball_ = AddPart("ball", MakeBall(1.6e-3));
    }
    Place(inner_, X_WU, parent);
    for (int i = 0; i < balls; ++i) {
      const double a = sector * i / balls;
      Place(ball_, X_WU * Pose(Vec3(7.5e-3 * std::cos(a), 7.5e-3 * std::sin(a), 0)), parent);
    }
    Place(outer_, X_WU, parent);
  }

  Product& product() { return product_; }

 private:
  Product product_;
  std::vector<std::string> paths_;
  PartId inner_, outer_, ball_;
};

Diagnostics Weld(Product* product, const std::vector<KeptApart>& apart = {}) {
  Diagnostics diagnostics;
  EXPECT_TRUE(WeldUnits(apart, product, &diagnostics));
  EXPECT_TRUE(Validate(*product));
  return diagnostics;
}

const Pose kTurned(Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), Vec3(0.1, 0.2, 0.3));

TEST(WeldedUnits, SolidAndShellOfOneScrewAreOnePartWithThePathOfTheScrew) {
  Builder b;
  const PartId solid = b.AddPart("SOLID", MakeBox({2e-3, 2e-3, 10e-3}));
  const PartId shell = b.AddPart("SHELL", MakeSheet(1e-3));
  const PartId plate = b.AddPart("plate", MakeBox({50e-3, 50e-3, 2e-3}));
  b.Place(plate, Pose(Vec3(0, 0, -5e-3)));
  for (int i = 0; i < 2; ++i) {
    const SubassemblyId node = b.AddNode("screw M2x10:" + std::to_string(i + 1));
    const Pose X_WB(Vec3(i * 20e-3, 0, 0));
    b.Place(shell, X_WB, node);
    b.Place(solid, X_WB, node);
  }
  const double mass = b.product().mass();
  const Diagnostics told = Weld(&b.product());
  const Product& product = b.product();
  ASSERT_EQ(product.occurrences.size(), 3u);
  EXPECT_EQ(product.subassemblies.size(), 1u);
  EXPECT_EQ(product.parts.size(), 2u);  // Both screws share one.
  const Occurrence& screw = product.occurrences[1];
  EXPECT_EQ(screw.path, "rig/screw M2x10:1");
  EXPECT_EQ(screw.bodies,
            (std::vector<std::string>{"rig/screw M2x10:1/SHELL", "rig/screw M2x10:1/SOLID"}));
  const Part& part = product.part_of(screw.id);
  EXPECT_EQ(part.name, "screw M2x10");
  EXPECT_EQ(part.mesh.triangles.size(), 12u);         // The sheet is no surface to touch,
  EXPECT_EQ(part.display_mesh.triangles.size(), 2u);  // but one to see.
  EXPECT_EQ(part.faces.size(), 7u);
  EXPECT_NEAR(product.mass(), mass, 1e-12 * mass);
  ASSERT_EQ(told.items().size(), 1u);
  EXPECT_EQ(told.items()[0].code, "welded-unit");
  EXPECT_EQ(told.items()[0].severity, Severity::kNote);
  EXPECT_EQ(told.items()[0].entity, "rig/screw M2x10:1");
  for (const char* text : {"SHELL", "SOLID", "bodies of one part", "1 more"}) {
    EXPECT_NE(told.items()[0].message.find(text), std::string::npos) << text;
  }
}

TEST(WeldedUnits, HeadAndThreadOfOneScrewAreOnePartAndBoltAndNutOfOneNodeAreTwo) {
  for (const auto& [first, second, count] :
       {std::tuple("head", "Thread M3", 1u), std::tuple("SOLID", "thread_2", 1u),
        std::tuple("bolt", "nut", 2u), std::tuple("screw", "washer", 2u)}) {
    Builder b;
    const SubassemblyId node = b.AddNode("bolt M3x10");
    b.Place(b.AddPart(first, MakeBox({6e-3, 6e-3, 3e-3})), Pose(Vec3(0, 0, 6.5e-3)), node);
    b.Place(b.AddPart(second, MakeBox({3e-3, 3e-3, 10e-3})), Pose(), node);
    Weld(&b.product());
    EXPECT_EQ(b.product().occurrences.size(), count) << first << ", " << second;
  }
}

TEST(WeldedUnits, AThreadSurfaceInAScrewOfAFlatFileIsPartOfItAndALabelInAHousingIsNot) {
  for (const auto& [solid, count] : {std::pair("screw M3", 1u), std::pair("housing", 2u)}) {
    Builder b;
    b.Place(b.AddPart(solid, MakeBox({6e-3, 6e-3, 10e-3})), Pose());
    b.Place(b.AddPart("surface model", MakeSheet(3e-3)), Pose());
    Weld(&b.product());
    EXPECT_EQ(b.product().occurrences.size(), count) << solid;
  }
}

TEST(WeldedUnits, MassOfAWeldIsThatOfItsBodiesByTheParallelAxisTheorem) {
  Builder b;
  const SubassemblyId node = b.AddNode("servo");
  const PartId half = b.AddPart("half", MakeBox({20e-3, 10e-3, 30e-3}));
  b.Place(half, kTurned * Pose(Vec3(-10e-3, 0, 0)), node);
  b.Place(half, kTurned * Pose(Vec3(10e-3, 0, 0)), node);
  Weld(&b.product());
  ASSERT_EQ(b.product().occurrences.size(), 1u);
  const Occurrence& whole = b.product().occurrences[0];
  const MassProperties& mass = b.product().part_of(whole.id).mass;
  const MassProperties expected = MakeBox({40e-3, 10e-3, 30e-3}).mass;
  EXPECT_NEAR(mass.mass, expected.mass, 1e-12);
  EXPECT_LT((whole.X_WB * mass.p_BoBcm_B - kTurned.p()).norm(), 1e-12);
  EXPECT_LT((mass.I_BBcm_B - expected.I_BBcm_B).norm(), 1e-9 * expected.I_BBcm_B.norm());
}

TEST(WeldedUnits, RingsAndBallsAreABearingInAnyPoseAndWithoutAName) {
  for (const bool is_alone : {true, false}) {
    Builder b;
    const PartId shaft = b.AddPart("axle", MakeRing(1e-3, 4e-3, 60e-3));
    b.Place(shaft, kTurned);
    const SubassemblyId node = is_alone ? b.AddNode("unit 7") : SubassemblyId(0);
    b.PlaceBearing(kTurned, node);
    b.PlaceBearing(kTurned * Pose(Vec3(0, 0, 20e-3)), SubassemblyId(0));
    const Diagnostics told = Weld(&b.product());
    const Product& product = b.product();
    ASSERT_EQ(product.occurrences.size(), 3u);
    EXPECT_EQ(product.parts.size(), 2u);
    EXPECT_EQ(product.occurrences[1].bodies.size(), 10u);
    EXPECT_EQ(product.occurrences[1].path, is_alone ? "rig/unit 7" : "rig/outer");
    EXPECT_EQ(product.part_of(OccurrenceId(1)).solid_count, 10);
    ASSERT_EQ(told.items().size(), 1u);
    EXPECT_NE(told.items()[0].message.find("8 x ball"), std::string::npos);
    EXPECT_NE(told.items()[0].message.find("rolling bearing"), std::string::npos);
  }
}

TEST(WeldedUnits, BallsWithoutRingsTwoBallsAndBallsOnOneSideAreNoBearing) {
  for (const auto& [balls, sector] : {std::pair(2, kTurn), {8, kTurn / 2}}) {
    Builder b;
    b.PlaceBearing(kTurned, SubassemblyId(0), balls, sector);
    const std::size_t count = b.product().occurrences.size();
    EXPECT_TRUE(Weld(&b.product()).items().empty());
    EXPECT_EQ(b.product().occurrences.size(), count);
  }
  Builder b;
  const PartId ball = b.AddPart("ball", MakeBall(1.6e-3));
  for (int i = 0; i < 8; ++i) {
    b.Place(ball, Pose(Quat(Eigen::AngleAxisd(kTurn * i / 8, Vec3::UnitZ())), Vec3::Zero()) *
                      Pose(Vec3(7.5e-3, 0, 0)));
  }
  b.Place(b.AddPart("plate", MakeRing(4e-3, 30e-3, 2e-3)), Pose(Vec3(0, 0, -2.6e-3)));
  EXPECT_TRUE(Weld(&b.product()).items().empty());
}

TEST(WeldedUnits, CopiesAtOnePlaceAreLeftOutAndGoWithTheFirst) {
  Builder b;
  const PartId box = b.AddPart("box", MakeBox({1e-3, 1e-3, 1e-3}));
  for (int i = 0; i < 3; ++i) {
    b.Place(box, kTurned);
  }
  b.Place(box, Pose());
  Product apart = b.product();
  const Diagnostics told = Weld(&b.product());
  ASSERT_EQ(b.product().occurrences.size(), 2u);
  EXPECT_EQ(b.product().occurrences[0].bodies,
            (std::vector<std::string>{"rig/box", "rig/box#2", "rig/box#3"}));
  EXPECT_EQ(b.product().parts.size(), 1u);
  ASSERT_EQ(told.items().size(), 1u);
  EXPECT_EQ(told.items()[0].code, "duplicate-part");
  EXPECT_EQ(told.items()[0].severity, Severity::kNote);
  EXPECT_NE(told.items()[0].message.find("2 copies"), std::string::npos);
  EXPECT_TRUE(Weld(&apart, {{"box#3", {}}}).items().empty());
  EXPECT_EQ(apart.occurrences.size(), 4u);
}

/** A subassembly of a case and a lid, and a part somewhere. */
Builder MakeUnit(const std::string& name) {
  Builder b;
  const SubassemblyId node = b.AddNode(name);
  b.Place(b.AddPart("body", MakeBox({20e-3, 20e-3, 10e-3})), Pose(), node);
  b.Place(b.AddPart("lid", MakeBox({20e-3, 20e-3, 2e-3})), Pose(Vec3(0, 0, 6e-3)), node);
  b.Place(b.AddPart("plate", MakeBox({80e-3, 80e-3, 2e-3})), Pose(Vec3(0, 0, -6e-3)));
  return b;
}

TEST(WeldedUnits, SubassembliesWithTheNameOfABoughtUnitAreOneBody) {
  for (const char* name : {"Servo 9g", "NEMA17 stepper", "608ZZ", "Motor", "USB-C", "LM8UU"}) {
    Builder b = MakeUnit(name);
    const Diagnostics told = Weld(&b.product());
    EXPECT_EQ(b.product().occurrences.size(), 2u) << name;
    ASSERT_EQ(told.items().size(), 1u) << name;
    EXPECT_NE(told.items()[0].message.find("bought"), std::string::npos);
  }
  for (const char* name : {"motor mount", "Arm", "lid group", "Motor assembly", "servo screws"}) {
    Builder b = MakeUnit(name);
    EXPECT_TRUE(Weld(&b.product()).items().empty()) << name;
    EXPECT_EQ(b.product().occurrences.size(), 3u) << name;
  }
}

TEST(WeldedUnits, ABoughtUnitHasItsOwnScrewsAndTheNameOfTheUpperNode) {
  for (const bool is_screwed_from_outside : {false, true}) {
    Builder b;
    const SubassemblyId unit = b.AddNode("XL-330 v1:1");
    const SubassemblyId model = b.AddNode("model 7", unit);
    const PartId ring = b.AddPart("flange", MakeRing(1.5e-3, 8e-3, 2e-3));
    const PartId screw = b.AddPart("screw M3", MakeRing(0.2e-3, 1.5e-3, 12e-3));
    b.Place(screw, Pose(Vec3(0, 0, 1e-3)), is_screwed_from_outside ? SubassemblyId(0) : model);
    b.Place(ring, Pose(), model);
    b.Place(ring, Pose(Vec3(0, 0, 2e-3)), model);
    Weld(&b.product());
    EXPECT_EQ(b.product().occurrences.size(), is_screwed_from_outside ? 3u : 1u);
    if (!is_screwed_from_outside) {
      EXPECT_EQ(b.product().occurrences[0].path, "rig/XL-330 v1:1");
      EXPECT_EQ(b.product().subassemblies.size(), 1u);
    }
  }
}

TEST(WeldedUnits, WhatASubassemblyIsClosedAroundKeepsItApart) {
  Builder b = MakeUnit("Servo 9g");
  Product& product = b.product();
  product.parts[0] = MakeBox({20e-3, 20e-3, 10e-3}, {16e-3, 16e-3, 6e-3});
  product.parts[0].id = PartId(0);
  product.parts[0].name = "body";
  const Product closed = product;
  // It cannot leave the closed body by a straight way: so much is rule 3. It is enclosed: rule 4.
  b.Place(b.AddPart("wheel", MakeBox({4e-3, 4e-3, 4e-3})), Pose());
  const Diagnostics told = Weld(&product);
  ASSERT_EQ(told.items().size(), 1u);
  EXPECT_NE(told.items()[0].message.find("enclosed"), std::string::npos);
  EXPECT_EQ(product.occurrences.size(), 3u);
}

TEST(WeldedUnits, APartInAClosedCavityIsEnclosedAndOneInAnOpenOneIsNot) {
  for (const bool is_open : {false, true}) {
    Builder b;
    Part box = MakeBox({20e-3, 20e-3, 20e-3}, {10e-3, 10e-3, 10e-3});
    if (is_open) {  // The top and the ceiling of the cavity are missing.
      box.faces[4].triangle_count = 0;
      box.faces[10].triangle_count = 0;
      box.faces[11].triangle_count = 0;
      box.faces[5].triangle_count = is_open ? 0 : 2;
    }
    b.Place(b.AddPart("box", box), Pose());
    b.Place(b.AddPart("core", MakeBox({4e-3, 4e-3, 4e-3})), Pose());
    Weld(&b.product());
    EXPECT_EQ(b.product().occurrences.size(), is_open ? 2u : 1u);
  }
}

TEST(WeldedUnits, ComponentsOfABoardAreOneBodyEachAndPartsOfACaseAreNot) {
  for (const bool is_board : {true, false}) {
    Builder b;
    const PartId board = b.AddPart(is_board ? "PCB" : "Tray", MakeBox({60e-3, 60e-3, 1.6e-3}));
    const PartId body = b.AddPart("body", MakeBox({2e-3, 1e-3, 1e-3}));
    const PartId end = b.AddPart("end", MakeBox({0.5e-3, 1e-3, 1e-3}));
    b.Place(board, Pose(Vec3(0, 0, -1.3e-3)));
    for (int i = 0; i < 4; ++i) {
      const SubassemblyId outer = b.AddNode("R" + std::to_string(i + 1));
      const SubassemblyId inner = b.AddNode("0603", outer);
      const Pose X(Vec3(i * 5e-3, 0, 0));
      b.Place(body, X, inner);
      b.Place(end, X * Pose(Vec3(1.25e-3, 0, 0)), inner);
      b.Place(end, X * Pose(Vec3(-1.25e-3, 0, 0)), inner);
    }
    Weld(&b.product());
    EXPECT_EQ(b.product().occurrences.size(), is_board ? 5u : 13u);
    EXPECT_EQ(b.product().parts.size(), is_board ? 2u : 3u);
    if (is_board) {
      EXPECT_EQ(b.product().occurrences[2].path, "rig/R2");
    }
  }
}

TEST(WeldedUnits, AComponentOfABoardThatHasNoBodiesIsNoBody) {
  Builder b;
  b.Place(b.AddPart("PCB", MakeBox({60e-3, 60e-3, 1.6e-3})), Pose());
  for (int i = 0; i < 3; ++i) {
    b.AddNode("R" + std::to_string(i + 1));
  }
  Weld(&b.product());
  EXPECT_EQ(b.product().occurrences.size(), 1u);
}

TEST(WeldedUnits, WhatIsNamedStaysApartByUnitMemberOrAll) {
  for (const char* name : {"all", "Servo 9g", "rig/Servo 9g", "lid", "Servo 9g/lid"}) {
    Builder b = MakeUnit("Servo 9g");
    EXPECT_TRUE(Weld(&b.product(), {{name, {}}}).items().empty()) << name;
    EXPECT_EQ(b.product().occurrences.size(), 3u) << name;
  }
  Builder b = MakeUnit("Servo 9g");
  Diagnostics diagnostics;
  const auto welded = WeldUnits({{"cup", "rig.hvas.json:3"}}, &b.product(), &diagnostics);
  ASSERT_FALSE(welded.has_value());
  EXPECT_EQ(welded.error().where, "rig.hvas.json:3");
  EXPECT_NE(welded.error().message.find("cup"), std::string::npos);
}

TEST(WeldedUnits, AHornInTheNodeOfItsServoStaysApartWithItsScrewAndAnEnclosedOneDoesNot) {
  for (const bool is_enclosed : {false, true}) {
    Builder b;
    const SubassemblyId node = b.AddNode("SG90 v3");
    b.Place(b.AddPart("SOLID", MakeBox({20e-3, 12e-3, 20e-3},
                                       is_enclosed ? Vec3(16e-3, 10e-3, 16e-3) : Vec3::Zero())),
            Pose(), node);
    b.Place(b.AddPart("gear", MakeBox({6e-3, 6e-3, 2e-3})), Pose(Vec3(0, 0, 11e-3)), node);
    const Pose X_WH(Vec3(0, 0, is_enclosed ? 0 : 13e-3));
    b.Place(b.AddPart("Horn", MakeRing(1.2e-3, 3e-3, 2e-3)), X_WH, node);
    b.Place(b.AddPart("screw M2x6", MakeRing(0.2e-3, 1e-3, 6e-3)), X_WH, node);
    Weld(&b.product());
    const Product& product = b.product();
    ASSERT_EQ(product.occurrences.size(), is_enclosed ? 1u : 3u);
    EXPECT_EQ(product.occurrences[0].name, "SG90 v3");
    if (!is_enclosed) {
      EXPECT_EQ(product.occurrences[0].bodies.size(), 2u);
      EXPECT_EQ(product.occurrences[1].name, "Horn");
    }
  }
}

TEST(WeldedUnits, APartOfAServoWithARowOfHolesIsItsHornAndOneWithFourIsNot) {
  for (const int holes : {4, 6}) {
    Builder b;
    const SubassemblyId node = b.AddNode("Micro Servo 9g");
    b.Place(b.AddPart("body 1", MakeBox({20e-3, 12e-3, 20e-3})), Pose(), node);
    b.Place(b.AddPart("body 2", MakeBox({6e-3, 6e-3, 2e-3})), Pose(Vec3(0, 0, 11e-3)), node);
    Part horn = MakeBox({30e-3, 6e-3, 2e-3});
    horn.forms.emplace_back();
    horn.forms.back().kind = FormKind::kHolePattern;
    horn.forms.back().count = holes;
    b.Place(b.AddPart("body 3", horn), Pose(Vec3(0, 0, 13e-3)), node);
    Weld(&b.product());
    EXPECT_EQ(b.product().occurrences.size(), holes < 5 ? 1u : 2u);
  }
}

TEST(WeldedUnits, VariantsAtOnePlaceAreLeftOutWithAWarningAndWhatIsDrawnIntoAPartIsNot) {
  // Two lengths of one bar at one end; a bar in a block; two bars that overlap by half.
  const auto place = [](const Vec3& size, const Vec3& p, const Vec3& other, const Vec3& q) {
    Builder b;
    b.Place(b.AddPart("bar", MakeBox(size)), kTurned * Pose(p));
    b.Place(b.AddPart("other bar", MakeBox(other)), kTurned * Pose(q));
    return b;
  };
  const Vec3 bar(4e-3, 4e-3, 20e-3);
  Builder lengths = place(bar, Vec3::Zero(), {4e-3, 4e-3, 12e-3}, {0, 0, 4e-3});
  Product apart = lengths.product();
  const Diagnostics told = Weld(&lengths.product());
  ASSERT_EQ(lengths.product().occurrences.size(), 1u);
  EXPECT_EQ(lengths.product().occurrences[0].path, "rig/bar");
  EXPECT_EQ(lengths.product().occurrences[0].bodies,
            (std::vector<std::string>{"rig/bar", "rig/other bar"}));
  ASSERT_EQ(told.items().size(), 1u);
  EXPECT_EQ(told.items()[0].code, "variant-part");
  EXPECT_EQ(told.items()[0].severity, Severity::kWarning);
  EXPECT_EQ(told.items()[0].entity, "rig/other bar");
  EXPECT_NE(told.items()[0].message.find("rig/bar"), std::string::npos);
  EXPECT_TRUE(Weld(&apart, {{"other bar", {}}}).items().empty());
  EXPECT_EQ(apart.occurrences.size(), 2u);

  for (Builder b :
       {place({20e-3, 20e-3, 20e-3}, Vec3::Zero(), {12e-3, 12e-3, 14e-3}, {0, 0, 3e-3}),
        place(bar, Vec3::Zero(), bar, {0, 0, 8e-3}), place(bar, Vec3::Zero(), bar, {0, 2e-3, 0})}) {
    EXPECT_TRUE(Weld(&b.product()).items().empty());
    EXPECT_EQ(b.product().occurrences.size(), 2u);
  }
  // Nearly the same box, with no face in common.
  Builder alike = place(bar, Vec3::Zero(), {4.1e-3, 4.1e-3, 20.2e-3}, Vec3::Zero());
  Weld(&alike.product());
  EXPECT_EQ(alike.product().occurrences.size(), 1u);
}

TEST(Variants, SharedVolumeIsThatOfOverlappingBoxesWithinALineOfTheGrid) {
  Builder b;
  b.Place(b.AddPart("a", MakeBox({10e-3, 20e-3, 30e-3})), kTurned);
  b.Place(b.AddPart("b", MakeBox({10e-3, 20e-3, 30e-3})), kTurned * Pose(Vec3(4e-3, 5e-3, 6e-3)));
  const SharedVolume volume = CalcSharedVolume(b.product(), OccurrenceId(0), OccurrenceId(1));
  EXPECT_NEAR(volume.first, 6e-6, 0.05 * 6e-6);
  EXPECT_NEAR(volume.second, 6e-6, 0.05 * 6e-6);
  EXPECT_NEAR(volume.both, 6e-3 * 15e-3 * 24e-3, 0.05 * 6e-3 * 15e-3 * 24e-3);
}

TEST(WeldedUnits, BodiesSurviveSerialisation) {
  Builder b = MakeUnit("Servo 9g");
  Weld(&b.product());
  const auto again = DeserialiseProduct(SerialiseProduct(b.product()));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->occurrences[0].bodies, b.product().occurrences[0].bodies);
}

TEST(BoughtName, TellsDesignationsFromWordsAndFromWhatIsMade) {
  for (const char* name : {"608ZZ", "6204-2RS", "MR105", "F688ZZ", "LM8UU v2", "SG90", "mg996r",
                           "Nema 23", "JST-PH", "Rillenkugellager", "USB_C_Receptacle"}) {
    EXPECT_EQ(ClassifyBoughtName(name), BoughtName::kDesignation) << name;
  }
  for (const char* name : {"DC Motor v1:2", "Stecker", "LED:3"}) {
    EXPECT_EQ(ClassifyBoughtName(name), BoughtName::kWord) << name;
  }
  for (const char* name :
       {"plate 6204", "608", "top assembly", "motor_mount", "bearing block 608ZZ", "Servo horn",
        "ledge", "M3x12", "switch cover", "gripper", "", "USB housing", "gearbox"}) {
    EXPECT_EQ(ClassifyBoughtName(name), BoughtName::kNone) << name;
  }
}

}  // namespace
}  // namespace hvas::product
