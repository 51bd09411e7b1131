#include "sequence/bending_form.h"

#include <algorithm>
#include <limits>

#include "fits/elastic_parts.h"
#include "product/mesh_ray.h"
#include "spatial/pose.h"

namespace hvas::sequence {
namespace {

constexpr double kMostThickness = 1.0 / 3;  // Of the length; beams are slender: a choice.

double CalcExtentAlong(const product::Part& part, const Vec3& way_B) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vec3& vertex : part.mesh.vertices) {
    const double along = way_B.dot(vertex);
    low = std::min(low, along);
    high = std::max(high, along);
  }
  return std::max(0.0, high - low);
}

}  // namespace

std::optional<Bending> FindBending(const product::Product& product, product::OccurrenceId id,
                                   const Vec3& p_W, const Vec3& inward_W, const Vec3& way_W,
                                   double deflection) {
  const product::Part& part = product.part_of(id);
  const spatial::Pose X_BW = product.occurrences[id.index()].X_WB.Inverse();
  const double length = CalcExtentAlong(part, X_BW.q() * way_W);
  const Vec3 inward_B = X_BW.q() * inward_W;
  const Vec3 p_B = X_BW * p_W;
  const auto inner = product::FindFirstHit(part, p_B, inward_B, kMostThickness * length);
  if (!inner) {
    return std::nullopt;
  }
  // Where the point is in the material, what lies behind it counts, too.
  const auto outer = product::FindFirstHit(part, p_B, -inward_B, deflection);
  const double thickness = inner->distance + (outer ? outer->distance : 0.0);
  if (thickness > kMostThickness * length) {
    return std::nullopt;
  }
  const fits::SnapArm arm{length, 0, thickness, 0};
  return Bending{deflection / fits::CalcArmDeflection(arm, 1), length, thickness,
                 p_W + inner->distance * inward_W};
}

bool HasRoomToBend(const product::Product& product, product::OccurrenceId other,
                   const Vec3& p_back_W, const Vec3& inward_W, double deflection) {
  constexpr double kAround = 1.5;  // Of the deflection: what overlaps lies before the far side.
  const spatial::Pose X_BW = product.occurrences[other.index()].X_WB.Inverse();
  const Vec3 p_W = p_back_W - kAround * deflection * inward_W;
  return !product::IsBlocked(product.part_of(other), X_BW * p_W, X_BW.q() * inward_W,
                             2 * kAround * deflection);
}

}  // namespace hvas::sequence
