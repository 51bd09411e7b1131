#pragma once

#include <vector>

#include "base/diagnostics.h"
#include "product/product.h"

namespace hvas::mates {

/** Faces of two occurrences that nearly touch, or lie inside each other. */
struct DrawnOddity {
  product::OccurrenceId a;
  product::OccurrenceId b;
  double gap{0};   ///< [m]; negative: drawn into each other.
  double area{0};  ///< Area of the faces' overlap [m^2].
};

/** Tells what is odd about the drawn pose. Nothing is moved to mend it.

 | code | what |
 |---|---|
 | no-mate | a part touches no other; with the nearest face, if one is near |
 | duplicate-part | parts of one shape lie at the very same place; told once, with their number |
 | drawn-interference | a shaft is larger than its hole, and it is no thread |
 | drawn-overlap | a face lies inside another part; equal parts are told once, with their number |

 @param original_of  As FindOriginals() has it. */
void ReportOddities(const product::Product& product, const std::vector<DrawnOddity>& oddities,
                    const std::vector<product::OccurrenceId>& original_of,
                    Diagnostics* diagnostics);

}  // namespace hvas::mates
