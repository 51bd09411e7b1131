#include "fits/elastic_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fits/pressed_parts.h"

namespace hvas::fits {
namespace {

// Bayer, Snap-Fit Joints for Plastics, table 1: a rectangular section, and one that tapers to half.
constexpr double kConstantSection = 0.67;
constexpr double kTaperedSection = 1.09;
// Share of the section up to which the formula is used; glands squeeze by 10 to 30 %. A choice.
constexpr double kMostSqueeze = 0.5;

double ShapeOf(const SnapArm& arm) {
  return arm.is_tapered ? kTaperedSection : kConstantSection;
}

double RiseOfSqueeze(const ORing& ring, double share) {
  return std::numbers::pi * ring.diameter * ring.modulus *
         (1.25 * 1.5 * std::sqrt(share) + 50 * 6 * std::pow(share, 5));
}

}  // namespace

double CalcArmDeflection(const SnapArm& arm, double strain) {
  return ShapeOf(arm) * strain * arm.length * arm.length / arm.thickness;
}

double CalcArmStiffness(const SnapArm& arm) {
  const double h = arm.thickness;
  const double l = arm.length;
  return arm.width * h * h * h * arm.modulus / (6 * ShapeOf(arm) * l * l * l);
}

double CalcSlidingRatio(double friction, double slope) {
  const double rest = 1 - friction * slope;
  return rest > 0 ? (friction + slope) / rest : std::numeric_limits<double>::infinity();
}

double CalcSqueezeForce(const ORing& ring, double squeeze) noexcept {
  const double share = std::clamp(squeeze / ring.section, 0.0, kMostSqueeze);
  const double beyond = std::max(0.0, squeeze - kMostSqueeze * ring.section);
  return std::numbers::pi * ring.diameter * ring.section * ring.modulus *
             (1.25 * std::pow(share, 1.5) + 50 * std::pow(share, 6)) +
         beyond * RiseOfSqueeze(ring, kMostSqueeze);
}

double CalcSqueezeStiffness(const ORing& ring, double squeeze) noexcept {
  return RiseOfSqueeze(ring, std::clamp(squeeze / ring.section, 0.0, kMostSqueeze));
}

double CalcStretchStiffness(const ORing& ring) {
  const double area = 0.25 * std::numbers::pi * ring.section * ring.section;
  return 2 * std::numbers::pi * ring.modulus * area / (0.5 * ring.diameter);
}

double CalcSpreadStiffness(const OpenRing& ring) {
  const double inertia = ring.thickness * ring.width * ring.width * ring.width / 12;
  return 4 * std::numbers::pi * ring.modulus * inertia /
         (3 * ring.radius * ring.radius * ring.radius);
}

double CalcSlitPinForce(const SlitPin& pin, double squeeze) {
  const double radius = 0.5 * (pin.diameter - pin.wall);
  const double elastic =
      CalcSpreadStiffness({radius, pin.wall, pin.length, pin.modulus}) * std::max(0.0, squeeze);
  const double plastic =
      std::numbers::pi * pin.yield * pin.length * pin.wall * pin.wall / (4 * radius);
  return std::min(elastic, plastic);
}

double CalcSleeveHoopStiffness(const RubberSleeve& sleeve) {
  const double wall = sleeve.outer_radius - sleeve.inner_radius;
  const double radius = 0.5 * (sleeve.outer_radius + sleeve.inner_radius);
  return 2 * std::numbers::pi * sleeve.modulus * sleeve.length * wall / radius;
}

double CalcSleeveStiffness(const RubberSleeve& sleeve) {
  const double wall = sleeve.outer_radius - sleeve.inner_radius;
  const double shape = sleeve.length / (2 * wall);
  const double block = 4.0 / 3.0 * sleeve.modulus * (1 + shape * shape);
  const double area =
      std::numbers::pi * (sleeve.outer_radius + sleeve.inner_radius) * sleeve.length;
  return LimitByBulk(block) * area / wall;
}

double CalcSleeveShearStiffness(const RubberSleeve& sleeve) {
  return 2 * std::numbers::pi * sleeve.modulus / 3 * sleeve.length /
         std::log(sleeve.outer_radius / sleeve.inner_radius);
}

double CalcLipStiffness(const SealLip& lip) {
  constexpr double kPoisson = 0.5;  // Rubber keeps its volume.
  const double t = lip.thickness;
  const double r = lip.radius;
  const double foundation = lip.modulus * t / (r * r);
  const double bending = lip.modulus * t * t * t / (12 * (1 - kPoisson * kPoisson));
  const double beta = std::pow(foundation / (4 * bending), 0.25);
  const double x = beta * lip.length;
  constexpr double kLong = 20;  // Beyond, the root is not felt: the ratio is 1 to rounding.
  const double ratio = x > kLong ? 1
                                 : (std::pow(std::cosh(x), 2) + std::pow(std::cos(x), 2)) /
                                       (std::sinh(x) * std::cosh(x) - std::sin(x) * std::cos(x));
  return 2 * std::numbers::pi * r * foundation / (2 * beta) * ratio;
}

}  // namespace hvas::fits
