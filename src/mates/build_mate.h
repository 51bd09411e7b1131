#pragma once

#include "product/product.h"

namespace hvas::mates {

/** One side of a mate: a feature of an occurrence, at the pose in which it counts as assembled. For
 inferred mates that is the drawn pose. */
struct MateSide {
  product::OccurrenceId occurrence;
  product::FeatureId feature;
  product::Pose X_WB;
};

/** Spans of two features about one axis, along the axis of the first from its origin [m]. */
struct AxialSpans {
  double sense{1};  ///< -1 where the second one's axis points the other way.
  double first_low{0}, first_high{0};
  double second_low{0}, second_high{0};
  double low{0}, high{0};  ///< What they share; high < low where they share nothing.
  double shift{0};         ///< Shift of the second one's origin along the axis.
  double axis_distance{
      0};  ///< Offset of the second axis from the first, in the middle of what they share.

  [[nodiscard]] double length() const { return high - low; }
};

/** @param X_AB  Pose of the second feature's part in the first one's. */
[[nodiscard]] AxialSpans CalcAxialSpans(const product::Feature& first,
                                        const product::Feature& second, const product::Pose& X_AB);

/** A mate of the kind that the two features make, with connectors, spans and radii as `Mate` says:
 hole and shaft, seat and taper, socket and ball (in this order), or two planes; prismatic mates are
 made of several (prismatic_fits.h). The frames coincide
 in the given poses, whatever play these leave. Without key, surfaces, fit and evidence. For planes
 the frames stand where the middle of `a` falls on its own plane; see `MoveFrames`. */
[[nodiscard]] product::Mate BuildMate(const product::Product& product, product::MateKind kind,
                                      const MateSide& a, const MateSide& b);

/** Moves the frames of a face-face mate to the foot of `p_W` on the plane of `a`. */
void MoveFrames(const product::Product& product, const MateSide& a, const MateSide& b,
                const Vec3& p_W, product::Mate* mate);

}  // namespace hvas::mates
