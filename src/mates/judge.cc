#include "mates/judge.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/mate_kind.h"

namespace hvas::mates {
namespace {

using product::Connector;
using product::Feature;
using product::Mate;
using product::MateKind;
using product::Product;
using units::ToMm;
using units::ToUm;

const Feature& FeatureOf(const Product& product, const Connector& connector) {
  return product.part_of(connector.occurrence).features[connector.feature.index()];
}

/** Of the plane of b from that of a; positive: a gap. */
double CalcGap(const Product& product, const Mate& mate) {
  const Feature& feature = FeatureOf(product, mate.b);
  return feature.axis_B.dot(mate.b.X_BM.p() - feature.origin_B);
}

/** Between two cones, normal to them; positive: a gap. */
double CalcConeGap(const Product& product, const Mate& mate) {
  return (mate.hole_radius - mate.shaft_radius) * std::cos(FeatureOf(product, mate.a).half_angle);
}

/** What a prismatic mate is made of: its walls are as sure as faces with their mean gap. */
double CalcWallGap(const Mate& mate) {
  return mate.hole_radius - mate.shaft_radius;
}

double CalcSmallerArea(const Product& product, const Mate& mate) {
  return std::min(FeatureOf(product, mate.a).area, FeatureOf(product, mate.b).area);
}

double CalcScale(const Product& product, const Mate& mate) {
  const auto size = [&product](const Connector& connector) {
    const spatial::Box& box = product.part_of(connector.occurrence).box_B;
    return box.is_empty() ? 0.0 : box.size().norm();
  };
  return CalcLengthScale(std::min(size(mate.a), size(mate.b)));
}

/** Planes that do not touch are the walls of a slot, or the sides of what is in it. */
bool IsTouching(const Product& product, const Mate& mate, const InferenceLimits& limits) {
  return std::abs(CalcGap(product, mate)) < limits.plane_gap * CalcScale(product, mate);
}

/** What is printed as zero has no sign. */
double DropSignOfZero(double value, double half_of_last_digit) {
  return std::abs(value) < half_of_last_digit ? 0.0 : value;
}

/** From 1 at zero to `least` at the limit and beyond. */
double CalcFalling(double value, double limit, double least) {
  return 1 - (1 - least) * std::clamp(value / limit, 0.0, 1.0);
}

/** From `least` at zero to 1 at `enough` and beyond. */
double CalcRising(double value, double enough, double least) {
  return enough > 0 ? 1 - CalcFalling(value, enough, least) + least : 1.0;
}

/** Screws hold nothing inside themselves, and nuts do not turn on nuts. */
bool ContradictsNames(FastenerKind hole_part, FastenerKind shaft_part) {
  return hole_part == FastenerKind::kScrew ||
         (hole_part == FastenerKind::kNut && shaft_part == FastenerKind::kNut);
}

double CalcAxisConfidence(const Product& product, const Mate& mate, const InferenceLimits& limits,
                          FastenerKind hole_part, FastenerKind shaft_part) {
  const double scale = CalcScale(product, mate);
  const double play = std::abs(mate.hole_radius - mate.shaft_radius);
  const double most = CalcLargestPlay(limits, scale, std::min(mate.hole_radius, mate.shaft_radius));
  double sizes = CalcFalling(play, most, 0.5);
  if (shaft_part == FastenerKind::kScrew && !ContradictsNames(hole_part, shaft_part)) {
    sizes = std::max(sizes, 0.9);  // Screws have play in their holes, or threads drawn anyhow.
  }
  // A diameter is enough, or all of a short ring, but not of less than a quarter of a diameter.
  const double shorter = std::min(mate.hole_high - mate.hole_low, mate.shaft_high - mate.shaft_low);
  const double diameter = 2 * mate.shaft_radius;
  const double length =
      CalcRising(mate.overlap, std::clamp(shorter, 0.25 * diameter, diameter), 0.5);
  const double place = CalcFalling(CalcOffset(product, mate), limits.axis_distance * scale, 0.8);
  const double turn =
      CalcRising(std::min(FeatureOf(product, mate.a).coverage, FeatureOf(product, mate.b).coverage),
                 limits.coverage, 0.7);
  const double names = ContradictsNames(hole_part, shaft_part) ? 0.6 : 1.0;
  return sizes * length * place * turn * names;
}

double CalcConfidence(const Product& product, const Mate& mate, const InferenceLimits& limits,
                      FastenerKind part_a, FastenerKind part_b) {
  const double scale = CalcScale(product, mate);
  switch (mate.kind) {
    case MateKind::kAxisHole:
      return CalcAxisConfidence(product, mate, limits, part_a, part_b);
    case MateKind::kFaceFace:
      return CalcRising(mate.overlap, 0.25 * CalcSmallerArea(product, mate), 0.5) *
             (IsTouching(product, mate, limits)
                  ? CalcFalling(std::abs(CalcGap(product, mate)), limits.plane_gap * scale, 0.7)
                  : CalcFalling(std::abs(CalcGap(product, mate)), limits.wall_gap * scale, 0.5));
    case MateKind::kConeSeat: {
      const double tilt =
          std::abs(FeatureOf(product, mate.a).half_angle - FeatureOf(product, mate.b).half_angle);
      return CalcFalling(tilt, limits.cone_angle, 0.7) *
             CalcFalling(std::abs(CalcConeGap(product, mate)), limits.cone_gap * scale, 0.5) *
             CalcRising(mate.overlap, 0.25 * mate.shaft_radius, 0.5) *
             CalcFalling(CalcOffset(product, mate), limits.axis_distance * scale, 0.8);
    }
    case MateKind::kSphereSeat: {
      const double play = std::abs(mate.hole_radius - mate.shaft_radius);
      const double most =
          CalcLargestPlay(limits, scale, std::min(mate.hole_radius, mate.shaft_radius));
      return CalcFalling(play, most, 0.5) *
             CalcRising(mate.overlap, std::numbers::pi * mate.shaft_radius * mate.shaft_radius,
                        0.5) *
             CalcFalling(CalcOffset(product, mate), limits.axis_distance * scale, 0.8);
    }
    case MateKind::kPrismatic:
      return CalcRising(mate.overlap * mate.breadth, 0.25 * CalcSmallerArea(product, mate), 0.5) *
             CalcFalling(std::abs(CalcWallGap(mate)), limits.wall_gap * scale, 0.5);
  }
  return 0;
}

}  // namespace

double CalcOffset(const Product& product, const Mate& mate) {
  const Feature& feature = FeatureOf(product, mate.b);
  const Vec3 d = mate.b.X_BM.p() - feature.origin_B;
  return IsCentre(mate.kind) ? d.norm() : feature.axis_B.cross(d).norm();
}

std::string DescribeEvidence(const Product& product, const Mate& mate) {
  const Feature& a = FeatureOf(product, mate.a);
  const Feature& b = FeatureOf(product, mate.b);
  switch (mate.kind) {
    case MateKind::kAxisHole:
      return fmt::format("radii {:.3f}/{:.3f} mm, engaged {:.2f} mm, axes {:.2f} um apart",
                         ToMm(mate.hole_radius), ToMm(mate.shaft_radius), ToMm(mate.overlap),
                         ToUm(CalcOffset(product, mate)));
    case MateKind::kFaceFace: {
      const double smaller = CalcSmallerArea(product, mate);
      const double share = smaller > 0 ? std::min(1.0, mate.overlap / smaller) : 0.0;
      return fmt::format("{} {:.2f} mm2, {:.0f} % of the smaller face, {:.2f} um apart",
                         IsTouching(product, mate, {}) ? "touching" : "between walls, facing",
                         1e6 * mate.overlap, 100 * share,
                         DropSignOfZero(ToUm(CalcGap(product, mate)), 0.005));
    }
    case MateKind::kConeSeat:
      return fmt::format(
          "half angles {:.2f}/{:.2f} deg, facing over {:.2f} mm, {:.3f} mm apart, axes {:.2f} um "
          "apart",
          units::ToDeg(a.half_angle), units::ToDeg(b.half_angle), ToMm(mate.overlap),
          DropSignOfZero(ToMm(CalcConeGap(product, mate)), 0.0005),
          ToUm(CalcOffset(product, mate)));
    case MateKind::kSphereSeat: {
      const double whole = 4 * std::numbers::pi * mate.shaft_radius * mate.shaft_radius;
      return fmt::format(
          "radii {:.3f}/{:.3f} mm, facing {:.0f} % of the ball, centres {:.2f} um "
          "apart",
          ToMm(mate.hole_radius), ToMm(mate.shaft_radius),
          whole > 0 ? 100 * mate.overlap / whole : 0.0, ToUm(CalcOffset(product, mate)));
    }
    case MateKind::kPrismatic:
      return fmt::format("widths {:.3f}/{:.3f} mm, engaged {:.2f} mm by {:.2f} mm",
                         ToMm(2 * mate.hole_radius), ToMm(2 * mate.shaft_radius),
                         ToMm(mate.overlap), ToMm(mate.breadth));
  }
  return {};
}

void Judge(const Product& product, const InferenceLimits& limits, FastenerKind part_a,
           FastenerKind part_b, Mate* mate) {
  mate->evidence = DescribeEvidence(product, *mate);
  if (mate->kind == MateKind::kAxisHole && ContradictsNames(part_a, part_b)) {
    mate->evidence += ", contradicts the names";
  }
  mate->confidence = std::clamp(CalcConfidence(product, *mate, limits, part_a, part_b), 0.0, 1.0);
}

}  // namespace hvas::mates
