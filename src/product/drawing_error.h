#pragma once

#include "product/ids.h"

namespace hvas::product {

struct Product;

/** Two parts that are drawn deeper in one another than any fit of their size, any thread, or what
 gives of the two explains (mates/drawing_errors.h). */
struct DrawingError {
  OccurrenceId a;
  OccurrenceId b;
  FaceId face_a;      ///< The face of a that lies too deep; that of b is next to it.
  FaceId face_b;      ///< Either is invalid where the drawing has no faces there.
  double depth{0};    ///< How deep they lie in one another: of cylinders, the radii's difference
                      ///< [m].
  double largest{0};  ///< The largest depth that a joint of this kind and size has [m].
  double volume{0};   ///< The space that the two share [m^3].
  bool is_in_hole{false};  ///< Cylinders about one axis: a shaft in a hole that is smaller.
};

/** The error of two parts; null where they have none. */
[[nodiscard]] const DrawingError* FindDrawingError(const Product& product, OccurrenceId a,
                                                   OccurrenceId b);

}  // namespace hvas::product
