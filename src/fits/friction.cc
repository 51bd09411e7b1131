#include "fits/friction.h"

#include <array>
#include <cmath>

namespace hvas::fits {
namespace {

constexpr std::string_view kDin =
    "DIN 7190-1, 5.3, as quoted in FVA's help on interference fits: transverse fits";
constexpr std::string_view kTwoEnds = "quoted twice; the two ends of the range for dry joints";

// The standards state what holds a joint, and not how it starts to slide. Parts that are put
// together by hand are neither degreased nor oiled on purpose: static is the value for dry joints,
// kinetic the one with mineral oil where there is one; else the two ends of the range.
constexpr std::array<FrictionEntry, 4> kTable{{
    {FrictionSurface::kSteel, FrictionSurface::kSteel, 0.15, 0.12, kDin,
     "quoted twice; shrunk, and with mineral oil; an older edition has 0.14 for the former"},
    {FrictionSurface::kSteel, FrictionSurface::kCastIron, 0.16, 0.10, kDin,
     "quoted twice; degreased, and with mineral oil"},
    {FrictionSurface::kSteel, FrictionSurface::kLightMetal, 0.15, 0.10, kDin, kTwoEnds},
    {FrictionSurface::kSteel, FrictionSurface::kCopperAlloy, 0.25, 0.17, kDin, kTwoEnds},
}};

}  // namespace

double FrictionLaw::CalcCoefficient(double v) const noexcept {
  const double s = v / stribeck_speed;
  return kinetic_coefficient + (static_coefficient - kinetic_coefficient) * std::exp(-s * s) +
         viscous * v;
}

std::span<const FrictionEntry> FrictionTable() noexcept {
  return kTable;
}

FrictionLaw FindFriction(FrictionSurface a, FrictionSurface b,
                         const FrictionLaw& otherwise) noexcept {
  FrictionLaw law = otherwise;
  for (const FrictionEntry& entry : kTable) {
    if ((entry.a == a && entry.b == b) || (entry.a == b && entry.b == a)) {
      law.static_coefficient = entry.static_coefficient;
      law.kinetic_coefficient = entry.kinetic_coefficient;
      break;
    }
  }
  return law;
}

FrictionSurface SurfaceOf(std::string_view group) noexcept {
  const auto has = [group](std::string_view word) {
    return group.find(word) != std::string_view::npos;
  };
  if (has("steel")) {
    return FrictionSurface::kSteel;
  }
  if (has("iron")) {
    return FrictionSurface::kCastIron;
  }
  if (has("bronze") || has("brass") || has("copper")) {
    return FrictionSurface::kCopperAlloy;
  }
  if (has("aluminium") || has("magnesium")) {
    return FrictionSurface::kLightMetal;
  }
  return has("polymer") ? FrictionSurface::kPolymer : FrictionSurface::kUnknown;
}

}  // namespace hvas::fits
