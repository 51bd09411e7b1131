// A query is part of the haptic tick: it must not allocate and must repeat exactly.

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

#include <gtest/gtest.h>

#include "contact/scene.h"
#include "contact/test/parts.h"

namespace {
std::atomic<int> allocations{0};
}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) {
    return p;
  }
  throw std::bad_alloc();
}

[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t align) {
  ++allocations;
  const auto a = static_cast<std::size_t>(align);
  if (void* p = std::aligned_alloc(a, (size + a - 1) / a * a)) {
    return p;
  }
  throw std::bad_alloc();
}

[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}

[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}

[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}

[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace hvas::contact {
namespace {

using spatial::Pose;

class RealtimeTest : public ::testing::Test {
 protected:
  RealtimeTest() {
    static const auto cup = testing::Build(testing::Cup(3e-3, 20e-3, 5e-3, 20e-3));
    for (int i = 0; i < 20; ++i) {
      cups_.push_back(scene_.Add(cup, Pose(Vec3(0.05 * i, 0, 0))));
    }
    scene_.SetGround(-1e-3);
    // One cup and the dowel as made: the bore wider, the floor lower, the dowel thicker and worn.
    std::vector<FaceOffset> offsets(5);
    offsets[3].uniform = -4e-6;
    offsets[4].uniform = -2e-6;
    scene_.SetOffsets(cups_[0], FaceOffsets::Make(cup, offsets).value());
    offsets.resize(2);
    offsets[1] = {1e-6, {0, -1e-6, 1e-6}, 0, 20e-3};
    dowel_offsets_ = FaceOffsets::Make(dowel_, offsets).value();
  }

  Pose At(int i) const { return Pose(Vec3(8e-6, 5e-6 * (i % 5), 5e-3 - 1e-6 * (i % 40))); }

  Scene scene_;
  std::vector<BodyId> cups_;
  std::shared_ptr<const Shape> dowel_ = testing::Build(testing::Shaft(2.995e-3, 20e-3));
  std::shared_ptr<const FaceOffsets> dowel_offsets_;
  QueryWorkspace work_;
};

TEST_F(RealtimeTest, QueryAndMovesDoNotAllocate) {
  const std::vector<std::uint32_t> faces{1, 3};
  const IgnoredPair pair{cups_[0], faces, faces};
  QueryOptions options;
  std::uint64_t candidates = 0;
  double pooled = 0;
  const int before = allocations;
  for (int i = 0; i < 200; ++i) {
    options.ignored = i % 2 == 0 ? std::span<const IgnoredPair>() : std::span(&pair, 1);
    options.margin = i % 3 == 0 ? 2e-3 : 50e-6;
    options.held_offsets = i % 4 < 2 ? dowel_offsets_.get() : nullptr;
    scene_.Query(*dowel_, At(i), options, &work_);
    candidates += work_.stats().candidates;
    const Vec3 p_WH = At(i).p();
    pooled += work_.layer().CalcWrench(1e3, p_WH).f.norm();
    pooled += CalcPooledWrench(work_.contacts(), p_WH, 1e3).K.trace();
    (void)scene_.IsFree(*dowel_, At(i), 1e-6, options, &work_);
    scene_.SetPose(cups_[static_cast<std::size_t>(1 + i % 19)], Pose(Vec3(0.05 * i, 0.1, 0)));
    scene_.SetEnabled(cups_[1], i % 2 == 0);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(candidates, 1000U);
  EXPECT_GT(pooled, 0);
}

TEST_F(RealtimeTest, TheSameQueryGivesTheSameBits) {
  QueryWorkspace other;
  for (int i = 0; i < 50; ++i) {
    scene_.Query(*dowel_, At(i), {}, &work_);
    scene_.Query(*dowel_, At(i + 1), {}, &other);  // Leaves its traces in the workspace.
    scene_.Query(*dowel_, At(i), {}, &other);
    ASSERT_EQ(work_.contacts().size(), other.contacts().size());
    for (std::size_t k = 0; k < work_.contacts().size(); ++k) {
      const Contact& a = work_.contacts()[k];
      const Contact& b = other.contacts()[k];
      EXPECT_EQ(std::memcmp(&a.distance, &b.distance, sizeof(double)), 0);
      EXPECT_EQ(a.p_WC, b.p_WC);
      EXPECT_EQ(a.nhat_W, b.nhat_W);
      EXPECT_EQ(a.scene_face, b.scene_face);
    }
  }
}

}  // namespace
}  // namespace hvas::contact
