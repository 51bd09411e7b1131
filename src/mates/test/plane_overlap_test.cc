#include "mates/plane_overlap.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"

namespace hvas::mates {
namespace {

std::vector<Triangle2> MakeRectangle(const Vec2& low, const Vec2& high) {
  const Vec2 right(high.x(), low.y());
  const Vec2 left(low.x(), high.y());
  return {{low, right, high}, {high, left, low}};  // One each way round would do as well.
}

TEST(PlaneOverlap, RectanglesMatchTheirClosedForm) {
  Random random(3);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec2 a(random.Uniform(), random.Uniform());
    const Vec2 b(random.Uniform(), random.Uniform());
    const Vec2 size_a(random.Uniform(0.1, 0.6), random.Uniform(0.1, 0.6));
    const Vec2 size_b(random.Uniform(0.1, 0.6), random.Uniform(0.1, 0.6));
    const Vec2 low = a.cwiseMax(b);
    const Vec2 high = (a + size_a).cwiseMin(b + size_b);
    const Vec2 side = (high - low).cwiseMax(0.0);
    const Overlap overlap = CalcOverlap(MakeRectangle(a, a + size_a), MakeRectangle(b, b + size_b));
    EXPECT_NEAR(overlap.area, side.x() * side.y(), 1e-13);
    if (overlap.area > 1e-6) {
      ++hits;
      EXPECT_LT((overlap.centroid - 0.5 * (low + high)).norm(), 1e-8);
    }
  }
  EXPECT_GT(hits, 500);
  EXPECT_LT(hits, 1500);
}

TEST(PlaneOverlap, TrianglesMatchAPointCountAndDoNotDependOnOrientation) {
  Random random(4);
  const auto is_inside = [](const Triangle2& t, const Vec2& p) {
    double signs[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 e = t[(k + 1) % 3] - t[k];
      const Vec2 d = p - t[k];
      signs[k] = e.x() * d.y() - e.y() * d.x();
    }
    return (signs[0] > 0 && signs[1] > 0 && signs[2] > 0) ||
           (signs[0] < 0 && signs[1] < 0 && signs[2] < 0);
  };
  for (int i = 0; i < 20; ++i) {
    Triangle2 a;
    Triangle2 b;
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = Vec2(random.Uniform(), random.Uniform());
      b[k] = Vec2(random.Uniform(), random.Uniform());
    }
    const double area = CalcOverlap({a}, {b}).area;
    constexpr int kGrid = 400;
    int count = 0;
    for (int x = 0; x < kGrid; ++x) {
      for (int y = 0; y < kGrid; ++y) {
        const Vec2 p((x + 0.5) / kGrid, (y + 0.5) / kGrid);
        count += is_inside(a, p) && is_inside(b, p) ? 1 : 0;
      }
    }
    EXPECT_NEAR(area, static_cast<double>(count) / (kGrid * kGrid), 4.0 / kGrid);
    std::swap(a[0], a[1]);
    EXPECT_NEAR(CalcOverlap({b}, {a}).area, area, 1e-15);
  }
}

TEST(PlaneOverlap, RingsShareTheirCommonRing) {
  // Annuli as strips of triangles: 1..3 against 2..4 share 2..3.
  const auto make_ring = [](double inner, double outer) {
    std::vector<Triangle2> triangles;
    constexpr int kSteps = 360;
    for (int i = 0; i < kSteps; ++i) {
      const double s = 2 * std::numbers::pi * i / kSteps;
      const double t = 2 * std::numbers::pi * (i + 1) / kSteps;
      const Vec2 u(std::cos(s), std::sin(s));
      const Vec2 v(std::cos(t), std::sin(t));
      triangles.push_back({inner * u, outer * u, outer * v});
      triangles.push_back({inner * u, outer * v, inner * v});
    }
    return triangles;
  };
  const Overlap overlap = CalcOverlap(make_ring(1, 3), make_ring(2, 4));
  const double polygon = 0.5 * 360 * std::sin(2 * std::numbers::pi / 360) * (9 - 4);
  EXPECT_NEAR(overlap.area, polygon, 1e-11);
  EXPECT_LT(overlap.centroid.norm(), 1e-12);
}

}  // namespace
}  // namespace hvas::mates
