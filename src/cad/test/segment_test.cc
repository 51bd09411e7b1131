#include "cad/triangles/segment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <gp_Ax2.hxx>
#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "base/units.h"
#include "cad/process/read_cad.h"
#include "cad/test/mesh_fixture.h"
#include "cad/test/step_fixture.h"
#include "cad/triangles/triangle_part.h"

namespace hvas::cad {
namespace {

using product::Face;
using product::Part;
using spatial::SurfaceKind;
using testing::ProfilePoint;

Part Build(const TriangleSoup& soup, Diagnostics* diagnostics = nullptr) {
  Part part;
  part.name = "part";
  Diagnostics own;
  EXPECT_TRUE(BuildTrianglePart(soup, &part, diagnostics != nullptr ? diagnostics : &own));
  return part;
}

/** Faces by kind: planes, cylinders, cones, spheres, tori, freeform. */
std::array<int, 6> CountKinds(const Part& part) {
  std::array<int, 6> count{};
  for (const Face& face : part.faces) {
    ++count[static_cast<std::size_t>(face.surface.kind)];
  }
  return count;
}

using Kinds = std::array<int, 6>;

const Face& FaceOf(const Part& part, SurfaceKind kind) {
  const auto face = std::find_if(part.faces.begin(), part.faces.end(),
                                 [kind](const Face& f) { return f.surface.kind == kind; });
  EXPECT_NE(face, part.faces.end());
  return face == part.faces.end() ? part.faces.front() : *face;
}

spatial::Pose SomePose() {
  return {Quat(0.4, -0.3, 0.7, 0.5).normalized(), Vec3(0.03, -0.11, 0.07)};
}

/** A 60 x 40 x 10 mm plate with a countersunk and a counterbored hole and a rounded edge. */
TopoDS_Shape MakePlate() {
  TopoDS_Shape plate = BRepPrimAPI_MakeBox(60, 40, 10).Shape();
  TopExp_Explorer edges(plate, TopAbs_EDGE);
  BRepFilletAPI_MakeFillet fillet(plate);
  fillet.Add(3, TopoDS::Edge(edges.Current()));
  plate = fillet.Shape();
  const gp_Dir up(0, 0, 1);
  const auto cut = [&plate](const TopoDS_Shape& tool) {
    plate = BRepAlgoAPI_Cut(plate, tool).Shape();
  };
  cut(BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(20, 20, -1), up), 3.3, 12).Shape());
  cut(BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(20, 20, 6), up), 2.3, 7.3, 5).Shape());
  cut(BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(42, 20, -1), up), 2.75, 12).Shape());
  cut(BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(42, 20, 5), up), 5, 12).Shape());
  return plate;
}

// X2: the faces of a turned part, from its triangles alone, at any resolution from eight segments a
// turn, after a turn and a shift, in single precision.
class TurnedPart : public ::testing::TestWithParam<int> {};

TEST_P(TurnedPart, HasItsTwoCylindersItsConeAndItsPlanes) {
  // Shaft 8 mm with a 45 degree chamfer of 1 mm, collar 20 mm.
  const std::vector<ProfilePoint> profile{{0, 0},        {10e-3, 0},    {10e-3, 5e-3}, {4e-3, 5e-3},
                                          {4e-3, 24e-3}, {3e-3, 25e-3}, {0, 25e-3}};
  TriangleSoup soup = testing::Revolve(profile, GetParam());
  testing::Move(SomePose(), &soup);
  testing::RoundToFloat(&soup);
  const Part part = Build(soup);
  EXPECT_EQ(CountKinds(part), (Kinds{3, 2, 1, 0, 0, 0}));
  EXPECT_EQ(part.solid_count, 1);
  const Vec3 axis = SomePose().q() * Vec3::UnitZ();
  std::vector<double> radii;
  for (const Face& face : part.faces) {
    if (face.surface.kind == SurfaceKind::kCylinder) {
      radii.push_back(face.surface.radius);
      EXPECT_EQ(face.surface.outward, 1);
      EXPECT_LT(face.surface.axis.cross(axis).norm(), 1e-5);
      EXPECT_LT((face.surface.origin - SomePose().p()).cross(axis).norm(), 50e-9);
    }
  }
  std::sort(radii.begin(), radii.end());
  EXPECT_NEAR(radii[0], 4e-3, 50e-9);
  EXPECT_NEAR(radii[1], 10e-3, 50e-9);
  const Face& cone = FaceOf(part, SurfaceKind::kCone);
  EXPECT_NEAR(cone.surface.second, std::numbers::pi / 4, 1e-4);
  EXPECT_LT((cone.surface.origin - SomePose() * Vec3(0, 0, 28e-3)).norm(), 1e-6);
  for (const Face& face : part.faces) {
    EXPECT_TRUE(face.is_recognised);
    EXPECT_LT(face.residual, 50e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Segments, TurnedPart, ::testing::Values(8, 12, 16, 24, 48, 120, 360));

class Ball : public ::testing::TestWithParam<int> {};

TEST_P(Ball, IsOneSphere) {
  std::vector<ProfilePoint> profile;
  testing::AddArc({0, 0}, 6e-3, -std::numbers::pi / 2, std::numbers::pi / 2, GetParam() / 2,
                  &profile);
  TriangleSoup soup = testing::Revolve(profile, GetParam());
  testing::Move(SomePose(), &soup);
  testing::RoundToFloat(&soup);
  const Part part = Build(soup);
  EXPECT_EQ(CountKinds(part), (Kinds{0, 0, 0, 1, 0, 0}));
  EXPECT_NEAR(FaceOf(part, SurfaceKind::kSphere).surface.radius, 6e-3, 30e-9);
  EXPECT_LT((FaceOf(part, SurfaceKind::kSphere).surface.origin - SomePose().p()).norm(), 30e-9);
}

INSTANTIATE_TEST_SUITE_P(Segments, Ball, ::testing::Values(10, 16, 24, 64));

class Ring : public ::testing::TestWithParam<int> {};

TEST_P(Ring, IsOneTorus) {
  std::vector<ProfilePoint> profile;
  testing::AddArc({20e-3, 0}, 4e-3, 0, 2 * std::numbers::pi, GetParam(), &profile);
  profile.pop_back();
  TriangleSoup soup = testing::Revolve(profile, 2 * GetParam(), true);
  testing::Move(SomePose(), &soup);
  testing::RoundToFloat(&soup);
  const Part part = Build(soup);
  EXPECT_EQ(CountKinds(part), (Kinds{0, 0, 0, 0, 1, 0}));
  const Face& face = FaceOf(part, SurfaceKind::kTorus);
  EXPECT_NEAR(face.surface.radius, 20e-3, 50e-9);
  EXPECT_NEAR(face.surface.second, 4e-3, 50e-9);
}

INSTANTIATE_TEST_SUITE_P(Segments, Ring, ::testing::Values(12, 16, 32));

TEST(Segment, FindsCountersinkCounterboreAndFilletOfAPlateMeshedByOpenCascade) {
  for (const double deflection_mm : {0.002, 0.02, 0.1}) {
    TriangleSoup soup = testing::MeshOf(MakePlate(), deflection_mm, 0.4);
    testing::RoundToFloat(&soup);
    const Part part = Build(soup);
    // Six sides and the floor of the counterbore; two bores, the counterbore and the fillet.
    EXPECT_EQ(CountKinds(part), (Kinds{7, 4, 1, 0, 0, 0})) << deflection_mm;
    std::vector<double> radii_mm;
    for (const Face& face : part.faces) {
      if (face.surface.kind == SurfaceKind::kCylinder) {
        radii_mm.push_back(units::ToMm(face.surface.outward * face.surface.radius));
      }
    }
    std::sort(radii_mm.begin(), radii_mm.end());
    const std::vector<double> expected{-5, -3.3, -2.75, 3};
    ASSERT_EQ(radii_mm.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(radii_mm[i], expected[i], 1e-4);
    }
    EXPECT_EQ(part.solid_count, 1);
  }
}

TEST(Segment, KeepsAHexagonFlatAndAChamferedBarFlat) {
  const std::vector<ProfilePoint> hexagon{{0, 0}, {6e-3, 0}, {6e-3, 5e-3}, {0, 5e-3}};
  EXPECT_EQ(CountKinds(Build(testing::Revolve(hexagon, 6))), (Kinds{8, 0, 0, 0, 0, 0}));
  // A square bar with equal chamfers: all of its corners lie on one circle.
  TriangleSoup bar;
  const std::vector<Eigen::Vector2d> outline{{5, 4},   {4, 5},   {-4, 5}, {-5, 4},
                                             {-5, -4}, {-4, -5}, {4, -5}, {5, -4}};
  for (const double z : {0.0, 30.0}) {
    for (const Eigen::Vector2d& p : outline) {
      bar.vertices.emplace_back(1e-3 * Vec3(p.x(), p.y(), z));
    }
  }
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t j = (i + 1) % 8;
    bar.triangles.push_back({i, j, j + 8});
    bar.triangles.push_back({i, j + 8, i + 8});
    if (i > 0 && i < 7) {
      bar.triangles.push_back({0, i + 1, i});
      bar.triangles.push_back({8, 8 + i, 9 + i});
    }
  }
  const Part part = Build(bar);
  EXPECT_EQ(CountKinds(part), (Kinds{10, 0, 0, 0, 0, 0}));
  EXPECT_EQ(part.solid_count, 1);
}

TEST(Segment, TellsABallFromItsFlat) {
  std::vector<ProfilePoint> profile{{0, -4e-3}};
  testing::AddArc({0, 0}, 5e-3, std::asin(-0.8), std::numbers::pi / 2, 20, &profile);
  const Part part = Build(testing::Revolve(profile, 40));
  EXPECT_EQ(CountKinds(part), (Kinds{1, 0, 0, 1, 0, 0}));
}

TEST(Segment, FitsTheCornersOfFacetsNotTheMiddlesOfTheirEdges) {
  const std::vector<ProfilePoint> profile{{0, 0}, {10e-3, 0}, {10e-3, 5e-3}, {0, 5e-3}};
  TriangleSoup soup = testing::Subdivide(testing::Subdivide(testing::Revolve(profile, 20)));
  const Part part = Build(soup);
  EXPECT_EQ(CountKinds(part), (Kinds{2, 1, 0, 0, 0, 0}));
  EXPECT_NEAR(FaceOf(part, SurfaceKind::kCylinder).surface.radius, 10e-3, 1e-9);
}

// What is not of these kinds is said to be freeform, not forced into one of them.
TEST(Segment, LeavesAWaveFreeform) {
  TriangleSoup soup;
  constexpr int kSteps = 40;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const double x = 1e-3 * i;
      const double y = 1e-3 * j;
      soup.vertices.emplace_back(x, y, 2e-3 * std::sin(200 * x + 1) * std::cos(170 * y));
    }
  }
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    for (std::uint32_t j = 0; j < kSteps; ++j) {
      const std::uint32_t v = i * (kSteps + 1) + j;
      soup.triangles.push_back({v, v + kSteps + 1, v + kSteps + 2});
      soup.triangles.push_back({v, v + kSteps + 2, v + 1});
    }
  }
  Diagnostics diagnostics;
  const Part part = Build(soup, &diagnostics);
  double freeform = 0;
  double total = 0;
  for (const Face& face : part.faces) {
    total += face.area;
    freeform += face.surface.kind == SurfaceKind::kFreeform ? face.area : 0;
  }
  EXPECT_GT(freeform, 0.95 * total);
  EXPECT_EQ(part.solid_count, 0);
  EXPECT_EQ(part.mass.mass, 0);
  EXPECT_EQ(diagnostics.Count(Severity::kWarning), 1);
}

TEST(Segment, ToleratesNoiseFarAboveTheResolution) {
  Random random(7);
  const std::vector<ProfilePoint> profile{{0, 0}, {10e-3, 0}, {10e-3, 20e-3}, {0, 20e-3}};
  for (const double noise : {0.2e-6, 1e-6}) {
    TriangleSoup soup = testing::Revolve(profile, 32);
    testing::Shake(noise, &random, &soup);
    const Part part = Build(soup);
    const Face& face = FaceOf(part, SurfaceKind::kCylinder);
    EXPECT_NEAR(face.surface.radius, 10e-3, 2 * noise) << noise;
    EXPECT_GT(face.residual, 0.5 * noise);
    EXPECT_LT(face.residual, 10 * noise);
    EXPECT_EQ(CountKinds(part), (Kinds{2, 1, 0, 0, 0, 0})) << noise;
  }
}

// The fitted radius has no bias of the chords: with noise on the corners the error falls with the
// root of their number, and stays below three deviations of the mean.
class RoundedPin : public ::testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(RoundedPin, HasItsFacesThoughTheFileHasFewDecimals) {
  const auto [segments, step] = GetParam();
  const std::vector<ProfilePoint> profile{{0, 0},        {4.99e-3, 0},  {4.99e-3, 10e-3},
                                          {8e-3, 10e-3}, {8e-3, 14e-3}, {0, 14e-3}};
  TriangleSoup soup = testing::Revolve(profile, segments);
  testing::Move({Quat(Eigen::AngleAxisd(0.01, Vec3::UnitZ())), Vec3::Zero()}, &soup);
  for (Vec3& p : soup.vertices) {
    p = step * (p / step).array().round();
  }
  const Part part = Build(soup);
  EXPECT_EQ(CountKinds(part), (Kinds{3, 2, 0, 0, 0, 0}));
  for (const Face& face : part.faces) {
    if (face.surface.kind == SurfaceKind::kCylinder) {
      const double drawn = face.surface.radius < 6e-3 ? 4.99e-3 : 8e-3;
      EXPECT_NEAR(face.surface.radius, drawn, step);
      EXPECT_LT(face.residual, step);  // Half of a step in each direction.
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Segments, RoundedPin,
                         ::testing::Combine(::testing::Values(24, 48, 96, 200),
                                            ::testing::Values(1e-5, 1e-6, 1e-7, 1e-9)));

TEST(Segment, RadiusConvergesAsTheNumberOfCornersGrows) {
  Random random(11);
  const std::vector<ProfilePoint> profile{{0, 0}, {10e-3, 0}, {10e-3, 20e-3}, {0, 20e-3}};
  constexpr double kNoise = 0.5e-6;
  for (const int segments : {16, 64, 256}) {
    double squares = 0;
    constexpr int kTrials = 20;
    for (int trial = 0; trial < kTrials; ++trial) {
      TriangleSoup soup = testing::Revolve(profile, segments);
      testing::Shake(kNoise, &random, &soup);
      const double error = FaceOf(Build(soup), SurfaceKind::kCylinder).surface.radius - 10e-3;
      squares += error * error / kTrials;
    }
    EXPECT_LT(std::sqrt(squares), 1.6 * kNoise / std::sqrt(2.0 * segments)) << segments;
    EXPECT_GT(std::sqrt(squares), 0.5 * kNoise / std::sqrt(2.0 * segments)) << segments;
  }
}

// Mass by the divergence theorem: the exact volume and inertia of a box, of the prism that the
// triangles of a cylinder are, and what is left around a cavity.
TEST(TrianglePart, HasTheMassOfItsSolid) {
  TriangleSoup soup = testing::MakeBox({0.06, 0.04, 0.01});
  const Part box = Build(soup);
  EXPECT_NEAR(box.mass.volume, 24e-6, 1e-17);
  EXPECT_NEAR(box.mass.mass, 24e-6 * 7850, 1e-12);
  EXPECT_LT((box.mass.p_BoBcm_B - Vec3(0.03, 0.02, 0.005)).norm(), 1e-12);
  EXPECT_NEAR(box.mass.I_BBcm_B(2, 2), box.mass.mass * (0.06 * 0.06 + 0.04 * 0.04) / 12, 1e-14);
  EXPECT_NEAR(box.mass.I_BBcm_B(0, 1), 0, 1e-16);

  TriangleSoup cavity = testing::MakeBox({0.01, 0.01, 0.002});
  for (Triangle& t : cavity.triangles) {
    std::swap(t[0], t[1]);
  }
  testing::Move({Quat::Identity(), Vec3(0.02, 0.02, 0.004)}, &cavity);
  testing::Append(cavity, &soup);
  const Part hollow = Build(soup);
  EXPECT_NEAR(hollow.mass.volume, 24e-6 - 0.2e-6, 1e-17);
  EXPECT_EQ(hollow.solid_count, 1);
  EXPECT_EQ(hollow.faces.size(), 12U);
}

TEST(TrianglePart, TurnsTrianglesThatAreInsideOut) {
  for (const int kind : {0, 1}) {
    TriangleSoup soup = testing::MakeBox({0.06, 0.04, 0.01});
    for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
      if (kind == 0 || i % 3 == 0) {
        std::swap(soup.triangles[i][0], soup.triangles[i][1]);
      }
    }
    Diagnostics diagnostics;
    const Part part = Build(soup, &diagnostics);
    EXPECT_NEAR(part.mass.volume, 24e-6, 1e-17);
    ASSERT_FALSE(diagnostics.items().empty());
    EXPECT_EQ(diagnostics.items().front().code, "reversed-mesh");
    for (const Face& face : part.faces) {
      EXPECT_GT((face.box_B.centre() - part.mass.p_BoBcm_B).dot(face.surface.axis), 0);
    }
  }
}

TEST(TrianglePart, TakesBodiesThatAreApartAsOnePartWithAllOfTheirMass) {
  TriangleSoup soup = testing::MakeBox({0.01, 0.01, 0.01});
  TriangleSoup other = soup;
  testing::Move({Quat::Identity(), Vec3(0.02, 0, 0)}, &other);
  testing::Append(other, &soup);
  const Part part = Build(soup);
  EXPECT_EQ(part.solid_count, 2);
  EXPECT_NEAR(part.mass.volume, 2e-6, 1e-17);
}

// Cracks of unequal edges (T-junctions) are no openings; a missing lid is.
TEST(TrianglePart, TellsACrackFromAnOpening) {
  TriangleSoup soup = testing::MakeBox({0.06, 0.04, 0.01});
  // Split the triangle (0, 2, 3) at the middle of its edge from 0 to 2, and its neighbour not.
  soup.vertices.emplace_back(0, 0.02, 0);
  soup.triangles[0] = {0, 8, 3};
  soup.triangles.push_back({8, 2, 3});
  const Part cracked = Build(soup);
  EXPECT_EQ(cracked.solid_count, 1);
  EXPECT_EQ(cracked.faces.size(), 6U);
  EXPECT_NEAR(cracked.mass.volume, 24e-6, 1e-17);

  soup.triangles.pop_back();
  Diagnostics diagnostics;
  EXPECT_EQ(Build(soup, &diagnostics).solid_count, 0);
  EXPECT_EQ(diagnostics.items().front().code, "no-solid");
}

// The faces of a file were divided each by itself: only what lies on their edges tells that they
// hang together.
TEST(TrianglePart, FacesWithUnequalEdgesHangTogether) {
  const TriangleSoup box = testing::MakeBox({0.06, 0.04, 0.01});
  TriangleSoup soup;
  for (std::size_t i = 0; i < box.triangles.size(); ++i) {
    // Every triangle has vertices of its own, and two of four are divided into 16.
    TriangleSoup one;
    for (const std::uint32_t v : box.triangles[i]) {
      one.vertices.push_back(box.vertices[v]);
    }
    one.triangles = {{0, 1, 2}};
    if (i / 2 % 2 == 1) {
      one = testing::Subdivide(testing::Subdivide(one));
    }
    testing::Append(one, &soup);
  }
  const WeldedMesh mesh = WeldMesh(soup);
  ASSERT_EQ(mesh.shells.size(), 1U);
  EXPECT_TRUE(mesh.shells[0].is_closed);
  EXPECT_EQ(mesh.defects.open_edges, 0U);
  EXPECT_EQ(mesh.defects.shared_edges, 0U);
  EXPECT_NEAR(mesh.shells[0].volume, 24e-6, 1e-17);
}

TEST(TrianglePart, MoreShellsThanAreLookedAtForCavitiesAreReported) {
  for (const int count : {500, 501}) {
    TriangleSoup soup;
    for (int i = 0; i < count; ++i) {
      TriangleSoup box = testing::MakeBox({1e-3, 1e-3, 1e-3});
      testing::Move(spatial::Pose(Vec3(2e-3 * i, 0, 0)), &box);
      testing::Append(box, &soup);
    }
    Diagnostics diagnostics;
    EXPECT_EQ(Build(soup, &diagnostics).solid_count, count);
    EXPECT_EQ(testing::CountCode(diagnostics, "limit-shells"), count > 500 ? 1 : 0);
  }
}

TEST(TrianglePart, TakesAnyTriangles) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Part part;
  Diagnostics diagnostics;
  EXPECT_FALSE(BuildTrianglePart({}, &part, &diagnostics));
  TriangleSoup points;
  points.vertices.assign(5, Vec3(0.1, 0.2, 0.3));
  points.triangles = {{0, 1, 2}, {2, 3, 4}};
  EXPECT_FALSE(BuildTrianglePart(points, &part, &diagnostics));

  TriangleSoup soup = testing::MakeBox({0.06, 0.04, 0.01});
  soup.vertices.emplace_back(kNan, 0, 0);
  soup.vertices.emplace_back(0, kInf, 0);
  soup.vertices.emplace_back(0, 0, 1e300);
  soup.triangles.insert(soup.triangles.end(),
                        {{0, 1, 8}, {9, 1, 2}, {0, 10, 3}, {0, 1, 99}, {1, 1, 2}, {0, 3, 2}});
  const Part box = Build(soup, &diagnostics);
  EXPECT_NEAR(box.mass.volume, 24e-6, 1e-17);
  EXPECT_EQ(box.mesh.triangles.size(), 12U);

  // Any soup of the same points: shared edges, needles, crossings.
  Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    TriangleSoup any;
    for (int i = 0; i < 12; ++i) {
      const double x = random.Uniform();
      const double y = random.Uniform();
      any.vertices.emplace_back(x, y, trial % 2 == 0 ? random.Uniform() : 1e-9 * x);
    }
    for (int i = 0; i < 40; ++i) {
      const auto pick = [&random] { return static_cast<std::uint32_t>(random.NextBits() % 12); };
      const std::uint32_t a = pick();
      const std::uint32_t b = pick();
      any.triangles.push_back({a, b, pick()});
    }
    Part chaos;
    if (BuildTrianglePart(any, &chaos, &diagnostics)) {
      std::size_t triangles = 0;
      for (const Face& face : chaos.faces) {
        triangles += face.triangle_count;
        EXPECT_TRUE(std::isfinite(face.residual));
        EXPECT_TRUE(face.surface.origin.allFinite());
      }
      EXPECT_EQ(triangles, chaos.mesh.triangles.size());
    }
  }
}

// The same solid read as B-rep and from its triangles: the same holes, shafts and cones, in the
// same places.
TEST(TrianglePart, HasTheFeaturesOfItsSolid) {
  const hvas::testing::TemporaryFolder folder;
  testing::DocumentBuilder builder;
  builder.AddPart(MakePlate(), "plate");
  builder.Write(folder / "plate.step");
  Diagnostics diagnostics;
  const auto solid = ReadCad(folder / "plate.step", {}, &diagnostics);
  ASSERT_TRUE(solid) << solid.error().ToString();
  TriangleSoup soup = testing::MeshOf(MakePlate(), 0.02, 0.3);
  testing::RoundToFloat(&soup);
  const Part twin = Build(soup);
  const std::vector<product::Feature>& expected = solid->parts.at(0).features;
  ASSERT_EQ(twin.features.size(), expected.size());
  EXPECT_GE(expected.size(), 10U);
  for (const product::Feature& feature : expected) {
    const bool is_found =
        std::any_of(twin.features.begin(), twin.features.end(), [&](const product::Feature& other) {
          return other.kind == feature.kind && std::abs(other.radius - feature.radius) < 1e-7 &&
                 std::abs(other.half_angle - feature.half_angle) < 1e-5 &&
                 other.axis_B.cross(feature.axis_B).norm() < 1e-5 &&
                 (feature.kind == product::FeatureKind::kPlane
                      ? std::abs((other.origin_B - feature.origin_B).dot(feature.axis_B)) < 1e-7
                      : (other.origin_B - feature.origin_B).cross(feature.axis_B).norm() < 1e-6);
        });
    EXPECT_TRUE(is_found) << static_cast<int>(feature.kind) << " " << feature.radius;
  }
  EXPECT_NEAR(twin.mass.volume, solid->parts[0].mass.volume, 1e-3 * twin.mass.volume);
}

TEST(TrianglePart, IsTheSameWhenBuiltAgain) {
  const TriangleSoup soup = testing::MeshOf(MakePlate(), 0.02, 0.4);
  EXPECT_EQ(Build(soup).shape_hash, Build(soup).shape_hash);
}

}  // namespace
}  // namespace hvas::cad
