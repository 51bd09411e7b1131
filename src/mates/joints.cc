#include "mates/joints.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "mates/resolve.h"

namespace hvas::mates {
namespace {

using product::Joint;
using product::Mate;
using product::MateId;
using product::MateKind;
using product::OccurrenceId;
using product::Product;

constexpr double kSameRadius = 1e-6;  // [m]: the grid of a mate's key.
constexpr double kSameAxis = 20e-6;   // [m]: the limit of axis-hole mates (mates.md, section 1).
constexpr double kParallel = 2e-3;    // [rad]: a tenth of a degree, as in mates.md, section 1.

/** Axes in the part of the mate's first side. */
bool IsSamePattern(const Mate& a, const Mate& b) {
  const Vec3 axis_a = a.a.X_BM.q() * Vec3::UnitZ();
  const Vec3 axis_b = b.a.X_BM.q() * Vec3::UnitZ();
  return a.a.occurrence == b.a.occurrence &&
         std::abs(a.hole_radius - b.hole_radius) < kSameRadius &&
         std::abs(a.shaft_radius - b.shaft_radius) < kSameRadius &&
         axis_a.cross(axis_b).norm() < kParallel &&
         axis_a.cross(b.a.X_BM.p() - a.a.X_BM.p()).norm() > kSameAxis;
}

/** Size of the largest set of equal parallel axes; 0 where no two are equal. */
int CountPattern(const Product& product, const std::vector<MateId>& mates, WorkWatch* watch) {
  int most = 0;
  for (const MateId first : mates) {
    const Mate& mate = product.mates[first.index()];
    if (mate.kind != MateKind::kAxisHole || !MayGoOn(watch)) {
      continue;
    }
    const auto equal = std::count_if(mates.begin(), mates.end(), [&](MateId id) {
      const Mate& other = product.mates[id.index()];
      return id != first && other.kind == MateKind::kAxisHole && IsSamePattern(mate, other);
    });
    most = std::max(most, equal > 0 ? static_cast<int>(equal) + 1 : 0);
  }
  return most;
}

}  // namespace

void BuildJoints(Product* product, WorkWatch* watch) {
  std::map<std::pair<OccurrenceId, OccurrenceId>, std::vector<MateId>> pairs;
  for (const Mate& mate : product->mates) {
    pairs[std::minmax(mate.a.occurrence, mate.b.occurrence)].push_back(mate.id);
  }
  product->joints.clear();
  for (auto& [pair, mates] : pairs) {
    if (!MayGoOn(watch)) {
      return;
    }
    Joint joint;
    joint.a = pair.first;
    joint.b = pair.second;
    joint.pattern_count = CountPattern(*product, mates, watch);
    const Pose& X_WA = product->occurrences[joint.a.index()].X_WB;
    std::vector<MateConstraint> constraints;
    for (const MateId id : mates) {
      constraints.push_back(MakeConstraint(product->mates[id.index()], joint.b, X_WA));
    }
    const FreeTwists free = CalcFreeTwists(constraints, product->occurrences[joint.b.index()].X_WB);
    joint.free_translations = free.translations;
    joint.free_rotations = free.rotations;
    joint.mates = std::move(mates);
    product->joints.push_back(std::move(joint));
  }
}

}  // namespace hvas::mates
