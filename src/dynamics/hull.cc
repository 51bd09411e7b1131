#include "dynamics/hull.h"

#include <algorithm>
#include <limits>

namespace hvas::dynamics {

std::vector<Vec3> SelectSpread(std::span<const Vec3> points, std::size_t count) {
  if (points.size() <= count) {
    return {points.begin(), points.end()};
  }
  std::vector<Vec3> chosen;
  // Squared distance of each point to the nearest chosen one; 0 for those chosen, and their equals.
  std::vector<double> apart(points.size(), std::numeric_limits<double>::infinity());
  const auto choose = [&](std::size_t index) {
    chosen.push_back(points[index]);
    for (std::size_t i = 0; i < points.size(); ++i) {
      apart[i] = std::min(apart[i], (points[i] - points[index]).squaredNorm());
    }
  };
  for (int code = 0; code < 27; ++code) {
    const Vec3 direction =
        Eigen::Vector3i(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1).cast<double>();
    const auto farthest = std::max_element(
        points.begin(), points.end(),
        [&](const Vec3& a, const Vec3& b) { return a.dot(direction) < b.dot(direction); });
    const auto index = static_cast<std::size_t>(farthest - points.begin());
    if (direction != Vec3::Zero() && apart[index] > 0) {
      choose(index);
    }
  }
  while (chosen.size() < count) {
    const auto farthest = std::max_element(apart.begin(), apart.end());
    if (*farthest <= 0) {
      break;
    }
    choose(static_cast<std::size_t>(farthest - apart.begin()));
  }
  return chosen;
}

}  // namespace hvas::dynamics
