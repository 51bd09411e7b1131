#pragma once

#include "product/product.h"

/** What the kinds of mates ask of the frames M (placed) and N (held). */
namespace hvas::mates {

/** The z axes lie on each other and point the same way. */
[[nodiscard]] constexpr bool IsAxial(product::MateKind kind) noexcept {
  return kind == product::MateKind::kAxisHole || kind == product::MateKind::kConeSeat;
}

/** The z axes have a given direction to each other: all but sphere seats. */
[[nodiscard]] constexpr bool HoldsDirection(product::MateKind kind) noexcept {
  return kind != product::MateKind::kSphereSeat;
}

/** The origins agree across z: all but planes. */
[[nodiscard]] constexpr bool HoldsAcross(product::MateKind kind) noexcept {
  return kind != product::MateKind::kFaceFace;
}

/** The origins agree along z: all but shafts in holes. */
[[nodiscard]] constexpr bool HoldsAlong(product::MateKind kind) noexcept {
  return kind != product::MateKind::kAxisHole;
}

}  // namespace hvas::mates
