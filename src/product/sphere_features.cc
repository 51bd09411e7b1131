#include "product/sphere_features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hvas::product {
namespace {

// Shares of the whole sphere (docs/algorithms/features.md, "Corner or ball"): an eighth is a
// corner.
constexpr double kLeastShare = 0.15;
constexpr double kCornerShare = 0.4;

bool IsMember(const Feature& feature, FaceId face) {
  return std::find(feature.faces.begin(), feature.faces.end(), face) != feature.faces.end();
}

/** Whether all of its border runs on into other faces: the rounding of a corner. */
bool IsBlend(const Feature& feature, const FaceAdjacency& adjacency) {
  double border = 0;
  double tangent = 0;
  for (const FaceId face : feature.faces) {
    for (const FaceNeighbour& neighbour : adjacency.neighbours(face)) {
      if (!IsMember(feature, neighbour.face)) {
        border += neighbour.length;
        tangent += neighbour.tangent;
      }
    }
  }
  return border > 0 && tangent > 0.9 * border;
}

}  // namespace

std::vector<Feature> FindSpheres(const Part& part, const FaceAdjacency& adjacency,
                                 double tolerance) {
  std::vector<Feature> groups;
  for (std::uint32_t i = 0; i < part.faces.size(); ++i) {
    const Face& face = part.faces[i];
    if (face.surface.kind != SurfaceKind::kSphere || face.triangle_count == 0) {
      continue;
    }
    const FeatureKind kind = face.surface.outward > 0 ? FeatureKind::kBall : FeatureKind::kSocket;
    const double slack = tolerance + face.residual;
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Feature& g) {
      return g.kind == kind && std::abs(g.radius - face.surface.radius) < slack &&
             (g.origin_B - face.surface.origin).norm() < slack;
    });
    if (group == groups.end()) {
      Feature feature;
      feature.kind = kind;
      feature.origin_B = face.surface.origin;
      feature.radius = face.surface.radius;
      groups.push_back(feature);
      group = std::prev(groups.end());
    }
    group->faces.emplace_back(i);
    group->area += face.area;
  }
  std::vector<Feature> found;
  for (Feature& group : groups) {
    const double share = group.area / (4 * std::numbers::pi * group.radius * group.radius);
    if (share < kLeastShare || (share < kCornerShare && IsBlend(group, adjacency))) {
      continue;
    }
    group.coverage = 2 * std::numbers::pi * std::min(share, 1.0);
    found.push_back(std::move(group));
  }
  return found;
}

}  // namespace hvas::product
