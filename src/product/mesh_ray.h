#pragma once

#include "product/product.h"

namespace hvas::product {

/** Whether a ray from `p` along `dir` meets the part within `reach` [m]. Triangles that the ray
 starts on do not count. */
[[nodiscard]] bool IsBlocked(const Part& part, const Vec3& p, const Vec3& dir, double reach);

}  // namespace hvas::product
