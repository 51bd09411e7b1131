// Queries that remember what is far from one pose to the next, beside such as remember nothing.

#include "contact/bound_memory.h"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/face_offsets.h"
#include "contact/scene.h"
#include "contact/shape_data.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

using spatial::Pose;
using testing::Build;

// A held part that is moved about, at times with jumps, among others of which one moves as well.
class Walk {
 public:
  explicit Walk(std::uint64_t seed) : random_(seed) {
    const auto shapes = ListShapes();
    for (std::size_t i = 0; i < 10; ++i) {
      scene_.Add(shapes[(i + seed) % shapes.size()], Pose(RandomTurn(), RandomPoint(40e-3)));
    }
    held_ = shapes[seed % shapes.size()];
    is_as_made_ = seed % 2 == 0;
    if (is_as_made_) {
      MakeFaces();
    }
    X_WH_ = Pose(RandomTurn(), RandomPoint(35e-3));
    step_ = 1e-6 * std::pow(10.0, random_.Uniform(0, 3));
  }

  void Step() {
    const bool is_jump = random_.Uniform(0, 1) < 0.02;
    const double angle = 60 * step_ * random_.Normal();
    const Pose turn(spatial::RotationFromVector(angle * RandomPoint(1).normalized()), Vec3::Zero());
    const Vec3 way = is_jump ? RandomPoint(5e-3) : RandomPoint(step_);
    const Vec3 back = -1e-3 * X_WH_.p();  // So that it stays among the others.
    X_WH_ = Pose(way + back) * X_WH_ * turn;
    const BodyId moved{std::size_t{3}};
    scene_.SetPose(moved, Pose(RandomPoint(0.2 * step_)) * scene_.pose(moved));
    options_.margin = random_.Uniform(0, 1) < 0.1 ? 200e-6 : 50e-6;
    options_.point_budget = 1000000;
    if (is_as_made_ && random_.Uniform(0, 1) < 0.02) {
      MakeFaces();
    }
  }

  void Ask(QueryWorkspace* work) const { scene_.Query(*held_, X_WH_, options_, work); }

  [[nodiscard]] Scene& scene() { return scene_; }

 private:
  // Gives the held part and half of the others faces as made.
  void MakeFaces() {
    const auto make = [this](const std::shared_ptr<const Shape>& shape) {
      std::vector<FaceOffset> faces(shape->data().exact.faces.size());
      for (FaceOffset& face : faces) {
        face.uniform = random_.Uniform(-30e-6, 30e-6);
      }
      return FaceOffsets::Make(shape, faces).value();
    };
    const auto shapes = ListShapes();
    for (std::uint32_t i = 0; i < scene_.size(); i += 2) {
      const auto shape = std::find_if(shapes.begin(), shapes.end(), [&](const auto& candidate) {
        return candidate.get() == &scene_.shape(BodyId{i});
      });
      scene_.SetOffsets(BodyId{i}, make(*shape));
    }
    held_made_ = make(held_);
    options_.held_offsets = held_made_.get();
  }

  static const std::vector<std::shared_ptr<const Shape>>& ListShapes() {
    static const std::vector<std::shared_ptr<const Shape>> shapes = {
        Build(testing::Cup(3e-3, 10e-3, 5e-3, 20e-3)),
        Build(testing::Shaft(2.995e-3, 20e-3)),
        Build(testing::Cone(8e-3, 4e-3, 10e-3, 5e-6)),
        Build(testing::Ring(8e-3, 3e-3, 10e-6)),
        Build(testing::Ball(5e-3, 10e-6)),
        Build(testing::Block({6e-3, 4e-3, 9e-3}))};
    return shapes;
  }

  Vec3 RandomPoint(double reach) {
    return {random_.Uniform(-reach, reach), random_.Uniform(-reach, reach),
            random_.Uniform(-reach, reach)};
  }

  Quat RandomTurn() {
    const Quat q(random_.Normal(), random_.Normal(), random_.Normal(), random_.Normal());
    return q.normalized();
  }

  Random random_;
  Scene scene_;
  std::shared_ptr<const Shape> held_;
  std::shared_ptr<const FaceOffsets> held_made_;
  bool is_as_made_{false};
  Pose X_WH_;
  double step_{0};
  QueryOptions options_;
};

void ExpectSame(const QueryWorkspace& a, const QueryWorkspace& b) {
  ASSERT_EQ(a.contacts().size(), b.contacts().size());
  EXPECT_EQ(a.stats().candidates, b.stats().candidates);
  EXPECT_EQ(a.deepest(), b.deepest());
  for (std::size_t k = 0; k < a.contacts().size(); ++k) {
    EXPECT_EQ(a.contacts()[k].distance, b.contacts()[k].distance);
    EXPECT_EQ(a.contacts()[k].p_WC, b.contacts()[k].p_WC);
    EXPECT_EQ(a.contacts()[k].body, b.contacts()[k].body);
    EXPECT_EQ(a.contacts()[k].scene_face, b.contacts()[k].scene_face);
  }
}

TEST(BoundMemory, AnswersAreThoseOfQueriesWithoutMemory) {
  std::size_t contacts = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Walk walk(seed);
    QueryWorkspace with(QueryMemory::kOfMotion);
    QueryWorkspace without;
    for (int step = 0; step < 200; ++step) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", step " << step);
      walk.Step();
      walk.Ask(&with);
      walk.Ask(&without);
      ExpectSame(with, without);
      if (::testing::Test::HasFailure()) {
        return;
      }
      contacts += with.contacts().size();
    }
  }
  EXPECT_GT(contacts, 10000U);
}

TEST(BoundMemory, LittleIsLookedAtOfWhatMovesSlowly) {
  Scene scene;
  scene.Add(Build(testing::Bushing(20e-3, 30e-3, 40e-3)), {});
  const auto shaft = Build(testing::Shaft(19e-3, 60e-3));
  QueryWorkspace with(QueryMemory::kOfMotion);
  QueryWorkspace without;
  std::uint64_t tested = 0;
  std::uint64_t tested_without = 0;
  for (int i = 0; i < 300; ++i) {
    const Pose X(Vec3(0.2e-3 * std::sin(0.01 * i), 0, -20e-3 + 20e-6 * i));
    scene.Query(*shaft, X, {}, &with);
    scene.Query(*shaft, X, {}, &without);
    ExpectSame(with, without);
    tested += with.stats().points_tested;
    tested_without += without.stats().points_tested;
  }
  EXPECT_LT(5 * tested, tested_without);
}

TEST(BoundMemory, VectorInstructionsRememberTheSameBits) {
  Walk with(7);
  Walk without(7);
  without.scene().UseScalarKernel();
  QueryWorkspace a(QueryMemory::kOfMotion);
  QueryWorkspace b(QueryMemory::kOfMotion);
  for (int step = 0; step < 200; ++step) {
    SCOPED_TRACE(::testing::Message() << "step " << step);
    with.Step();
    without.Step();
    with.Ask(&a);
    without.Ask(&b);
    ASSERT_EQ(a.stats().points_tested, b.stats().points_tested);
    ExpectSame(a, b);
  }
}

// What is asked for in one query stays until its end; then the least used makes way.
TEST(BoundMemory, HasRoomForAQueryAndForgetsTheLeastUsed) {
  BoundMemory memory;
  const auto find = [&memory](std::uint32_t body) {
    const SampledPair pair{1, 2, body, 0, false};
    return memory.Find(pair, Mat3::Identity(), Vec3::Zero(), 0.1, 16);
  };
  memory.Begin();
  std::uint32_t kept = 0;
  while (find(kept).bounds != nullptr) {
    find(kept).bounds[0] = 1.0F;
    ++kept;
  }
  EXPECT_GE(kept, 32U);
  EXPECT_EQ(find(0).bounds[0], 1.0F);
  memory.Begin();
  for (std::uint32_t body = 1; body < kept; ++body) {
    EXPECT_EQ(find(body).bounds[0], 1.0F);
  }
  memory.Begin();
  EXPECT_LT(find(1000).bounds[0], 0.0F);  // In the place of the first.
  EXPECT_EQ(find(1).bounds[0], 1.0F);
  EXPECT_LT(find(0).bounds[0], 0.0F);
}

TEST(BoundMemory, ASampleIsBeyondADistanceUntilTheShapesHaveMovedSoFar) {
  BoundMemory memory;
  const SampledPair pair{1, 2, 0, 0, false};
  const auto find = [&memory, &pair](double x) {
    memory.Begin();
    return memory.Find(pair, Mat3::Identity(), Vec3(x, 0, 0), 0.1, 16);
  };
  BoundView view = find(0);
  EXPECT_FALSE(memory.IsBeyond(view, 5, 0));
  memory.SetFar(view, 5, 200e-6);
  EXPECT_TRUE(memory.IsBeyond(view, 5, 50e-6));
  EXPECT_FALSE(memory.IsBeyond(view, 5, 201e-6));
  EXPECT_FALSE(memory.IsBeyond(view, 6, 50e-6));
  view = find(140e-6);
  EXPECT_TRUE(memory.IsBeyond(view, 5, 50e-6));
  view = find(160e-6);
  EXPECT_FALSE(memory.IsBeyond(view, 5, 50e-6));
  // Faces made anew are another pair, and what was cleared is not known.
  const SampledPair made{1, 2, 0, 0, false, 7, 0};
  const BoundView other = memory.Find(made, Mat3::Identity(), Vec3::Zero(), 0.1, 16);
  EXPECT_FALSE(memory.IsBeyond(other, 5, 0));
  view = find(1);
  EXPECT_FALSE(memory.IsBeyond(view, 5, 0));
}

TEST(BoundMemory, MotionIsNoLessThanThatOfAnyPoint) {
  BoundMemory memory;
  const SampledPair pair{1, 2, 0, 0, false};
  Random random(3);
  Pose X;
  std::array<Vec3, 40> q;
  for (Vec3& point : q) {
    point = 0.05 * Vec3(random.Normal(), random.Normal(), random.Normal()).normalized();
  }
  memory.Begin();
  double moved = static_cast<double>(memory.Find(pair, X.R(), X.p(), 0.05, 16).moved);
  for (int i = 0; i < 300; ++i) {
    const Vec3 angle = 1e-3 * Vec3(random.Normal(), random.Normal(), random.Normal());
    const Vec3 way = 1e-5 * Vec3(random.Normal(), random.Normal(), random.Normal());
    const Pose next = Pose(way) * X * Pose(spatial::RotationFromVector(angle), Vec3::Zero());
    memory.Begin();
    const double now = static_cast<double>(memory.Find(pair, next.R(), next.p(), 0.05, 16).moved);
    if (now > moved) {  // Else the bounds were cleared.
      double most = 0;
      for (const Vec3& point : q) {
        most = std::max(most, (next * point - X * point).norm());
      }
      EXPECT_GE(now - moved, most - 1e-7);
      EXPECT_LE(now - moved, 2 * most + 1e-7);  // Nor is it much more.
    }
    moved = now;
    X = next;
  }
}

}  // namespace
}  // namespace hvas::contact
