#pragma once

#include <limits>

#include "spatial/pose.h"

namespace hvas::spatial {

/** Axis-aligned box; empty by default. */
struct Box {
  Vec3 low{Vec3::Constant(std::numeric_limits<double>::infinity())};
  Vec3 high{Vec3::Constant(-std::numeric_limits<double>::infinity())};

  [[nodiscard]] bool is_empty() const { return (low.array() > high.array()).any(); }

  [[nodiscard]] Vec3 centre() const { return 0.5 * (low + high); }

  [[nodiscard]] Vec3 size() const { return high - low; }

  void Add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }

  void Add(const Box& box) {
    low = low.cwiseMin(box.low);
    high = high.cwiseMax(box.high);
  }

  [[nodiscard]] Box Expanded(double margin) const {
    return {low - Vec3::Constant(margin), high + Vec3::Constant(margin)};
  }

  [[nodiscard]] bool Overlaps(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }

  [[nodiscard]] bool Contains(const Vec3& p) const {
    return (low.array() <= p.array()).all() && (p.array() <= high.array()).all();
  }
};

/** The box, in A, around a box given in B. */
[[nodiscard]] inline Box Transform(const Pose& X_AB, const Box& box_B) {
  if (box_B.is_empty()) {
    return {};
  }
  const Vec3 half = X_AB.R().cwiseAbs() * (0.5 * box_B.size());
  const Vec3 centre = X_AB * box_B.centre();
  return {centre - half, centre + half};
}

}  // namespace hvas::spatial
