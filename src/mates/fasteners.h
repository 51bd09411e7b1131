#pragma once

#include <vector>

#include "mates/propose_fit.h"
#include "product/product.h"

namespace hvas::mates {

/** Recognises it by its shape. A nut has a thread in its bore (`MarkThreads`) and is a hexagon
 outside; a part with a hexagonal pocket, such as a holder for a nut, is none. A screw has a hexagon
 around a shaft, outside (its head) or as a socket that ends in it; a bore with six flats all along
 is a hub's. */
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
