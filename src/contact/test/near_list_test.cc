// Fast ways of finding the closest triangles give what the simple ones do.

#include "contact/near_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/block_build.h"
#include "contact/shape_data.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

std::vector<ShapeSource> ListParts() {
  return {testing::Cup(3e-3, 20e-3, 5e-3, 20e-3), testing::Ball(8e-3, 5e-6),
          testing::Ring(10e-3, 3e-3, 5e-6),       testing::Cone(8e-3, 4e-3, 12e-3, 5e-6),
          testing::Block({5e-3, 7e-3, 9e-3}),     testing::Frame({9e-3, 8e-3, 2e-3}, {5e-3, 4e-3})};
}

Vec3 DrawPoint(Random* random, double reach) {
  return {random->Uniform(-reach, reach), random->Uniform(-reach, reach),
          random->Uniform(-reach, reach)};
}

double CalcLeastDistance(const Mesh& mesh, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    least = std::min(least, (mesh.ClosestOn(t, p).q - p).norm());
  }
  return least;
}

Vec3 CentreOf(const Vec3& low, const Vec3& high, std::size_t octant) {
  return {(octant & 1U) != 0 ? high.x() : low.x(), (octant & 2U) != 0 ? high.y() : low.y(),
          (octant & 4U) != 0 ? high.z() : low.z()};
}

void ExpectEqual(const NearTriangle& a, const NearTriangle& b) {
  EXPECT_EQ(a.triangle, b.triangle);
  EXPECT_EQ(a.distance, b.distance);
}

// Triangles of all shapes, slivers without area too, and points in all places about them: also
// where a corner, an edge or the inside are equally near.
struct ClosestCase {
  std::vector<TriangleCorners> triangles;
  EightPoints points{};

  explicit ClosestCase(Random* random) {
    const auto draw = [&] { return std::round(random->Uniform(-3, 3)) + Jitter(random); };
    for (std::size_t i = 0; i < 8; ++i) {
      std::array<Vec3, 3> corners;
      do {  // Meshes have no triangle with two corners in one place.
        for (Vec3& corner : corners) {
          corner = {draw(), draw(), draw()};
        }
      } while (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]);
      if (random->Uniform(0, 1) < 0.1) {
        corners[2] = 0.5 * (corners[0] + corners[1]);
      }
      triangles.push_back(MakeTriangleCorners(corners[0], corners[1], corners[2]));
      for (auto& coordinate : points.at) {
        coordinate[i] = draw();
      }
    }
  }

  static double Jitter(Random* random) {
    return random->Uniform(0, 1) < 0.5 ? 0 : random->Uniform(-1, 1);
  }
};

TEST(ClosestKernel, GivesTheSameBitsWithAndWithoutVectors) {
#ifdef HVAS_HAS_AVX2_KERNEL
  if (!__builtin_cpu_supports("avx2")) {
    EXPECT_EQ(ChooseClosestKernels().eight, &CalcEightClosestScalar);
    return;
  }
  EXPECT_EQ(ChooseClosestKernels().eight, &CalcEightClosestAvx2);
  constexpr std::array<std::uint32_t, 8> kNumbers{7, 6, 5, 4, 3, 2, 1, 0};
  Random random(23);
  std::array<int, 7> met{};
  for (int i = 0; i < 20000; ++i) {
    const ClosestCase given(&random);
    const int count = 1 + i % 8;
    EightClosest vector;
    EightClosest scalar;
    CalcEightClosestAvx2(given.triangles.data(), kNumbers.data(), count, given.points, &vector);
    CalcEightClosestScalar(given.triangles.data(), kNumbers.data(), count, given.points, &scalar);
    for (int k = 0; k < count; ++k) {
      ASSERT_EQ(vector.features[k], scalar.features[k]);
      ASSERT_EQ(vector.squared[k], scalar.squared[k]);
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(vector.q.at[axis][k], scalar.q.at[axis][k]);
      }
      ++met[static_cast<std::size_t>(scalar.features[k])];
    }
  }
  for (const int times : met) {
    EXPECT_GT(times, 1000);
  }
#endif
}

TEST(ClosestKernel, FourTrianglesOfAMeshGiveTheSameBitsWithAndWithoutVectors) {
  constexpr std::array<std::uint32_t, 4> kNumbers{5, 0, 7, 2};
  Random random(29);
  for (int i = 0; i < 5000; ++i) {
    const ClosestCase given(&random);
    Mesh mesh;
    for (const TriangleCorners& t : given.triangles) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.triangles.push_back({first, first + 1, first + 2});
      for (const double* corner : {t.a, t.b, t.c}) {
        mesh.vertices.emplace_back(corner[0], corner[1], corner[2]);
      }
    }
    const Vec3 p(given.points.at[0][0], given.points.at[1][0], given.points.at[2][0]);
    FourClosest chosen;
    FourClosest scalar;
    ChooseClosestKernels().four(mesh.arrays(), kNumbers.data(), p.data(), &chosen);
    CalcFourClosestScalar(mesh.arrays(), kNumbers.data(), p.data(), &scalar);
    for (std::size_t k = 0; k < 4; ++k) {
      const TrianglePoint one = mesh.ClosestOn(kNumbers[k], p);
      ASSERT_EQ(scalar.features[k], static_cast<std::int32_t>(one.feature));
      ASSERT_EQ(chosen.features[k], scalar.features[k]);
      ASSERT_EQ(chosen.squared[k], scalar.squared[k]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(scalar.at[axis][k], one.q[static_cast<Eigen::Index>(axis)]);
        ASSERT_EQ(chosen.at[axis][k], scalar.at[axis][k]);
      }
    }
  }
}

TEST(NearSearch, FiltersOctantsAtOnceAsItDoesOneByOne) {
  Random random(21);
  for (const ShapeSource& part : ListParts()) {
    const Mesh mesh = MakeMesh(part, Vec3::Zero());
    const NearSearch search(mesh);
    std::array<BegunFilter, 8> begun;
    std::array<NearSet, 8> octants;
    for (int i = 0; i < 100; ++i) {
      const Vec3 centre = DrawPoint(&random, 15e-3);
      const double half = std::exp(random.Uniform(std::log(0.1e-3), std::log(10e-3)));
      NearSet whole;
      search.Filter(search.MakeFullList(), centre, 2 * kHalfDiagonal * half, &whole.list);
      whole.least = LeastOf(whole.list);
      const Vec3 low = centre - Vec3::Constant(half / 2);
      const Vec3 high = centre + Vec3::Constant(half / 2);
      const double radius = kHalfDiagonal * half;
      const unsigned wanted = i % 2 == 0 ? 0xffU : 0x5aU;
      search.FilterOctants(whole, low, high, radius, wanted, &begun, &octants);
      for (std::size_t k = 0; k < 8; ++k) {
        if ((wanted >> k & 1U) == 0) {
          EXPECT_TRUE(octants[k].list.empty());
          continue;
        }
        NearList alone;
        search.Filter(whole.list, CentreOf(low, high, k), radius, &alone);
        ASSERT_EQ(octants[k].list.size(), alone.size());
        for (std::size_t n = 0; n < alone.size(); ++n) {
          ExpectEqual(octants[k].list[n], alone[n]);
        }
        ExpectEqual(octants[k].least, LeastOf(alone));
        const Vec3 c = CentreOf(low, high, k);
        const Nearest simple = search.FindSigned(whole.list, c, NearSearch::kAnywhere, 0);
        const Nearest boxed = search.FindSignedInBoxed(begun[k], c);
        EXPECT_EQ(boxed.triangle, simple.triangle);
        EXPECT_EQ(boxed.distance, simple.distance);
      }
    }
  }
}

TEST(NearSearch, FindsAtEachNodeOfAGridWhatAllTrianglesSay) {
  Random random(22);
  for (const ShapeSource& part : ListParts()) {
    const Mesh mesh = MakeMesh(part, Vec3::Zero());
    const NearSearch search(mesh);
    const NearList all = search.MakeFullList();
    std::array<BegunFilter, 8> begun;
    NodeRoom room;
    std::array<Nearest, NodeGrid::kMost> at_nodes;
    std::array<Nearest, NodeGrid::kMost> in_all;
    for (std::size_t draw = 0; draw < 27; ++draw) {
      const Vec3 centre = DrawPoint(&random, 12e-3);
      const double cell = random.Uniform(0.1e-3, 1e-3);
      NodeGrid grid;
      grid.count = {1 + draw % 3, 1 + draw / 3 % 3, 1 + draw / 9};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < 3; ++i) {
          grid.at[axis][i] = centre[static_cast<int>(axis)] + cell * (static_cast<double>(i) - 1);
        }
      }
      search.BeginOctants({all, all.front()}, centre, centre, 2 * kHalfDiagonal * cell, 1, &begun);
      const auto some =
          static_cast<std::uint32_t>(random.Uniform(0, static_cast<double>(all.size())));
      search.FindSignedAtNodes(begun[0].list, some, grid, &room, &at_nodes);
      search.FindSignedAtNodes(all, all.front().triangle, grid, &room, &in_all);
      std::size_t node = 0;
      for (std::size_t k = 0; k < grid.count[2]; ++k) {
        for (std::size_t j = 0; j < grid.count[1]; ++j) {
          for (std::size_t i = 0; i < grid.count[0]; ++i, ++node) {
            const Vec3 p = grid.NodeAt(i, j, k);
            const Nearest& found = at_nodes[node];
            const Nearest simple = search.FindSigned(all, p, NearSearch::kAnywhere, some);
            EXPECT_EQ(found.distance, simple.distance);
            EXPECT_EQ(found.triangle, simple.triangle);
            EXPECT_EQ(in_all[node].distance, simple.distance);
            EXPECT_EQ(in_all[node].triangle, simple.triangle);
            EXPECT_EQ(std::abs(found.distance), CalcLeastDistance(mesh, p));
          }
        }
      }
    }
  }
}

TEST(NearSearch, KnowsNoSideWhereFacesCoincide) {
  // Two blocks that share a side: what is outside of one is inside of the other.
  ShapeSource both = testing::Block({5e-3, 5e-3, 5e-3});
  const ShapeSource other = both;
  const auto vertices = static_cast<std::uint32_t>(both.vertices.size());
  const auto faces = static_cast<std::uint32_t>(both.faces.size());
  for (const Vec3& v : other.vertices) {
    both.vertices.emplace_back(v + Vec3(10e-3, 0, 0));
  }
  for (std::size_t t = 0; t < other.triangles.size(); ++t) {
    const auto& of = other.triangles[t];
    both.triangles.push_back({of[0] + vertices, of[1] + vertices, of[2] + vertices});
    both.triangle_face.push_back(other.triangle_face[t] + faces);
  }
  for (spatial::Surface face : other.faces) {
    face.origin.x() += 10e-3;
    both.faces.push_back(face);
  }
  const Mesh mesh = MakeMesh(both, Vec3::Zero());
  const NearSearch search(mesh);
  const NearList all = search.MakeFullList();
  const auto side_at = [&](const Vec3& p) {
    return search.FindSide(all, p, NearSearch::kAnywhere, 0);
  };
  EXPECT_EQ(side_at({4e-3, 0, 0}), std::nullopt);
  EXPECT_EQ(side_at({-4e-3, 0, 0}), true);
  EXPECT_EQ(side_at({-6e-3, 1e-3, 2e-3}), false);
  EXPECT_EQ(side_at({20e-3, 6e-3, 7e-3}), false);  // Off a corner, which three faces share.
}

// Where a field has no nodes it says on which side a block lies; where it has some they hold the
// distance, to half a unit (of single precision) and what the mesh leaves of round faces.
TEST(NearSearch, FillsFieldsAsAllTrianglesSay) {
  Random random(23);
  for (const ShapeSource& part : ListParts()) {
    ShapeOptions options;
    options.voxel = 0.5e-3;
    const auto shape = testing::Build(part, options);
    const Shape::Data& data = shape->data();
    const Mesh mesh = MakeMesh(part, data.p_BC);
    const FieldView& view = data.field.view;
    const double deviation =
        *std::max_element(data.exact.deviation.begin(), data.exact.deviation.end());
    const double band = static_cast<double>(view.band);
    const double quantum = static_cast<double>(view.quantum);
    for (int draw = 0; draw < 1000; ++draw) {
      Vec3 p;
      std::array<int, 3> at{};
      std::array<int, 3> cell{};
      for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        at[axis] = static_cast<int>(random.Uniform(0, view.blocks[k] - 1e-9));
        cell[axis] = static_cast<int>(random.Uniform(0, 9 - 1e-9));
        p[k] = static_cast<double>(view.origin[k]) +
               data.voxel * (kBlockCells * at[axis] + cell[axis]);
      }
      const std::int32_t block =
          view.top[(at[2] * view.blocks[1] + at[1]) * view.blocks[0] + at[0]];
      const double distance =
          std::copysign(CalcLeastDistance(mesh, p), 0.5 - mesh.CalcWindingNumber(p));
      if (block >= 0) {
        const double stored =
            quantum * view.nodes[block * kBlockNodes + cell[2] * 81 + cell[1] * 9 + cell[0]];
        EXPECT_NEAR(stored, std::clamp(distance, -band, band), 0.501 * quantum + 2 * deviation);
      } else if (block > kTopFace) {
        EXPECT_EQ(block == kTopInside, distance < 0);
        EXPECT_GE(std::abs(distance), CalcBlockReach(data.voxel) - 2 * deviation);
      }
    }
  }
}

}  // namespace
}  // namespace hvas::contact
