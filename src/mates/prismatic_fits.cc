#include "mates/prismatic_fits.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mates/propose_fit.h"

namespace hvas::mates {
namespace {

using product::Mate;
using product::OccurrenceId;

constexpr double kParallel = 1 - 1e-6;  // Cosine: the 0.1 deg of the mates themselves.

/** One mated face of each part of a pair, in the world. */
struct WallPair {
  const Mate* mate{nullptr};
  Vec3 normal_W;  // Of the face of the first part, out of its material.
  Vec3 p_W;       // A point of the first part's face.
  Vec3 q_W;       // A point of the second part's face.
};

Vec3 PointOf(const product::Product& product, const product::Connector& side) {
  const product::Feature& feature = product.part_of(side.occurrence).features[side.feature.index()];
  return product.occurrences[side.occurrence.index()].X_WB * feature.origin_B;
}

WallPair MakeWallPair(const product::Product& product, const Mate& mate, OccurrenceId first) {
  const product::Connector& own = mate.a.occurrence == first ? mate.a : mate.b;
  const product::Connector& other = mate.a.occurrence == first ? mate.b : mate.a;
  const Pose& X_WB = product.occurrences[first.index()].X_WB;
  return {&mate, X_WB.q() * (own.X_BM.q() * Vec3::UnitZ()), PointOf(product, own),
          PointOf(product, other)};
}

product::Fit ProposeWidth(double outer, double inner) {
  FitEvidence evidence;
  evidence.hole_radius = 0.5 * outer;
  evidence.shaft_radius = 0.5 * inner;
  // A width is no diameter of a thread, however far the drawn faces overlap.
  product::Fit fit = ProposeFit(evidence);
  if (fit.kind == product::FitKind::kThread) {
    fit.kind = product::FitKind::kInterference;
    fit.code.clear();
    fit.reason = "the drawn faces overlap by more than a press fit has";
  }
  fit.nominal_diameter = outer;
  return fit;
}

PrismaticFit MakeFit(const WallPair& low, const WallPair& high, OccurrenceId first,
                     OccurrenceId second) {
  const double own = (high.p_W - low.p_W).dot(low.normal_W);
  const double other = (high.q_W - low.q_W).dot(low.normal_W);
  PrismaticFit fit;
  // Walls of a slot face each other: the normal of each points to the other one.
  const bool is_first_outer = own > 0;
  fit.outer = is_first_outer ? first : second;
  fit.inner = is_first_outer ? second : first;
  fit.across_W = is_first_outer ? low.normal_W : Vec3(-low.normal_W);
  fit.low = low.mate->id;
  fit.high = high.mate->id;
  fit.outer_width = std::abs(is_first_outer ? own : other);
  fit.inner_width = std::abs(is_first_outer ? other : own);
  fit.engaged = std::min(low.mate->overlap, high.mate->overlap);
  fit.fit = ProposeWidth(fit.outer_width, fit.inner_width);
  return fit;
}

void AddFits(const std::vector<WallPair>& walls, OccurrenceId first, OccurrenceId second,
             std::vector<PrismaticFit>* fits) {
  const auto find_opposite = [&walls](const WallPair& wall) {
    const WallPair* nearest = nullptr;
    double least = 0;
    for (const WallPair& other : walls) {
      const double width = std::abs((other.p_W - wall.p_W).dot(wall.normal_W));
      if (wall.normal_W.dot(other.normal_W) < -kParallel && width > 0 &&
          (nearest == nullptr || width < least)) {
        nearest = &other;
        least = width;
      }
    }
    return nearest;
  };
  for (const WallPair& wall : walls) {
    const WallPair* opposite = find_opposite(wall);
    // Each pair once, where each is the nearest of the other.
    if (opposite != nullptr && wall.mate->id < opposite->mate->id &&
        find_opposite(*opposite) == &wall) {
      const PrismaticFit fit = MakeFit(wall, *opposite, first, second);
      // Both parts have their material on the same side of a lap: that is no slot.
      const double own = (opposite->p_W - wall.p_W).dot(wall.normal_W);
      const double other = (opposite->q_W - wall.q_W).dot(wall.normal_W);
      if (own * other > 0) {
        fits->push_back(fit);
      }
    }
  }
}

}  // namespace

std::vector<PrismaticFit> FindPrismaticFits(const product::Product& product) {
  std::map<std::pair<OccurrenceId, OccurrenceId>, std::vector<WallPair>> walls;
  for (const Mate& mate : product.mates) {
    if (mate.kind == product::MateKind::kFaceFace) {
      const auto [first, second] = std::minmax(mate.a.occurrence, mate.b.occurrence);
      walls[{first, second}].push_back(MakeWallPair(product, mate, first));
    }
  }
  std::vector<PrismaticFit> fits;
  for (const auto& [pair, of_pair] : walls) {
    AddFits(of_pair, pair.first, pair.second, &fits);
  }
  return fits;
}

}  // namespace hvas::mates
