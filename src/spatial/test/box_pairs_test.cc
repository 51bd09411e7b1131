#include "spatial/box_pairs.h"

#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/work_watch.h"

namespace hvas::spatial {
namespace {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

std::vector<Box> DrawBoxes(Random* random, int count, double length) {
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i) {
    const Vec3 low(random->Uniform(0, 1), random->Uniform(0, 1), random->Uniform(0, length));
    const Vec3 size(random->Uniform(0, 0.3), random->Uniform(0, 0.3), random->Uniform(0, 0.3));
    boxes.push_back(i % 17 == 3 ? Box() : Box{low, low + size});
  }
  return boxes;
}

/** Boxes of one size at one place. */
std::vector<Box> MakeStack(std::size_t count) {
  return std::vector<Box>(count, Box{Vec3::Zero(), Vec3::Ones()});
}

TEST(BoxPairs, AreThoseOfComparingAllInAscendingOrder) {
  constexpr double kMargin = 0.01;
  Random random(17);
  for (int draw = 0; draw < 20; ++draw) {
    const std::vector<Box> boxes = DrawBoxes(&random, 120, draw + 0.1);
    const std::vector<Box> others = DrawBoxes(&random, 70, draw + 0.1);
    const auto is_near = [](const Box& a, const Box& b) {
      return !a.is_empty() && !b.is_empty() && a.Expanded(kMargin).Overlaps(b);
    };
    Pairs within;
    Pairs between;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t k = i + 1; k < boxes.size(); ++k) {
        if (is_near(boxes[i], boxes[k])) {
          within.emplace_back(i, k);
        }
      }
      for (std::size_t k = 0; k < others.size(); ++k) {
        if (is_near(boxes[i], others[k])) {
          between.emplace_back(i, k);
        }
      }
    }
    Pairs found;
    const auto keep = [&found](std::size_t i, std::size_t k) {
      found.emplace_back(i, k);
      return true;
    };
    EXPECT_TRUE(ForEachPair(boxes, kMargin, nullptr, keep));
    EXPECT_EQ(found, within);
    found.clear();
    EXPECT_TRUE(ForEachPair(boxes, others, kMargin, nullptr, keep));
    EXPECT_EQ(found, between);
  }
}

TEST(BoxPairs, EndWithTheFirstThatIsRefused) {
  int visited = 0;
  EXPECT_FALSE(ForEachPair(MakeStack(50), 0, nullptr,
                           [&](std::size_t /*i*/, std::size_t /*k*/) { return ++visited < 3; }));
  EXPECT_EQ(visited, 3);
}

TEST(BoxPairs, BeyondTheLimitEndTheVisitAndTheWatchSaysSo) {
  WorkLimits limits;
  limits.pairs = 100;
  WorkWatch watch(limits);
  int visited = 0;
  EXPECT_FALSE(ForEachPair(MakeStack(50), 0, &watch, [&](std::size_t /*i*/, std::size_t /*k*/) {
    ++visited;
    return true;
  }));
  EXPECT_EQ(visited, 100);
  EXPECT_FALSE(watch.MayGoOn());
}

TEST(BoxPairs, TimeThatIsUpEndsTheVisit) {
  WorkWatch watch({0, 0});
  EXPECT_FALSE(ForEachPair(MakeStack(2), 0, &watch,
                           [](std::size_t /*i*/, std::size_t /*k*/) { return true; }));
}

TEST(BoxPairs, OfAHundredThousandBoxesInARowBesideOneLongOneAreFoundWithoutComparingAll) {
  constexpr std::size_t kCount = 100'000;  // All pairs of them are 5e9.
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < kCount; ++i) {
    const Vec3 low(static_cast<double>(i), 0, 0);
    boxes.push_back({low, low + Vec3::Constant(0.5)});
  }
  boxes.push_back({Vec3(0, 2, 0), Vec3(kCount, 3, 1)});
  std::size_t visited = 0;
  const auto count = [&visited](std::size_t /*i*/, std::size_t /*k*/) {
    ++visited;
    return true;
  };
  WorkLimits limits;
  limits.time = 20;  // [s]: a hundredth of a second suffices; wide for sanitizers.
  WorkWatch watch(limits);
  EXPECT_TRUE(ForEachPair(boxes, 0.1, &watch, count));
  EXPECT_EQ(visited, 0U);
}

TEST(BoxPairs, ConnectWhatHangsTogether) {
  std::vector<Box> boxes;
  for (int i = 0; i < 30; ++i) {
    const Vec3 low(i, 0, 0);
    boxes.push_back({low, low + Vec3(0.9, 1, 1)});
  }
  EXPECT_TRUE(AreConnected(boxes, 0.11, nullptr));
  EXPECT_FALSE(AreConnected(boxes, 0.09, nullptr));
  EXPECT_TRUE(AreConnected({}, 0, nullptr));
  boxes.emplace_back();
  EXPECT_FALSE(AreConnected(boxes, 0.11, nullptr));
}

}  // namespace
}  // namespace hvas::spatial
