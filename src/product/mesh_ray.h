#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "product/product.h"

namespace hvas::product {

/** Where a ray meets a part first. */
struct RayHit {
  double distance{0};         ///< Distance from the start of the ray [m].
  std::uint32_t triangle{0};  ///< Index in Part::mesh.
};

/** Whether a ray from `p` along `dir` meets the part within `reach` [m]. Triangles that the ray
 starts on do not count. */
[[nodiscard]] bool IsBlocked(const Part& part, const Vec3& p, const Vec3& dir, double reach);

/** Finds the first triangle that a ray from `p` along `dir` meets within `reach` [m]; none where it
 meets none. Triangles that the ray starts on do not count. */
[[nodiscard]] std::optional<RayHit> FindFirstHit(const Part& part, const Vec3& p, const Vec3& dir,
                                                 double reach);

/** Where a line enters a part or leaves it. */
struct Crossing {
  double distance{0};      ///< Distance from the start of the line [m].
  bool is_entering{true};  ///< True where the line goes into the material.
};

/** All crossings of a ray from `p` along `dir` within `reach` [m], the nearest first. One that an
 edge of two triangles is met at counts once. */
[[nodiscard]] std::vector<Crossing> ListCrossings(const Part& part, const Vec3& p, const Vec3& dir,
                                                  double reach);

}  // namespace hvas::product
