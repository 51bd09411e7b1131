#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/work_watch.h"
#include "mates/drawn_volumes.h"
#include "product/product.h"

/** Overlaps that no joint explains (docs/algorithms/overlaps.md#errors-of-the-drawing). */
namespace hvas::mates {

/** The largest depth by which a shaft and its hole may lie in one another as drawn, in the radius
 [m]: of a thread or an insert 0.3 of the shaft's radius, of a press fit half of what ISO 286 has
 for the size (fits::CalcLargestPress), and what gives of the two parts. */
[[nodiscard]] double CalcLargestDepth(const product::Product& product, const product::Mate& mate);

/** The largest depth by which two faces may lie in one another as drawn [m]: of a shaft in a hole
 as above; else the largest interference of a fit (fits::CalcLargestInterference) for the width of
 the smaller part along the contact, or what gives of the two parts. */
[[nodiscard]] double CalcLargestDepth(const product::Product& product, const SharedVolume& shared,
                                      const FaceOverlap& faces);

/** The largest depth that a pair may have where it lies deepest in one another [m]. */
[[nodiscard]] double CalcLargestDepth(const product::Product& product, product::OccurrenceId a,
                                      product::OccurrenceId b);

/** Whether a mate's shaft is drawn larger than its hole by more than any joint has, so that it is
 none. */
[[nodiscard]] bool IsBeyondAnyFit(const product::Product& product, const product::Mate& mate);

/** Lists the errors of the drawing, the largest volume first; pairs of parts that lie in one
 another by more than CalcLargestDepth() and the 50 um of faces that touch. Incomplete when the
 watch ends it. @param product  Its mates are found, and its parts that give. */
[[nodiscard]] std::vector<product::DrawingError> ListDrawingErrors(const product::Product& product,
                                                                   WorkWatch* watch = nullptr);

/** Describes an error from the side of its smaller part: "28.575 mm in a hole of 25.4 mm of plate:
 1.588 mm deep, 863 mm3; no fit of this size has more than 0.635 mm". */
[[nodiscard]] std::string DescribeDrawingError(const product::Product& product,
                                               const product::DrawingError& error);

/** The part of an error that is left out where only one can be in its place: the smaller one, of
 equal ones the second. */
[[nodiscard]] product::OccurrenceId SmallerOf(const product::Product& product,
                                              const product::DrawingError& error);

/** Warns of each error ("drawing-error"), of equal ones of the same two parts once, with their
 number. */
void ReportDrawingErrors(const product::Product& product, Diagnostics* diagnostics);

}  // namespace hvas::mates
