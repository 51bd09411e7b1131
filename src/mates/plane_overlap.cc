#include "mates/plane_overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hvas::mates {
namespace {

struct Sorted {
  Triangle2 triangle;  // Counter-clockwise.
  Vec2 low;
  Vec2 high;
};

double CalcCross(const Vec2& u, const Vec2& v) {
  return u.x() * v.y() - u.y() * v.x();
}

std::vector<Sorted> SortByX(const std::vector<Triangle2>& triangles) {
  std::vector<Sorted> sorted;
  sorted.reserve(triangles.size());
  for (Triangle2 t : triangles) {
    const double doubled_area = CalcCross(t[1] - t[0], t[2] - t[0]);
    if (doubled_area == 0) {
      continue;
    }
    if (doubled_area < 0) {
      std::swap(t[1], t[2]);
    }
    const Vec2 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
    const Vec2 high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    sorted.push_back({t, low, high});
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Sorted& s, const Sorted& t) { return s.low.x() < t.low.x(); });
  return sorted;
}

/** A convex polygon; two triangles have at most six corners in common. */
struct Polygon {
  std::array<Vec2, 12> corners;
  int count{0};
};

/** Sutherland and Hodgman: what lies left of the edge from p to q. */
Polygon ClipLeft(const Polygon& in, const Vec2& p, const Vec2& q) {
  Polygon out;
  const Vec2 edge = q - p;
  for (int i = 0; i < in.count; ++i) {
    const Vec2& current = in.corners[static_cast<std::size_t>(i)];
    const Vec2& next = in.corners[static_cast<std::size_t>(i + 1 < in.count ? i + 1 : 0)];
    const double side_current = CalcCross(edge, current - p);
    const double side_next = CalcCross(edge, next - p);
    if (side_current >= 0) {
      out.corners[static_cast<std::size_t>(out.count++)] = current;
    }
    if ((side_current > 0 && side_next < 0) || (side_current < 0 && side_next > 0)) {
      const double t = side_current / (side_current - side_next);
      out.corners[static_cast<std::size_t>(out.count++)] = current + t * (next - current);
    }
  }
  return out;
}

/** True where an edge of `t` has all of `other` on its outer side. */
bool HasSeparatingEdge(const Triangle2& t, const Triangle2& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2& p = t[k];
    const Vec2 edge = t[(k + 1) % 3] - p;
    if (CalcCross(edge, other[0] - p) <= 0 && CalcCross(edge, other[1] - p) <= 0 &&
        CalcCross(edge, other[2] - p) <= 0) {
      return true;
    }
  }
  return false;
}

/** Adds the area, and the area times the centroid, of what two triangles share. */
void AddCommon(const Triangle2& a, const Triangle2& b, double* area, Vec2* moment) {
  if (HasSeparatingEdge(a, b) || HasSeparatingEdge(b, a)) {
    return;
  }
  Polygon polygon;
  std::copy(a.begin(), a.end(), polygon.corners.begin());
  polygon.count = 3;
  for (std::size_t k = 0; k < 3 && polygon.count > 0; ++k) {
    polygon = ClipLeft(polygon, b[k], b[(k + 1) % 3]);
  }
  for (int i = 1; i + 1 < polygon.count; ++i) {
    const Vec2& p = polygon.corners[0];
    const Vec2& q = polygon.corners[static_cast<std::size_t>(i)];
    const Vec2& r = polygon.corners[static_cast<std::size_t>(i) + 1];
    const double piece = 0.5 * CalcCross(q - p, r - p);
    *area += piece;
    *moment += piece / 3.0 * (p + q + r);
  }
}

}  // namespace

Overlap CalcOverlap(const std::vector<Triangle2>& a, const std::vector<Triangle2>& b,
                    WorkWatch* watch) {
  const std::vector<Sorted> sorted_a = SortByX(a);
  const std::vector<Sorted> sorted_b = SortByX(b);
  double area = 0;
  Vec2 moment = Vec2::Zero();
  std::vector<std::size_t> active;  // Of b, those that the sweep has not left behind.
  std::size_t next_b = 0;
  for (const Sorted& s : sorted_a) {
    if (!MayGoOn(watch)) {
      break;
    }
    while (next_b < sorted_b.size() && sorted_b[next_b].low.x() <= s.high.x()) {
      active.push_back(next_b++);
    }
    std::erase_if(active, [&](std::size_t k) { return sorted_b[k].high.x() < s.low.x(); });
    for (const std::size_t k : active) {
      const Sorted& t = sorted_b[k];
      if (t.low.x() <= s.high.x() && t.low.y() <= s.high.y() && t.high.y() >= s.low.y()) {
        AddCommon(s.triangle, t.triangle, &area, &moment);
      }
    }
  }
  return {area, area > 0 ? Vec2(moment / area) : Vec2::Zero()};
}

std::vector<Triangle2> SelectNear(const std::vector<Triangle2>& triangles,
                                  const std::vector<Triangle2>& others) {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (const Triangle2& t : others) {
    low = low.cwiseMin(t[0]).cwiseMin(t[1]).cwiseMin(t[2]);
    high = high.cwiseMax(t[0]).cwiseMax(t[1]).cwiseMax(t[2]);
  }
  std::vector<Triangle2> selected;
  for (const Triangle2& t : triangles) {
    if ((t[0].cwiseMin(t[1]).cwiseMin(t[2]).array() <= high.array()).all() &&
        (t[0].cwiseMax(t[1]).cwiseMax(t[2]).array() >= low.array()).all()) {
      selected.push_back(t);
    }
  }
  return selected;
}

}  // namespace hvas::mates
