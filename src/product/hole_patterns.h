#pragma once

#include <vector>

#include "product/product.h"
#include "product/recognition_limits.h"

namespace hvas::product {

/** Patterns among the holes of `forms`: three or more of one kind, size and direction with their
 entries in one plane, evenly on a circle, in an evenly spaced row, or in a full grid. In this
 order: all of them on one circle, or in one grid; circles about the axis of another hole, shaft or
 boss (parts of an even circle too); circles about their own centre; equal circles beside each other
 that leave no hole over; rows. A square of four is a circle. A hole is in one pattern at most.
 @param tolerance Of positions; [m]. @param limits Gets the limits that were reached. */
[[nodiscard]] std::vector<Form> FindHolePatterns(const std::vector<Form>& forms, double tolerance,
                                                 RecognitionLimits* limits);

}  // namespace hvas::product
