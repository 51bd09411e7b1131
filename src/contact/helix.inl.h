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
  // However deep an edge is in the other's side, it is between root and crest or nearly so.
  const double reach = std::max(margin, field.largest_radius - field.least_radius);
  // In the other's coordinates: where the edges' origin is, and their own directions.
  Mat3 own;
  own << edges.u, edges.v, edges.axis;
  Mat3 theirs;
  theirs << field.u, field.v, field.axis;
  const Mat3 ways = theirs.transpose() * R * own;
  const Vec3 origin = theirs.transpose() * (R * edges.origin + p - field.origin);
  std::uint32_t count = 0;
  for (const HelixCorner& corner : edges.corners) {
    if (!corner.is_convex) {
      continue;
    }
    const auto first = static_cast<long>(std::ceil((low - corner.z) / step));
    const auto last = static_cast<long>(std::floor((high - corner.z) / step));
    for (long i = first; i <= last; ++i, ++count) {
      const auto around = static_cast<long>(kHelixAzimuths);
      const auto& azimuth =
          HelixAzimuths()[static_cast<std::size_t>((i % around + around) % around)];
      const double c = azimuth[0];
      const double s = edges.sense * azimuth[1];
      const double height = corner.z + static_cast<double>(i) * step;
      const Vec3 q(corner.r * c, corner.r * s, height);
      const Vec3 d(origin + ways * q);
      const HelixPoint at = HelixPoint::At(d.x(), d.y(), d.z());
      if (!IsInThread(field, at, reach)) {
        continue;
      }
      const HelixDistance found = CalcHelixDistance(field, at, margin);
      if (found.distance >= margin) {
        continue;
      }
      // Neither side of the edge may look away from what it is to touch.
      constexpr double kAway = -0.1;  // Cosine: 96 degrees. A choice.
      const Vec3 towards = -(ways.transpose() * (theirs.transpose() * found.gradient));
      const Vec3 local(c * towards.x() + s * towards.y(), c * towards.y() - s * towards.x(),
                       towards.z());
      if (corner.normals[0].dot(local) < kAway || corner.normals[1].dot(local) < kAway) {
        continue;
      }
      HelixContact contact;
      contact.p = edges.origin + own * q;
      contact.gradient = found.gradient;
      contact.distance = found.distance;
      if (!visit(contact)) {
        return count + 1;
      }
    }
  }
  return count;
}

}  // namespace hvas::contact
