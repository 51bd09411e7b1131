#pragma once

#include <algorithm>
#include <cmath>

namespace hvas::contact {

/** How the edges of one helix stand to the field of another. */
struct HelixRelation {
  Mat3 own;     ///< Directions of the edges.
  Mat3 theirs;  ///< Directions of the field.
  Mat3 ways;    ///< Takes directions from the edges to the field.
  Vec3 origin;  ///< Origin of the edges in the field.
  double low;   ///< Part of the edges that is in the span of the field [m].
  double high;
  double reach;  ///< Depth of an edge in the field's side, at most [m].

  HelixRelation(const Helix& edges, const Helix& field, const Mat3& R, const Vec3& p,
                double margin) noexcept {
    // The span of the other is longer by what leaning may move.
    const Vec3 axis = R * edges.axis;
    const double cosine = axis.dot(field.axis);
    const double lean = std::sqrt(std::max(0.0, 1 - cosine * cosine)) * edges.largest_radius;
    const double start = field.axis.dot(R * edges.origin + p - field.origin);
    const double end_a = (field.low - lean - start) / cosine;
    const double end_b = (field.high + lean - start) / cosine;
    low = std::max(edges.low, std::min(end_a, end_b));
    high = std::min(edges.high, std::max(end_a, end_b));
    // However deep an edge is in the other's side, it is between root and crest or nearly so.
    reach = std::max(margin, field.largest_radius - field.least_radius);
    own << edges.u, edges.v, edges.axis;
    theirs << field.u, field.v, field.axis;
    ways = theirs.transpose() * R * own;
    origin = theirs.transpose() * (R * edges.origin + p - field.origin);
  }
};

template <typename Visit>
std::uint32_t ForEachEdgeContact(const Helix& edges, const Helix& field, const Mat3& R,
                                 const Vec3& p, double margin, const Visit& visit) noexcept {
  const HelixRelation to(edges, field, R, p, margin);
  const double step = edges.pitch / static_cast<double>(kHelixAzimuths);
  std::uint32_t count = 0;
  for (const HelixCorner& corner : edges.corners) {
    if (!corner.is_convex) {
      continue;
    }
    const auto first = static_cast<long>(std::ceil((to.low - corner.z) / step));
    const auto last = static_cast<long>(std::floor((to.high - corner.z) / step));
    for (long i = first; i <= last; ++i, ++count) {
      const auto around = static_cast<long>(kHelixAzimuths);
      const auto& azimuth =
          HelixAzimuths()[static_cast<std::size_t>((i % around + around) % around)];
      const double c = azimuth[0];
      const double s = edges.sense * azimuth[1];
      const double height = corner.z + static_cast<double>(i) * step;
      const Vec3 q(corner.r * c, corner.r * s, height);
      const Vec3 d(to.origin + to.ways * q);
      const HelixPoint at = HelixPoint::At(d.x(), d.y(), d.z());
      if (!IsInThread(field, at, to.reach)) {
        continue;
      }
      const HelixDistance found = CalcHelixDistance(field, at, margin);
      if (found.distance >= margin) {
        continue;
      }
      // Neither side of the edge may look away from what it is to touch.
      constexpr double kAway = -0.1;  // Cosine: 96 degrees. A choice.
      const Vec3 towards = -(to.ways.transpose() * (to.theirs.transpose() * found.gradient));
      const Vec3 local(c * towards.x() + s * towards.y(), c * towards.y() - s * towards.x(),
                       towards.z());
      if (corner.normals[0].dot(local) < kAway || corner.normals[1].dot(local) < kAway) {
        continue;
      }
      HelixContact contact;
      contact.p = edges.origin + to.own * q;
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
