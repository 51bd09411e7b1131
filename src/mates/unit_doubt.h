#pragma once

#include "base/diagnostics.h"
#include "product/product.h"

namespace hvas::mates {

/** Warns ("unit-doubtful") where the fasteners of a product have diameters that no standard thread
 has, or others than their names state, and one wrong unit explains all of them: a file in
 millimetres that says inches, or metres. Nothing is scaled. */
void ReportDoubtfulUnit(const product::Product& product, Diagnostics* diagnostics);

}  // namespace hvas::mates
