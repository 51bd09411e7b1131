#include "product/enclosure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "product/mesh_ray.h"
#include "spatial/box_pairs.h"

namespace hvas::product {
namespace {

constexpr std::size_t kMostSamples = 60;     // Points of a part that rays begin at: a choice.
constexpr std::size_t kMostDirections = 60;  // that a part is tried to go along: a choice.
constexpr double kSameWay = 1e-3;            // [rad]: what exports err by. A choice.
constexpr double kSmaller = 0.98;  // Part of the outer box that an inner one may have: a choice.

/** Points of a part, in W: its centre of mass, and vertices and centres of triangles all over. */
std::vector<Vec3> ListSamples(const Product& product, OccurrenceId id) {
  const Part& part = product.part_of(id);
  const Pose& X_WB = product.occurrences[id.index()].X_WB;
  const std::vector<Vec3>& vertices = part.mesh.vertices;
  std::vector<Vec3> samples{X_WB *
                            (part.mass.volume > 0 ? part.mass.p_BoBcm_B : part.box_B.centre())};
  const std::size_t count = part.mesh.triangles.size();
  const std::size_t step = 1 + 2 * count / kMostSamples;
  for (std::size_t t = 0; t < count; t += step) {
    const auto& [a, b, c] = part.mesh.triangles[t];
    samples.push_back(X_WB * vertices[a]);
    samples.push_back(X_WB * Vec3((vertices[a] + vertices[b] + vertices[c]) / 3));
  }
  return samples;
}

bool IsBlockedBy(const Product& product, OccurrenceId other, const Vec3& p_W, const Vec3& dir_W) {
  const Pose X_BW = product.occurrences[other.index()].X_WB.Inverse();
  const Part& part = product.part_of(other);
  const double reach = 10 * part.box_B.size().norm() + (X_BW * p_W - part.box_B.centre()).norm();
  return IsBlocked(part, X_BW * p_W, X_BW.q() * dir_W, reach);
}

/** The directions to the faces, edges and corners of a cube. */
std::vector<Vec3> ListCubeDirections() {
  std::vector<Vec3> directions;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x != 0 || y != 0 || z != 0) {
          directions.push_back(Vec3(x, y, z).normalized());
        }
      }
    }
  }
  return directions;
}

void AddDirection(const Vec3& direction, std::vector<Vec3>* directions) {
  for (const Vec3& known : *directions) {
    if ((known - direction).norm() < kSameWay) {
      return;
    }
  }
  directions->push_back(direction);
}

void AddAxes(const Product& product, OccurrenceId id, std::vector<Vec3>* directions) {
  for (const Feature& feature : product.part_of(id).features) {
    if (directions->size() + 2 > kMostDirections) {
      return;
    }
    const Vec3 axis_W = product.occurrences[id.index()].X_WB.q() * feature.axis_B;
    AddDirection(axis_W, directions);
    AddDirection(-axis_W, directions);
  }
}

/** Whether all ways from these points meet a part, most of them from outside its material: what is
 drawn into the material overlaps, and is not enclosed. */
bool IsInCavity(const Product& product, const std::vector<Vec3>& samples,
                const std::vector<Vec3>& directions, OccurrenceId other) {
  constexpr double kMostFromInside = 0.2;  // Samples that touch the wall look through it: a choice.
  const Pose X_BW = product.occurrences[other.index()].X_WB.Inverse();
  const Part& part = product.part_of(other);
  std::size_t from_inside = 0;
  for (const Vec3& p_W : samples) {
    const Vec3 p_B = X_BW * p_W;
    const double reach = 10 * part.box_B.size().norm() + (p_B - part.box_B.centre()).norm();
    for (const Vec3& dir_W : directions) {
      const Vec3 dir_B = X_BW.q() * dir_W;
      const auto hit = FindFirstHit(part, p_B, dir_B, reach);
      if (!hit) {
        return false;
      }
      const auto& [a, b, c] = part.mesh.triangles[hit->triangle];
      const std::vector<Vec3>& vertices = part.mesh.vertices;
      const Vec3 normal = (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
      from_inside += normal.dot(dir_B) > 0 ? 1 : 0;
    }
  }
  return static_cast<double>(from_inside) <=
         kMostFromInside * static_cast<double>(samples.size() * directions.size());
}

bool IsInside(const Box& inner, const Box& outer) {
  return !inner.is_empty() && !outer.is_empty() && outer.Contains(inner.low) &&
         outer.Contains(inner.high);
}

}  // namespace

std::vector<std::pair<OccurrenceId, OccurrenceId>> FindEnclosed(const Product& product,
                                                                WorkWatch* watch) {
  std::vector<Box> boxes;
  for (const Occurrence& occurrence : product.occurrences) {
    boxes.push_back(spatial::Transform(occurrence.X_WB, product.part_of(occurrence.id).box_B));
  }
  std::vector<OccurrenceId> around(boxes.size());  // The smallest part with a cavity around each.
  const std::vector<Vec3> directions = ListCubeDirections();
  std::vector<Vec3> samples;  // Of the part `sampled`.
  OccurrenceId sampled;
  spatial::ForEachPair(boxes, boxes, 0, watch, [&](std::size_t i, std::size_t k) {
    const OccurrenceId best = around[i];
    const bool may_hold =
        i != k && IsInside(boxes[i], boxes[k]) &&
        boxes[i].size().norm() < kSmaller * boxes[k].size().norm() &&
        product.parts[product.occurrences[k].part.index()].mass.volume > 0 &&
        (!best.is_valid() || boxes[k].size().norm() < boxes[best.index()].size().norm());
    if (!may_hold) {
      return true;
    }
    if (sampled != OccurrenceId(i)) {
      sampled = OccurrenceId(i);
      samples = ListSamples(product, sampled);
    }
    if (IsInCavity(product, samples, directions, OccurrenceId(k))) {
      around[i] = OccurrenceId(k);
    }
    return true;
  });
  std::vector<std::pair<OccurrenceId, OccurrenceId>> found;
  for (std::size_t i = 0; i < around.size(); ++i) {
    if (around[i].is_valid()) {
      found.emplace_back(OccurrenceId(i), around[i]);
    }
  }
  return found;
}

bool HasStraightWayOut(const Product& product, OccurrenceId id,
                       const std::vector<OccurrenceId>& others, WorkWatch* watch) {
  std::vector<Vec3> directions = ListCubeDirections();
  AddAxes(product, id, &directions);
  for (const OccurrenceId other : others) {
    AddAxes(product, other, &directions);
  }
  const std::vector<Vec3> samples = ListSamples(product, id);
  const std::size_t most_blocked = samples.size() / 20;
  return std::any_of(directions.begin(), directions.end(), [&](const Vec3& dir_W) {
    std::size_t blocked = 0;
    for (const Vec3& p_W : samples) {
      if (!MayGoOn(watch)) {
        return true;
      }
      const bool is_blocked = std::any_of(others.begin(), others.end(), [&](OccurrenceId other) {
        return IsBlockedBy(product, other, p_W, dir_W);
      });
      blocked += is_blocked ? 1 : 0;
      if (blocked > most_blocked) {
        return false;
      }
    }
    return true;
  });
}

int CountHeld(const Product& product, OccurrenceId fastener,
              const std::vector<OccurrenceId>& others) {
  const Feature* shank = nullptr;
  for (const Feature& feature : product.part_of(fastener).features) {
    const bool is_longer = feature.kind == FeatureKind::kShaft &&
                           (shank == nullptr || feature.span_high - feature.span_low >
                                                    shank->span_high - shank->span_low);
    shank = is_longer ? &feature : shank;
  }
  if (shank == nullptr) {
    return 0;
  }
  const Pose& X_WF = product.occurrences[fastener.index()].X_WB;
  int held = 0;
  for (const OccurrenceId other : others) {
    const Pose X_FB = X_WF.Inverse() * product.occurrences[other.index()].X_WB;
    const Part& part = product.part_of(other);
    const bool is_held =
        std::any_of(part.features.begin(), part.features.end(), [&](const Feature& hole) {
          if (hole.kind != FeatureKind::kHole || hole.radius > 2 * shank->radius) {
            return false;
          }
          const Vec3 axis_F = X_FB.q() * hole.axis_B;
          const Vec3 r = X_FB * hole.origin_B - shank->origin_B;
          const double turn = axis_F.dot(shank->axis_B);
          const double at = r.dot(shank->axis_B);
          const double low = at + std::min(turn * hole.span_low, turn * hole.span_high);
          const double high = at + std::max(turn * hole.span_low, turn * hole.span_high);
          return std::abs(turn) > 0.999 && (r - at * shank->axis_B).norm() < 0.3 * shank->radius &&
                 low < shank->span_high && high > shank->span_low;
        });
    held += is_held ? 1 : 0;
  }
  return held;
}

}  // namespace hvas::product
