// Queries under a budget of points (N3), and with either set of instructions.

#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/scene.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

using spatial::Pose;
using testing::Build;

Vec3 InPlane(double length, double angle) {
  return {length * std::cos(angle), length * std::sin(angle), 0};
}

struct Answer {
  double deepest;
  std::size_t contacts;
  QueryStats stats;
};

Answer Ask(const Scene& scene, const Shape& held, const Pose& X_WH, std::uint32_t budget) {
  QueryWorkspace work;
  QueryOptions options;
  options.point_budget = budget;
  scene.Query(held, X_WH, options, &work);
  return {work.deepest(), work.contacts().size(), work.stats()};
}

// Of curved and of flat contacts the few samples that are left slide to the very bottom.
TEST(Budget, LessThanATenthOfThePointsFindsTheSameDepthToAMicrometre) {
  Scene bore;
  bore.Add(Build(testing::Bushing(20e-3, 30e-3, 80e-3)), {});
  const auto shaft = Build(testing::Shaft(19.99e-3, 100e-3));
  Scene plate;
  plate.Add(Build(testing::Block({50e-3, 40e-3, 10e-3})), {});
  const auto block = Build(testing::Block({30e-3, 20e-3, 10e-3}));
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(::testing::Message() << "pose " << i);
    const Pose in_bore(InPlane(110e-6, 0.53 * i) + Vec3(0, 0, -10e-3));
    const Pose on_plate(Vec3(1e-3 * i, -0.7e-3 * i, 20e-3 - 30e-6));
    for (const auto& [scene, held, pose] :
         {std::tuple(&bore, &shaft, &in_bore), std::tuple(&plate, &block, &on_plate)}) {
      const Answer all = Ask(*scene, **held, *pose, 1000000);
      const Answer few = Ask(*scene, **held, *pose, all.stats.points_tested / 12);
      EXPECT_FALSE(all.stats.is_truncated);
      EXPECT_EQ(all.stats.points_dropped, 0U);
      EXPECT_TRUE(few.stats.is_truncated);
      EXPECT_GT(few.stats.points_dropped, all.stats.points_tested / 2);
      EXPECT_GT(few.contacts, 3U);
      EXPECT_NEAR(few.deepest, all.deepest, 1e-6);
    }
  }
}

// Whatever is dropped, a part on several others is held by each of them.
TEST(Budget, EveryBodyKeepsItsShare) {
  Scene scene;
  const auto foot = Build(testing::Block({4e-3, 4e-3, 10e-3}));
  for (const double x : {-40e-3, 40e-3}) {
    for (const double y : {-30e-3, 30e-3}) {
      scene.Add(foot, Pose(Vec3(x, y, -20e-3 + 20e-6)));
    }
  }
  const auto plate = Build(testing::Block({50e-3, 40e-3, 10e-3}));
  QueryWorkspace work;
  QueryOptions options;
  options.point_budget = 100;
  scene.Query(*plate, {}, options, &work);
  EXPECT_TRUE(work.stats().is_truncated);
  EXPECT_LE(work.stats().points_tested, 2 * options.point_budget);
  std::array<int, 4> found{};
  for (const Contact& c : work.contacts()) {
    ++found[c.body.index()];
    EXPECT_NEAR(c.distance, -20e-6, 1e-6);
  }
  for (const int count : found) {
    EXPECT_GT(count, 0);
  }
}

TEST(WholeQueries, GiveTheSameBitsWithAndWithoutVectorInstructions) {
  const std::vector<std::shared_ptr<const Shape>> shapes = {
      Build(testing::Cup(3e-3, 10e-3, 5e-3, 20e-3)), Build(testing::Shaft(2.995e-3, 20e-3)),
      Build(testing::Cone(8e-3, 4e-3, 10e-3, 5e-6)), Build(testing::Ring(8e-3, 3e-3, 10e-6)),
      Build(testing::Ball(5e-3, 10e-6))};
  Scene with;
  Scene without;
  without.UseScalarKernel();
  Random random(5);
  for (std::size_t i = 0; i < 12; ++i) {
    const Quat q(random.Normal(), random.Normal(), random.Normal(), random.Normal());
    const Pose X(q.normalized(), Vec3(random.Uniform(-15e-3, 15e-3), random.Uniform(-15e-3, 15e-3),
                                      random.Uniform(-15e-3, 15e-3)));
    with.Add(shapes[i % shapes.size()], X);
    without.Add(shapes[i % shapes.size()], X);
  }
  QueryWorkspace a;
  QueryWorkspace b;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < 120; ++i) {
    SCOPED_TRACE(::testing::Message() << "draw " << i);
    const Quat q(random.Normal(), random.Normal(), random.Normal(), random.Normal());
    const Pose X(q.normalized(), Vec3(random.Uniform(-25e-3, 25e-3), random.Uniform(-25e-3, 25e-3),
                                      random.Uniform(-25e-3, 25e-3)));
    QueryOptions options;
    options.point_budget = i % 3 == 0 ? 500 : QueryOptions::kDefaultPointBudget;
    with.Query(*shapes[i % shapes.size()], X, options, &a);
    without.Query(*shapes[i % shapes.size()], X, options, &b);
    ASSERT_EQ(a.contacts().size(), b.contacts().size());
    EXPECT_EQ(a.stats().points_tested, b.stats().points_tested);
    EXPECT_EQ(a.stats().candidates, b.stats().candidates);
    const double deepest[2] = {a.deepest(), b.deepest()};
    EXPECT_EQ(std::memcmp(&deepest[0], &deepest[1], sizeof(double)), 0);
    for (std::size_t k = 0; k < a.contacts().size(); ++k) {
      const Contact& c = a.contacts()[k];
      const Contact& d = b.contacts()[k];
      EXPECT_EQ(std::memcmp(&c.distance, &d.distance, sizeof(double)), 0);
      EXPECT_EQ(std::memcmp(c.p_WC.data(), d.p_WC.data(), 3 * sizeof(double)), 0);
      EXPECT_EQ(std::memcmp(c.nhat_W.data(), d.nhat_W.data(), 3 * sizeof(double)), 0);
      EXPECT_EQ(c.body, d.body);
      EXPECT_EQ(c.held_face, d.held_face);
      EXPECT_EQ(c.scene_face, d.scene_face);
      EXPECT_EQ(c.is_exact, d.is_exact);
    }
    compared += a.contacts().size();
  }
  EXPECT_GT(compared, 1000U);
}

}  // namespace
}  // namespace hvas::contact
