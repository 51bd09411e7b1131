#include "cad/material.h"

namespace hvas::cad {

std::optional<double> NormaliseDensity(double value) {
  constexpr double kLowest = 400;     // Light wood.
  constexpr double kHighest = 23000;  // Osmium, rounded up.
  for (const double factor : {1.0, 1e3, 1e6, 1e9}) {
    const double density = value * factor;
    if (density >= kLowest && density <= kHighest) {
      return density;
    }
  }
  return std::nullopt;
}

}  // namespace hvas::cad
