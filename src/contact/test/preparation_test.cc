// How shapes are built: the same on any number of threads, small, and right where they leave out.

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/test/temporary_folder.h"
#include "contact/scene.h"
#include "contact/shape_cache.h"
#include "contact/shape_data.h"
#include "contact/shape_io.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

using spatial::Pose;
using testing::Build;

ShapeOptions WithVoxel(double voxel_mm) {
  ShapeOptions options;
  options.voxel = 1e-3 * voxel_mm;
  return options;
}

std::size_t CountPlaces(const Shape& shape) {
  const auto& top = shape.data().field.top;
  return static_cast<std::size_t>(std::count_if(
      top.begin(), top.end(), [](std::int32_t block) { return block >= 0 || block <= kTopFace; }));
}

std::size_t CountBlocks(const Shape& shape) {
  return shape.data().field.slack.size();
}

TEST(Preparation, GivesTheSameBytesOnAnyNumberOfThreads) {
  const ShapeSource source = testing::Cup(3e-3, 20e-3, 5e-3, 20e-3);
  std::vector<std::vector<std::byte>> bytes;
  for (const unsigned threads : {1U, 2U, 5U}) {
    ShapeOptions options = WithVoxel(0.5);
    options.threads = threads;
    const auto shape = Build(source, options);
    EXPECT_GT(CountPlaces(*shape), 200U);  // So that there is something to share out.
    bytes.push_back(SerialiseShape(*shape));
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_EQ(bytes[0], bytes[2]);
}

TEST(Preparation, RefusesAVoxelForWhichNoMemoryWouldDo) {
  const auto shape = Shape::Build(testing::Block({1, 1, 1}), WithVoxel(0.01));
  ASSERT_FALSE(shape.has_value());
  EXPECT_EQ(shape.error().code, ErrorCode::kOutOfResource);
  EXPECT_NE(shape.error().message.find("0.01 mm"), std::string::npos);
}

// 0.15 kB per square millimetre at 0.5 mm, all told.
TEST(Preparation, TakesLittleMemoryForTheSurface) {
  const auto shape = Build(testing::Bushing(20e-3, 40e-3, 50e-3), WithVoxel(0.5));
  const double area_mm2 = 2 * std::numbers::pi * ((20 + 40) * 50 + (40 * 40 - 20 * 20));
  const ShapeMemory memory = shape->CalcMemory();
  EXPECT_LT(static_cast<double>(memory.total()), 150 * area_mm2);
  EXPECT_EQ(memory.total(), memory.field + memory.tables + memory.mesh + memory.shell);
  EXPECT_EQ(memory.total(), shape->memory_bytes());
  for (const std::size_t part : {memory.field, memory.tables, memory.mesh, memory.shell}) {
    EXPECT_GT(part, 0U);
  }
}

TEST(Preparation, LaysDownEqualBlocksOnce) {
  // Along a bar the field repeats itself, whatever lies at its ends.
  const auto bar = Build(testing::Block({5e-3, 7e-3, 60e-3}), WithVoxel(0.5));
  const auto longer = Build(testing::Block({5e-3, 7e-3, 120e-3}), WithVoxel(0.5));
  const std::size_t more_places = CountPlaces(*longer) - CountPlaces(*bar);
  EXPECT_GE(more_places, 300U);
  EXPECT_LT(CountBlocks(*longer), CountBlocks(*bar) + more_places / 4);
  // A shared block is the right one for every place where it stands.
  Random random(11);
  for (int i = 0; i < 500; ++i) {
    const double z = random.Uniform(-110e-3, 110e-3);
    const double depth = random.Uniform(-100e-6, 100e-6);
    QueryWorkspace work;
    Scene scene;
    (void)scene.Add(longer, Pose());
    static const auto pin = Build(testing::Shaft(0.5e-3, 4e-3));
    QueryOptions options;
    options.margin = 200e-6;
    // The pin stands on the side at +x, its axis along x.
    const Pose X_WB(Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitX()),
                    Vec3(5e-3 + depth, random.Uniform(-5e-3, 5e-3), z));
    scene.Query(*pin, X_WB, options, &work);
    ASSERT_NEAR(work.deepest(), depth, 1e-9) << "draw " << i;
  }
}

// Away from all blocks the coarse grid, whose cells are wider than the hole, is not asked on which
// side a point lies.
TEST(Preparation, KnowsANarrowHoleFromMaterial) {
  const auto plate = Build(testing::Bushing(1.6e-3, 60e-3, 15e-3), WithVoxel(0.5));
  const auto needle = Build(testing::Shaft(0.2e-3, 10e-3, 5e-6));
  Scene scene;
  (void)scene.Add(plate, Pose());
  QueryWorkspace work;
  for (int i = 0; i <= 20; ++i) {
    const Pose X_WB(Quat::Identity(), Vec3(0, 0, -2e-3 + 0.4e-3 * i));
    scene.Query(*needle, X_WB, {}, &work);
    EXPECT_EQ(work.contacts().size(), 0U) << "step " << i;
  }
}

// Between two freeform faces that meet without an edge the field answers: its error is that of the
// interpolation, h^2 / 8 for each principal curvature, and that of the mesh.
TEST(Preparation, AnswersOnFreeformFacesToTheErrorOfInterpolation) {
  constexpr double kRadius = 10e-3;
  constexpr double kDeviation = 1e-6;
  ShapeSource source = testing::Ball(kRadius, kDeviation);
  source.faces[0] = {};
  source.faces.push_back({});  // The upper half is a face of its own.
  for (std::size_t t = 0; t < source.triangles.size(); ++t) {
    double z = 0;
    for (const std::uint32_t v : source.triangles[t]) {
      z += source.vertices[v].z();
    }
    source.triangle_face[t] = z > 0 ? 1 : 0;
  }
  const auto ball = Build(source, WithVoxel(0.5));
  EXPECT_EQ(ball->data().exact.list_begin.size(), 1U);  // No zone needs triangles.
  static const auto pin = Build(testing::Shaft(0.3e-3, 4e-3));
  Scene scene;
  (void)scene.Add(ball, Pose());
  QueryWorkspace work;
  Random random(12);
  const double h = ball->voxel();
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 n = Vec3(random.Normal(), random.Normal(), random.Normal()).normalized();
    const double depth = 50e-6;
    scene.Query(*pin, Pose(Quat::FromTwoVectors(Vec3::UnitZ(), n), (kRadius - depth) * n), {},
                &work);
    ASSERT_LT(work.deepest(), 0) << "draw " << i;
    worst = std::max(worst, -work.deepest() - depth);
  }
  EXPECT_LT(worst, 2 * h * h / (8 * kRadius) + kDeviation);
}

TEST(Preparation, StopsWhenAskedAndLeavesNothingOnDisk) {
  const hvas::testing::TemporaryFolder folder;
  std::stop_source stop;
  stop.request_stop();
  ShapeOptions options = WithVoxel(0.5);
  options.stop = stop.get_token();
  ShapeCache cache(folder.path());
  const auto shape = cache.LoadOrBuild(testing::Cup(3e-3, 20e-3, 5e-3, 20e-3), options);
  ASSERT_FALSE(shape);
  EXPECT_EQ(shape.error().code, ErrorCode::kCancelled);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace hvas::contact
