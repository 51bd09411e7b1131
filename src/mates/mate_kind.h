#pragma once

#include "product/mate.h"

/** What the kinds of mates ask of the frames M (placed) and N (held). Each function is a switch
 without a default, so that the compiler names it when a kind is added. */
namespace hvas::mates {

/** The z axes lie on each other and point the same way. */
[[nodiscard]] constexpr bool IsAxial(product::MateKind kind) noexcept {
  switch (kind) {
    case product::MateKind::kAxisHole:
    case product::MateKind::kConeSeat:
      return true;
    case product::MateKind::kFaceFace:
    case product::MateKind::kSphereSeat:
    case product::MateKind::kPrismatic:
      return false;
  }
  return false;
}

/** The origins agree, and turning is free: balls. */
[[nodiscard]] constexpr bool IsCentre(product::MateKind kind) noexcept {
  switch (kind) {
    case product::MateKind::kSphereSeat:
      return true;
    case product::MateKind::kAxisHole:
    case product::MateKind::kFaceFace:
    case product::MateKind::kConeSeat:
    case product::MateKind::kPrismatic:
      return false;
  }
  return false;
}

/** The z axes have a given direction to each other: all but balls. */
[[nodiscard]] constexpr bool HoldsDirection(product::MateKind kind) noexcept {
  return !IsCentre(kind);
}

/** The origins agree across z: all but planes and what is between walls. */
[[nodiscard]] constexpr bool HoldsAcross(product::MateKind kind) noexcept {
  switch (kind) {
    case product::MateKind::kAxisHole:
    case product::MateKind::kConeSeat:
    case product::MateKind::kSphereSeat:
      return true;
    case product::MateKind::kFaceFace:
    case product::MateKind::kPrismatic:
      return false;
  }
  return false;
}

/** The origins agree along z: all but shafts in holes. */
[[nodiscard]] constexpr bool HoldsAlong(product::MateKind kind) noexcept {
  switch (kind) {
    case product::MateKind::kFaceFace:
    case product::MateKind::kConeSeat:
    case product::MateKind::kSphereSeat:
    case product::MateKind::kPrismatic:
      return true;
    case product::MateKind::kAxisHole:
      return false;
  }
  return false;
}

/** One side slides into the other, by a fit that says how tightly: shafts in holes, tongues in
 slots. */
[[nodiscard]] constexpr bool HasFit(product::MateKind kind) noexcept {
  switch (kind) {
    case product::MateKind::kAxisHole:
    case product::MateKind::kPrismatic:
      return true;
    case product::MateKind::kFaceFace:
    case product::MateKind::kConeSeat:
    case product::MateKind::kSphereSeat:
      return false;
  }
  return false;
}

}  // namespace hvas::mates
