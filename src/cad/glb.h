#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "product/product.h"

namespace hvas::cad {

/** How an occurrence moves in an animation: poses at times, between which it goes evenly. Before
 `appears_s` it is not seen. */
struct GlbMotion {
  product::OccurrenceId occurrence;
  double appears_s{0};
  std::vector<double> times_s;      ///< Ascending, one or more.
  std::vector<product::Pose> X_WB;  ///< One for each time.
};

/** A product as a binary glTF 2.0 file (.glb), in metres, Y up.

 Nodes are the tree: a root that turns z up into y up, subassemblies, and occurrences with their
 poses; extras tell their ids. There is one mesh for each part, shared by its occurrences, with one
 primitive for each colour. Vertices have POSITION, NORMAL (smooth within a face) and _FACE_ID: the
 index of the face in its part, as a float, because glTF lets no such attribute be an integer.
 Deterministic.
 @param is_fine  The meshes for contact instead of those for the eye.
 @param motions  What moves in its one animation; none: there is no animation.
 Fails (kOutOfResource) above the 4 GiB that the format can hold. */
[[nodiscard]] Result<std::string> MakeGlb(const product::Product& product, bool is_fine,
                                          const std::vector<GlbMotion>& motions = {});

}  // namespace hvas::cad
