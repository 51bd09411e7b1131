#pragma once

#include <algorithm>
#include <cmath>

namespace hvas::contact {

template <typename Visit>
std::uint32_t ForEachEdgeContact(const Helix& edges, const Helix& field, const Mat3& R,
                                 const Vec3& p, double margin, const Visit& visit) noexcept {
  // The part of the edges that is in the span of the other, longer by what leaning may move.
  const Vec3 axis = R * edges.axis;
  const double cosine = axis.dot(field.axis);
  const double lean = std::sqrt(std::max(0.0, 1 - cosine * cosine)) * edges.largest_radius;
  const double start = field.axis.dot(R * edges.origin + p - field.origin);
  const double end_a = (field.low - lean - start) / cosine;
  const double end_b = (field.high + lean - start) / cosine;
  const double low = std::max(edges.low, std::min(end_a, end_b));
  const double high = std::min(edges.high, std::max(end_a, end_b));
  const double step = edges.pitch / static_cast<double>(kHelixAzimuths);
  const Vec3 v = edges.axis.cross(edges.u);
  // However deep an edge is in the other's side, it is between root and crest or nearly so.
  const double reach = std::max(margin, field.largest_radius - field.least_radius);
  std::uint32_t count = 0;
  for (const HelixCorner& corner : edges.corners) {
    if (!corner.is_convex) {
      continue;
    }
    const auto first = static_cast<long>(std::ceil((low - corner.z) / step));
    const auto last = static_cast<long>(std::floor((high - corner.z) / step));
    for (long i = first; i <= last; ++i) {
      constexpr auto kCount = static_cast<long>(kHelixAzimuths);
      const auto& [c, s] =
          HelixAzimuths()[static_cast<std::size_t>((i % kCount + kCount) % kCount)];
      const Vec3 radial = c * edges.u + edges.sense * s * v;
      const double height = corner.z + static_cast<double>(i) * step;
      HelixContact contact;
      contact.p = edges.origin + height * edges.axis + corner.r * radial;
      const Vec3 p_F(R * contact.p + p);
      ++count;
      const HelixPoint at = Locate(field, p_F);
      if (!IsInThread(field, at, reach)) {
        continue;
      }
      const HelixDistance found = CalcHelixDistance(field, at);
      if (found.distance >= margin) {
        continue;
      }
      // Neither side of the edge may look away from what it is to touch.
      constexpr double kAway = -0.1;  // Cosine: 96 degrees. A choice.
      const Vec3 towards = -(R.transpose() * found.gradient);
      const Vec3 around = edges.axis.cross(radial);
      const Vec3 local(towards.dot(radial), towards.dot(around), towards.dot(edges.axis));
      if (corner.normals[0].dot(local) < kAway || corner.normals[1].dot(local) < kAway) {
        continue;
      }
      contact.gradient = found.gradient;
      contact.distance = found.distance;
      if (!visit(contact)) {
        return count;
      }
    }
  }
  return count;
}

}  // namespace hvas::contact
