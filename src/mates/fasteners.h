#pragma once

#include <vector>

#include "mates/propose_fit.h"
#include "product/product.h"

namespace hvas::mates {

/** Recognises it by its shape: six equal flats at 60 degrees around a cylinder. Around a hole: a
 nut, where no shaft of the part is on that axis. Around a shaft, outside it (a hexagon head) or as
 a socket: a screw.
 */
[[nodiscard]] FastenerKind ClassifyShape(const product::Part& part);

/** What each occurrence is, in their order: by the part's name, the occurrence's, or, where those
 say nothing ("SOLID"), that of the subassembly which holds it and no other solid part; else by its
 shape. */
[[nodiscard]] std::vector<FastenerKind> ClassifyOccurrences(const product::Product& product);

/** What a proposal for an axis-hole mate rests on, but for a nut elsewhere on the shaft.
 `fasteners` as ClassifyOccurrences gives them. */
[[nodiscard]] FitEvidence MakeFitEvidence(const product::Product& product,
                                          const product::Mate& mate,
                                          const std::vector<FastenerKind>& fasteners);

}  // namespace hvas::mates
