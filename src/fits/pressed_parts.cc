#include "fits/pressed_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hvas::fits {
namespace {

constexpr double kBulkModulus = 2e9;          // [Pa] of rubber: Gent, Engineering with Rubber.
constexpr double kStiffestRubberPad = 0.1e9;  // [Pa]: no rubber is stiffer. A choice.
constexpr double kMostGasketSqueeze =
    0.5;  // Share of the thickness; seals have up to 0.3. A choice.

double Cube(double x) noexcept {
  return x * x * x;
}

/** Torsion constant of a rectangle. */
double CalcTorsion(double side, double other) {
  const double a = 0.5 * std::max(side, other);
  const double b = 0.5 * std::min(side, other);
  const double share = b / a;
  return a * Cube(b) * (16.0 / 3.0 - 3.36 * share * (1 - share * share * share * share / 12));
}

double CalcWithin(const CoilSpring& spring, double s) noexcept {
  return CalcCoilStiffness(spring) * s;
}

double CalcWithin(const DiscSpring& disc, double s) noexcept {
  const double t = disc.thickness;
  const double h = disc.cone_height / t;
  const double d = s / t;
  return 4 * disc.modulus / (1 - disc.poisson * disc.poisson) * t * t * t * t /
         (CalcDiscShape(disc) * disc.outer * disc.outer) * d * ((h - d) * (h - 0.5 * d) + 1);
}

double CalcWithin(const LockWasher& washer, double s) noexcept {
  return CalcLockWasherStiffness(washer) * s;
}

double CalcWithin(const LeafSpring& leaf, double s) noexcept {
  return CalcLeafStiffness(leaf) * s;
}

double CalcWithin(const FlatGasket& gasket, double s) noexcept {
  const double l = 1 - s / gasket.thickness;
  return gasket.area * CalcPadModulus(gasket) / 3 * (1 / (l * l) - l);
}

double CalcWithin(const StatedSpring& spring, double s) noexcept {
  return spring.stiffness * s;
}

double CalcUnlimited(const PressedPart& part, double s) {
  return std::visit([s](const auto& p) { return CalcWithin(p, s); }, part);
}

/** Compression at which a part that rises all along has a force, by bisection up to `most`. */
double FindCompression(const PressedPart& part, double force, double most) {
  constexpr int kHalvings = 60;  // A double resolves no more.
  double low = 0;
  double high = most;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (CalcPressForce(part, middle) < force ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

bool RisesAllAlong(const PressedPart& part) {
  const auto* disc = std::get_if<DiscSpring>(&part);
  // The slope at h_0 is proportional to 1 - (h_0 / t)^2 / 2.
  return disc == nullptr || disc->cone_height <= std::numbers::sqrt2 * disc->thickness;
}

}  // namespace

double CalcCoilStiffness(const CoilSpring& spring) {
  const double d = spring.wire;
  return spring.shear_modulus * d * d * d * d / (8 * Cube(spring.diameter) * spring.active_coils);
}

double CalcDiscShape(const DiscSpring& disc) {
  const double k = disc.outer / disc.inner;
  const double share = (k - 1) / k;
  return share * share / (std::numbers::pi * ((k + 1) / (k - 1) - 2 / std::log(k)));
}

double CalcLockWasherStiffness(const LockWasher& washer) {
  const double width = 0.5 * (washer.outer - washer.inner);
  const double radius = 0.25 * (washer.outer + washer.inner);
  return washer.shear_modulus * CalcTorsion(width, washer.thickness) /
         (2 * std::numbers::pi * Cube(radius));
}

double CalcLeafStiffness(const LeafSpring& leaf) {
  return leaf.modulus * leaf.width * Cube(leaf.thickness) / (4 * Cube(leaf.length));
}

double LimitByBulk(double block) noexcept {
  return 1 / (1 / block + 1 / kBulkModulus);
}

double CalcPadModulus(const FlatGasket& gasket) noexcept {
  if (gasket.modulus > kStiffestRubberPad || !(gasket.free_area > 0)) {
    return gasket.modulus;
  }
  const double shape = gasket.area / gasket.free_area;
  return LimitByBulk(gasket.modulus * (1 + 2 * shape * shape));
}

double CalcPressForce(const PressedPart& part, double compression) {
  if (!(compression > 0)) {
    return 0;
  }
  const double most = FindMostPressed(part);
  if (compression <= most) {
    return CalcUnlimited(part, compression);
  }
  const double step = 1e-6 * most;  // For the slopes at both ends.
  const double slope = std::max(CalcUnlimited(part, most) - CalcUnlimited(part, most - step),
                                CalcUnlimited(part, step)) /
                       step;
  return CalcUnlimited(part, most) + slope * (compression - most);
}

double CalcPressRate(const PressedPart& part) {
  constexpr double kSmall = 1e-6;  // [m]: nothing is pressed by less. A choice.
  return CalcPressForce(part, kSmall) / kSmall;
}

double FindMostPressed(const PressedPart& part) noexcept {
  if (const auto* disc = std::get_if<DiscSpring>(&part)) {
    return disc->cone_height;
  }
  if (const auto* gasket = std::get_if<FlatGasket>(&part)) {
    return kMostGasketSqueeze * gasket->thickness;
  }
  return std::numeric_limits<double>::infinity();
}

std::string DescribeForce(const PressedPart& part) {
  struct Description {
    const char* operator()(const CoilSpring&) const { return "G d^4 / (8 D^3 n), Wahl"; }

    const char* operator()(const DiscSpring&) const { return "Almen and Laszlo, DIN 2092"; }

    const char* operator()(const LockWasher&) const {
      return "a turn of flat wire, G J / (2 pi r^3), Wahl";
    }

    const char* operator()(const LeafSpring&) const { return "cantilever, E b h^3 / (4 l^3)"; }

    const char* operator()(const FlatGasket& gasket) const {
      return gasket.modulus > kStiffestRubberPad ? "E A s / t of a sheet, Gent"
                                                 : "block of rubber, Gent and Lindley";
    }

    const char* operator()(const StatedSpring&) const { return "stated stiffness"; }
  };

  return std::visit(Description(), part);
}

std::vector<double> MakePressTable(std::span<const PressedPart> parts, double compression,
                                   int steps) {
  std::vector<double> table;
  if (parts.empty() ||
      (parts.size() > 1 && !std::all_of(parts.begin(), parts.end(), RisesAllAlong))) {
    return table;
  }
  const auto compress_all = [&](double force) {
    double sum = 0;
    for (const PressedPart& part : parts) {
      sum += FindCompression(part, force, compression);
    }
    return sum;
  };
  for (int i = 0; i <= steps; ++i) {
    const double s = compression * i / steps;
    if (parts.size() == 1) {
      table.push_back(CalcPressForce(parts.front(), s));
      continue;
    }
    // The stiffest of them alone would take more.
    double low = 0;
    double high = 0;
    for (const PressedPart& part : parts) {
      high = std::max(high, CalcPressForce(part, s));
    }
    constexpr int kHalvings = 60;  // A double resolves no more.
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (low + high);
      (compress_all(middle) < s ? low : high) = middle;
    }
    table.push_back(0.5 * (low + high));
  }
  return table;
}

}  // namespace hvas::fits
