#pragma once

#include <span>
#include <vector>

#include "product/product.h"

namespace hvas::product {

/** How two faces meet along an edge, seen from outside the material. */
enum class EdgeSense {
  kConvex,   ///< The material fills less than half a turn: an outer edge.
  kConcave,  ///< It fills more: an inner corner.
  kTangent,  ///< The faces run on into each other.
  kOpen,     ///< No other face is there.
};

/** A segment of a face's border. */
struct FaceEdge {
  FaceId other;  ///< Invalid for kOpen.
  EdgeSense sense{EdgeSense::kOpen};
  double angle{0};  ///< Angle between the outward normals, positive for convex [rad].
  Vec3 start, end;  ///< Points in B; the face is on the left as seen from outside [m].
  Vec3 conormal;    ///< Lies in the face, at a right angle to the segment, out of the face; unit.
};

/** All that a face has in common with one other face. */
struct FaceNeighbour {
  FaceId face;
  double length{0};  ///< Length of all common segments [m].
  double convex{0}, concave{0}, tangent{0};
  double angle{0};  ///< Mean over the length [rad].

  /** The sense of at least 9 tenths of the length. */
  [[nodiscard]] bool Is(EdgeSense sense) const;
};

/** Which faces of a part meet, found on its mesh: the mesh is conforming along the edges of the
 B-rep, so that segments of two faces coincide. Where a face is analytic its exact normals are used.
 Linear in the number of triangles. */
class FaceAdjacency {
 public:
  /** @param tolerance Vertices closer than this are one [m]. */
  FaceAdjacency(const Part& part, double tolerance);

  [[nodiscard]] std::span<const FaceEdge> edges(FaceId face) const {
    return std::span(edges_).subspan(first_edge_[face.index()],
                                     first_edge_[face.index() + 1] - first_edge_[face.index()]);
  }

  /** Neighbours by their id; open borders are left out. */
  [[nodiscard]] std::span<const FaceNeighbour> neighbours(FaceId face) const {
    return std::span(neighbours_)
        .subspan(first_neighbour_[face.index()],
                 first_neighbour_[face.index() + 1] - first_neighbour_[face.index()]);
  }

 private:
  void CollectNeighbours(std::size_t face_count);

  std::vector<FaceEdge> edges_;          // Grouped by face.
  std::vector<std::size_t> first_edge_;  // By face, and one more.
  std::vector<FaceNeighbour> neighbours_;
  std::vector<std::size_t> first_neighbour_;
};

/** Outward normal of a face at a point on it; `flat` where its surface has none there. */
[[nodiscard]] Vec3 CalcNormal(const Face& face, const Vec3& p, const Vec3& flat);

}  // namespace hvas::product
