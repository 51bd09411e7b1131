#pragma once

#include <string>

#include "product/product.h"

namespace hvas::cad {

/** 32 hex digits of a part's mesh and surfaces, quantised to 10 nm; equal for equal geometry in the
 same frame. Names, colours and materials do not count. */
[[nodiscard]] std::string CalcShapeHash(const product::Part& part);

}  // namespace hvas::cad
