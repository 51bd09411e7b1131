#include "sequence/narrow_hole.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "sequence/way_directions.h"

namespace hvas::sequence {

namespace {

/** The lower end of a hole or shaft along a direction [m], from the origin of W. */
double CalcLowEnd(const product::Pose& X_WB, const product::Feature& feature,
                  const Vec3& direction) {
  const Vec3 axis_W = X_WB.q() * feature.axis_B;
  const double origin = direction.dot(X_WB * feature.origin_B);
  const double along = direction.dot(axis_W);
  return origin + std::min(along * feature.span_low, along * feature.span_high);
}

}  // namespace

std::string ExplainTooWide(const product::Product& product, product::OccurrenceId id,
                           product::OccurrenceId other, const Vec3& direction, double least) {
  constexpr double kCollinear = 20e-6;  // [m] between axes that count as one
  if (!other.is_valid()) {
    return {};
  }
  const product::Pose& X_WB = product.occurrences[id.index()].X_WB;
  const product::Pose& X_WO = product.occurrences[other.index()].X_WB;
  std::string text;
  double narrowest = 0;  // The narrowest place tells it best.
  for (const product::Feature& own : product.part_of(id).features) {
    const Vec3 axis_W = X_WB.q() * own.axis_B;
    if (std::abs(axis_W.dot(direction)) < 1 - kParallel) {
      continue;
    }
    for (const product::Feature& its : product.part_of(other).features) {
      const bool is_pair =
          (own.kind == product::FeatureKind::kShaft && its.kind == product::FeatureKind::kHole) ||
          (own.kind == product::FeatureKind::kHole && its.kind == product::FeatureKind::kShaft);
      const Vec3 between = X_WO * its.origin_B - X_WB * own.origin_B;
      const bool is_own_shaft = own.kind == product::FeatureKind::kShaft;
      const double excess = is_own_shaft ? own.radius - its.radius : its.radius - own.radius;
      if (!is_pair || excess < least - 1e-9 || between.cross(axis_W).norm() > kCollinear ||
          std::abs((X_WO.q() * its.axis_B).dot(axis_W)) < 1 - kParallel ||
          (narrowest > 0 && excess > narrowest)) {
        continue;
      }
      // What lies behind the part is not in its way.
      const double own_low = CalcLowEnd(X_WB, own, direction);
      const double its_high = -CalcLowEnd(X_WO, its, -direction);
      if (its_high < own_low + least) {
        continue;
      }
      narrowest = excess;
      const double own_mm = units::ToMm(2 * own.radius);
      const double its_mm = units::ToMm(2 * its.radius);
      text = is_own_shaft
                 ? fmt::format("its diameter of {:.3f} mm does not pass the hole of {:.3f} mm",
                               own_mm, its_mm)
                 : fmt::format("its hole of {:.3f} mm does not pass the diameter of {:.3f} mm",
                               own_mm, its_mm);
    }
  }
  return text;
}

}  // namespace hvas::sequence
