#pragma once

#include "base/diagnostics.h"
#include "product/product.h"

/** Which faces of an assembled product belong together: paper X's external constraints (X2), found
 instead of authored (N1). */
namespace hvas::mates {

/** Limits of the search. Lengths hold for parts between 5 mm and 1 m; for smaller and larger ones
 they scale with the smaller part of the pair, so a model drawn in wrong units still has its mates.
 */
struct InferenceLimits {
  double angle{1.745329252e-3};      ///< Of axes and normals from parallel (0.1 deg) [rad].
  double axis_distance{20e-6};       ///< Between two axes taken as one [m].
  double radius_difference{0.6e-3};  ///< Of hole and shaft [m], or the next one, if more.
  double radius_ratio{0.3};          ///< The same as a part of the radius.
  double axial_overlap{50e-6};       ///< Least engaged length [m].
  double coverage{3.4906585};        ///< Least turn that a hole or shaft covers (200 deg) [rad].
  double plane_gap{10e-6};           ///< Between faces that touch, also as overlap [m].
  double area_ratio{0.01};           ///< Least overlap as a part of the smaller face.
  double area{0.05e-6};              ///< Least overlap [m^2].
};

/** Fills product->mates (replacing what is there) from the poses as drawn.

 Axis-hole: hole and shaft on one axis that engage; one mate for each pair of parts and axis, on the
 features that fit tightest among the long engagements; none where a third part (a bushing) lies
 between, nor for a wide passage around a shaft that another part guides. Face-face: opposing planes
 that touch over an area; one mate for each pair of parts and plane. Both connectors of a mate
 coincide exactly in the drawn pose, whatever play the drawing has, so the drawn pose fulfils all
 mates at once. Nothing is moved.

 Notes parts without a mate ("no-mate") and drawn interference ("drawn-interference"). */
void Infer(product::Product* product, Diagnostics* diagnostics, const InferenceLimits& limits = {});

/** How the mates tie a product together. */
struct Linkage {
  int linked_parts{0};       ///< Occurrences with at least one mate.
  int components{0};         ///< Connected groups among them.
  int largest_component{0};  ///< Occurrences in the largest group.
};

[[nodiscard]] Linkage CalcLinkage(const product::Product& product);

/** Occurrences with at least one mate. */
[[nodiscard]] int LinkedParts(const product::Product& product);

}  // namespace hvas::mates
