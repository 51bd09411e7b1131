#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "product/product.h"
#include "record/reader.h"
#include "simulation/deformation.h"

namespace hvas::evidence {

/** How far a part gave, or was pressed together, while one was on its way. */
struct GivenPart {
  std::uint32_t occurrence{0};
  std::uint32_t moved{0};  ///< The part on its way: it, or another one.
  simulation::DeformationKind kind{simulation::DeformationKind::kBend};
  bool gets_smaller{false};  ///< A ring or tube: narrower, or flatter.
  double largest{0};         ///< [m]
};

/** Finds how far each part gave in a session, by the poses of its ticks; in the order in which the
 record has the parts. What gave by less than is drawn, and older records, have none. */
[[nodiscard]] Result<std::vector<GivenPart>> FindGivenParts(record::Reader* reader,
                                                            const record::Reader::Span& span,
                                                            const product::Product& product);

/** "bends by 0.90 mm" */
[[nodiscard]] std::string Describe(const GivenPart& part);

}  // namespace hvas::evidence
