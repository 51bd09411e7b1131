#pragma once

#include "base/work_watch.h"
#include "product/product.h"

namespace hvas::mates {

/** Sets the fits of axis-hole mates whose faces have dimensions with a fit (Dimension::fit): a
 whole one on either side ("H7/g6"), or a hole class on the hole ("G6") and a shaft class on the
 shaft. Its reason names the entities of the file; the nominal diameter is the stated one. A class
 on one side only says nothing about the other, and leaves the mate as it is, as do sizes which ISO
 286 has no such fit for, or none with the interference that is drawn. Ends early when the watch
 says so. @returns how many mates got a fit. */
int AssignStatedFits(product::Product* product, WorkWatch* watch = nullptr);

}  // namespace hvas::mates
