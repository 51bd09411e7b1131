#pragma once

#include "product/product.h"

namespace hvas::shopfloor {

/** Symmetry of a part as Boothroyd and Dewhurst use it (Product Design for Assembly, 1989): alpha
 is the least turn about an axis normal to the way of insertion that repeats the part, beta the
 least turn about the way. What goes on at any turn has 0, as a cylinder about its axis. */
struct PartSymmetry {
  int alpha_deg{360};  ///< 0, 60, 72, 90, 120, 180 or 360.
  int beta_deg{360};   ///< 0, 360 / n for n from 2 to 60, rounded, or 360.

  [[nodiscard]] int sum_deg() const { return alpha_deg + beta_deg; }

  bool operator==(const PartSymmetry&) const = default;
};

/** Finds the symmetry of a part by turning points of its surface about its centroid and
 measuring how far they then are from it: within 1 % of the part's size, or 0.2 mm for parts of less
 than 20 mm, they repeat it. What is smaller, as a chamfer or an engraving, makes no difference.
 @param way_B  Way of insertion, unit. */
[[nodiscard]] PartSymmetry FindSymmetry(const product::Part& part, const Vec3& way_B);

}  // namespace hvas::shopfloor
