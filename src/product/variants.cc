#include "product/variants.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "product/mesh_ray.h"
#include "spatial/box_pairs.h"

namespace hvas::product {
namespace {

using spatial::Surface;
using spatial::SurfaceKind;

constexpr double kShared = 0.8;        // Part of a volume that is taken for all of it: a choice.
constexpr double kFaces = 0.5;         // Part of a surface that makes parts alike: a choice.
constexpr double kSmallest = 0.2;      // Volume of a variant, as a part of the other's: a choice.
constexpr int kLines = 24;             // Lines in each of two directions: a choice.
constexpr double kSameFace = 10e-6;    // [m]: faces that touch (mates.md, section 1).
constexpr double kFaceAngle = 1.7e-3;  // [rad]: 0.1 deg, as there.

Box CalcWorldBox(const Product& product, OccurrenceId id) {
  return spatial::Transform(product.occurrences[id.index()].X_WB, product.part_of(id).box_B);
}

Box Intersect(const Box& a, const Box& b) {
  return {a.low.cwiseMax(b.low), a.high.cwiseMin(b.high)};
}

double CalcVolume(const Box& box) {
  return (box.high - box.low).cwiseMax(0.0).prod();
}

/** A stretch of a line that lies in a part. */
struct Stretch {
  double low{0};
  double high{0};
};

/** Where a line is in a part; nothing where its crossings do not pair, as in an open mesh. */
std::optional<std::vector<Stretch>> ListStretches(const Product& product, OccurrenceId id,
                                                  const Vec3& p_W, const Vec3& dir_W,
                                                  double reach) {
  const Pose X_BW = product.occurrences[id.index()].X_WB.Inverse();
  std::vector<Stretch> stretches;
  int depth = 0;
  double begin = 0;
  for (const Crossing& crossing :
       ListCrossings(product.part_of(id), X_BW * p_W, X_BW.q() * dir_W, reach)) {
    depth += crossing.is_entering ? 1 : -1;
    if (depth == 1 && crossing.is_entering) {
      begin = crossing.distance;
    } else if (depth == 0) {
      stretches.push_back({begin, crossing.distance});
    } else if (depth < 0) {
      return std::nullopt;
    }
  }
  return depth == 0 ? std::optional(stretches) : std::nullopt;
}

double CalcLength(const std::vector<Stretch>& stretches) {
  double length = 0;
  for (const Stretch& stretch : stretches) {
    length += stretch.high - stretch.low;
  }
  return length;
}

double CalcSharedLength(const std::vector<Stretch>& a, const std::vector<Stretch>& b) {
  double length = 0;
  for (const Stretch& s : a) {
    for (const Stretch& t : b) {
      length += std::max(0.0, std::min(s.high, t.high) - std::max(s.low, t.low));
    }
  }
  return length;
}

/** Whether two faces lie on one surface, with their material on one side. */
bool AreOneSurface(const Surface& a, const Surface& b) {
  if (a.kind != b.kind || std::abs(a.radius - b.radius) > kSameFace) {
    return false;
  }
  const Vec3 d = b.origin - a.origin;
  const double cosine = a.axis.dot(b.axis);
  const bool is_parallel = a.axis.cross(b.axis).norm() < kFaceAngle;
  const bool is_same_sense = a.outward * b.outward > 0;
  switch (a.kind) {
    case SurfaceKind::kPlane:
      return is_parallel && a.outward * b.outward * cosine > 0 &&
             std::abs(a.axis.dot(d)) < kSameFace;
    case SurfaceKind::kCylinder:
      return is_parallel && is_same_sense && a.axis.cross(d).norm() < kSameFace;
    case SurfaceKind::kSphere:
      return is_same_sense && d.norm() < kSameFace;
    case SurfaceKind::kCone:
      return is_parallel && is_same_sense && std::abs(a.second - b.second) < kFaceAngle &&
             d.norm() < kSameFace;
    case SurfaceKind::kTorus:
      return is_parallel && is_same_sense && std::abs(a.second - b.second) < kSameFace &&
             d.norm() < kSameFace;
    case SurfaceKind::kFreeform:
      return false;
  }
  return false;
}

/** Part of the smaller one's surface that lies on equal faces of the other. */
double CalcSharedSurface(const Product& product, OccurrenceId smaller, OccurrenceId larger) {
  const Part& part = product.part_of(smaller);
  const Part& other = product.part_of(larger);
  const Pose& X_WB = product.occurrences[smaller.index()].X_WB;
  const Pose& X_WO = product.occurrences[larger.index()].X_WB;
  double all = 0;
  double shared = 0;
  for (const Face& face : part.faces) {
    all += face.area;
    const Surface own = spatial::Transform(X_WB, face.surface);
    const Box box = spatial::Transform(X_WB, face.box_B).Expanded(kSameFace);
    const bool is_shared =
        std::any_of(other.faces.begin(), other.faces.end(), [&](const Face& candidate) {
          return AreOneSurface(own, spatial::Transform(X_WO, candidate.surface)) &&
                 box.Overlaps(spatial::Transform(X_WO, candidate.box_B));
        });
    shared += is_shared ? face.area : 0;
  }
  return all > 0 ? shared / all : 0;
}

/** Whether a look at volumes and boxes leaves two parts as candidates. */
bool MayBeVariants(const Product& product, const std::vector<Box>& boxes, OccurrenceId a,
                   OccurrenceId b) {
  const Box& box_a = boxes[a.index()];
  const Box& box_b = boxes[b.index()];
  if (!box_a.Overlaps(box_b)) {
    return false;
  }
  const Part& part_a = product.part_of(a);
  const Part& part_b = product.part_of(b);
  const double volume_a = part_a.mass.volume;
  const double volume_b = part_b.mass.volume;
  return part_a.shape_hash != part_b.shape_hash && volume_a > 0 && volume_b > 0 &&
         std::min(volume_a, volume_b) >= kSmallest * std::max(volume_a, volume_b) &&
         CalcVolume(Intersect(box_a, box_b)) >= kShared * std::min(volume_a, volume_b);
}

/** The shared part of the smaller one, where two parts are variants. */
std::optional<double> CompareVariants(const Product& product, OccurrenceId a, OccurrenceId b) {
  const SharedVolume volume = CalcSharedVolume(product, a, b);
  const double smaller = std::min(volume.first, volume.second);
  if (!(smaller > 0) || volume.both < kShared * smaller) {
    return std::nullopt;
  }
  const double together = volume.first + volume.second - volume.both;
  const bool is_first_smaller = volume.first < volume.second;
  const bool is_variant =
      volume.both >= kShared * together ||
      CalcSharedSurface(product, is_first_smaller ? a : b, is_first_smaller ? b : a) >= kFaces;
  return is_variant ? std::optional(std::min(1.0, volume.both / smaller)) : std::nullopt;
}

}  // namespace

SharedVolume CalcSharedVolume(const Product& product, OccurrenceId first, OccurrenceId second) {
  Box box = CalcWorldBox(product, first);
  box.Add(CalcWorldBox(product, second));
  // Along the shortest side, so that the lines are many where the parts are wide.
  Vec3::Index along = 0;
  box.size().minCoeff(&along);
  const Vec3::Index u = (along + 1) % 3;
  const Vec3::Index v = (along + 2) % 3;
  const double margin = 0.01 * box.size().norm();
  const double reach = box.size()[along] + 2 * margin;
  const double cell = box.size()[u] * box.size()[v] / (kLines * kLines);
  SharedVolume volume;
  int open = 0;
  for (int i = 0; i < kLines; ++i) {
    for (int k = 0; k < kLines; ++k) {
      Vec3 p = box.low;
      p[along] -= margin;
      p[u] += (i + 0.5) / kLines * box.size()[u];
      p[v] += (k + 0.5) / kLines * box.size()[v];
      const Vec3 dir = Vec3::Unit(along);
      const auto in_first = ListStretches(product, first, p, dir, reach);
      const auto in_second = ListStretches(product, second, p, dir, reach);
      if (!in_first || !in_second) {
        ++open;
        continue;
      }
      volume.first += cell * CalcLength(*in_first);
      volume.second += cell * CalcLength(*in_second);
      volume.both += cell * CalcSharedLength(*in_first, *in_second);
    }
  }
  constexpr int kMostOpen = kLines * kLines / 20;  // Lines along walls: a choice.
  return open <= kMostOpen ? volume : SharedVolume();
}

std::vector<VariantPair> FindVariants(const Product& product, WorkWatch* watch) {
  const std::size_t count = product.occurrences.size();
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    boxes.push_back(CalcWorldBox(product, OccurrenceId(i)));
  }
  std::vector<bool> is_left_out(count, false);
  std::vector<VariantPair> pairs;
  spatial::ForEachPair(boxes, 0, watch, [&](std::size_t i, std::size_t k) {
    const OccurrenceId first(i);
    const OccurrenceId second(k);
    if (is_left_out[i] || is_left_out[k] || !MayBeVariants(product, boxes, first, second)) {
      return true;
    }
    if (const auto shared = CompareVariants(product, first, second)) {
      pairs.push_back({first, second, *shared});
      is_left_out[k] = true;
    }
    return true;
  });
  return pairs;
}

}  // namespace hvas::product
