#pragma once

#include <cstdint>
#include <vector>

#include "contact/mesh.h"
#include "contact/near_list.h"
#include "contact/shape.h"
#include "paths/grid.h"

namespace hvas::paths {

/** Signed distance of points to a part's triangles, negative inside, on a grid around the part.
 Several threads may ask one. */
class PartField {
 public:
  /** @param spacing  Of the grid [m]; larger ones are taken for parts of very many nodes.
   @param band  Distances up to it are told [m].
   @pre the part has triangles. */
  PartField(const contact::ShapeSource& part, double spacing, double band, unsigned threads);

  /** Interpolated between exact values within the band; beyond it no more than the true amount, and
   at least the band. At a point of B [m]. */
  [[nodiscard]] double At(const Vec3& p_B) const;

  /** A distance, and the point of the surface that has it; that asked for where none is known. */
  struct Nearest {
    double distance{0};
    Vec3 q_B{Vec3::Zero()};
  };

  /** Exact within the band, beyond it as At. Ten times as slow. */
  [[nodiscard]] Nearest ExactAt(const Vec3& p_B) const;

  /** Bound of what interpolation adds to the distance, or takes from it [m]. */
  [[nodiscard]] double error() const;

 private:
  friend class FieldFiller;

  static constexpr std::uint32_t kNoLeaf = 0xffffffffU;  ///< No leaf.

  /** A cube near the surface, with the triangles that can be closest to what lies in it. */
  struct Leaf {
    Vec3 centre{Vec3::Zero()};
    std::uint32_t hint{0};
    contact::NearList near;
  };

  contact::Mesh mesh_;
  contact::NearSearch search_;  // Searches mesh_.
  spatial::Box box_;
  double band_;
  Grid grid_;
  std::vector<Leaf> leaves_;
  std::vector<std::uint32_t> leaf_of_node_;
};

}  // namespace hvas::paths
