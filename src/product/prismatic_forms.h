#pragma once

#include <vector>

#include "product/face_adjacency.h"
#include "product/product.h"
#include "product/recognition_limits.h"
#include "product/rings.h"

namespace hvas::product {

/** Marks the faces of a part that belong to forms. */
[[nodiscard]] std::vector<bool> MarkFaces(const Part& part, const std::vector<Form>& forms);

/** Slots: pairs of half cylinders between two flats, half a cylinder with flats that end in the
 open (a U), and channels: two facing flats with a floor between them, open at an end. */
[[nodiscard]] std::vector<Form> FindSlots(const Part& part, const FaceAdjacency& adjacency,
                                          const std::vector<Ring>& partials, double tolerance);

/** Pockets: floors with walls all around that are neither a hole's bottom nor a slot's.
 @param limits Gets the limits that were reached; so in FindSeats. */
[[nodiscard]] std::vector<Form> FindPockets(const Part& part, const FaceAdjacency& adjacency,
                                            const RingSet& set, const std::vector<Ring>& partials,
                                            const std::vector<Form>& slots,
                                            RecognitionLimits* limits);

/** Seats: planes of at least a fifth of the largest plane's area that have free space in front, as
 far as half their own size (the square root of their area); the 48 largest of them. */
[[nodiscard]] std::vector<Form> FindSeats(const Part& part, RecognitionLimits* limits);

}  // namespace hvas::product
