#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "product/face_adjacency.h"
#include "product/product.h"

namespace hvas::product {

/** What is found at one end of a ring, looked at in 24 sectors of the turn: in each of them the
 outermost segment of the border counts. */
struct RingEnd {
  int sectors{0};  ///< Sectors with a segment; the others below are counts of these.
  int convex{0}, concave{0}, tangent{0}, open{0};
  std::vector<std::pair<FaceId, int>> neighbours;  ///< Ordered by their counts, largest first.
  double radius{0};                                ///< Radius at that end [m].
};

/** Faces of one surface of revolution about its axis: a step of a hole or shaft, a chamfer, the
 rounding of an edge. */
struct Ring {
  SurfaceKind kind{SurfaceKind::kCylinder};  ///< Cylinder, cone or torus.
  Surface surface;
  std::vector<FaceId> faces;
  FeatureId feature;  ///< Invalid for tori and parts of a turn.
  Vec3 origin_B{Vec3::Zero()};
  Vec3 axis_B{Vec3::UnitZ()};   ///< The canonical one of the two directions.
  double low{0}, high{0};       ///< Along axis_B from origin_B [m].
  bool is_inward{true};         ///< Its normals look towards the axis.
  double turn{0};               ///< What it covers of the turn [rad]; filled for parts of a turn.
  std::array<RingEnd, 2> ends;  ///< The ends at low and at high.

  [[nodiscard]] double at(std::size_t end) const { return end == 0 ? low : high; }

  [[nodiscard]] Vec3 point(std::size_t end) const { return origin_B + at(end) * axis_B; }

  [[nodiscard]] double radius() const { return surface.radius; }
};

/** The rings of a part: of its holes, shafts and cones, in their order; then the tori by their
 first face. */
struct RingSet {
  static constexpr std::uint32_t kNone = 0xffffffffU;  ///< No ring.

  std::vector<Ring> rings;
  std::vector<std::uint32_t> ring_of_face;  ///< Index or kNone.
};

[[nodiscard]] RingSet FindRings(const Part& part, const FaceAdjacency& adjacency, double tolerance);

/** Pieces of a cylinder that are no feature by themselves, each with all faces of its surface that
 meet it: slot ends, fillets, corners. */
[[nodiscard]] std::vector<Ring> FindPartialCylinders(const Part& part,
                                                     const FaceAdjacency& adjacency,
                                                     const RingSet& set, double tolerance);

/** A face that leads from one ring to the next (a shoulder); invalid where they meet directly. */
struct RingLink {
  std::uint32_t ring{RingSet::kNone};
  std::size_t end{0};
  std::vector<FaceId> shoulder;
};

/** A ring of a chain and the end at which it is entered. */
struct ChainItem {
  std::uint32_t ring{0};
  std::size_t near{0};
  std::vector<FaceId> shoulder;  ///< Faces between it and the item before.

  [[nodiscard]] std::size_t far() const { return 1 - near; }
};

/** Rings of one axis and sense that follow each other, from end to end. */
using RingChain = std::vector<ChainItem>;

/** Each ring is in one chain. Two rings are tied where they meet in an edge, or both meet a flat
 shoulder across the axis. A floor that other holes open into ties nothing, nor does a shoulder
 between bores whose radii differ by more than a factor of 4. */
[[nodiscard]] std::vector<RingChain> FindChains(const Part& part, const FaceAdjacency& adjacency,
                                                const RingSet& set, double tolerance);

}  // namespace hvas::product
