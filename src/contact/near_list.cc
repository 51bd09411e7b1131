#include "contact/near_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "spatial/box.h"

namespace hvas::contact {
namespace {

constexpr double kRounding = 1e-13;  // [m]: the rounding of a double at some hundred metres.

}  // namespace

NearSearch::NearSearch(const Mesh& mesh) : mesh_(mesh) {
  boxes_.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    spatial::Box box;
    for (const std::uint32_t v : t) {
      box.Add(mesh.vertices[v]);
    }
    const Vec3 c = box.centre();
    const Vec3 half = 0.5 * box.size();
    boxes_.push_back({{c.x(), c.y(), c.z()}, {half.x(), half.y(), half.z()}, half.norm()});
  }
  FindRimBends();
  FindSurroundings();
}

// A vertex with two rim edges, each seen from both sides or once where the mesh is open, is one
// that a rim passes through.
void NearSearch::FindRimBends() {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  std::vector<std::array<std::uint32_t, 2>> ends(mesh_.vertices.size(), {kNoFace, kNoFace});
  rim_bend_.assign(mesh_.vertices.size(), 0);
  const auto add = [&](std::uint32_t v, std::uint32_t other) {
    auto& pair = ends[v];
    if (pair[0] == kNoFace || pair[0] == other) {
      pair[0] = other;
    } else if (pair[1] == kNoFace || pair[1] == other) {
      pair[1] = other;
    } else {
      rim_bend_[v] = kUnknown;
    }
  };
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh_.IsRim(t, k)) {
        add(mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3]);
        add(mesh_.triangles[t][(k + 1) % 3], mesh_.triangles[t][k]);
      }
    }
  }
  for (std::size_t v = 0; v < ends.size(); ++v) {
    if (ends[v][1] == kNoFace) {
      rim_bend_[v] = kUnknown;
      continue;
    }
    const Vec3 before = mesh_.vertices[v] - mesh_.vertices[ends[v][0]];
    const Vec3 after = mesh_.vertices[ends[v][1]] - mesh_.vertices[v];
    const double along = before.dot(after);
    const double bend = before.cross(after).norm() / std::max(along, 1e-300);
    rim_bend_[v] = std::max(rim_bend_[v], along > 0 && bend < 1 ? bend : kUnknown);
  }
}

void NearSearch::FindSurroundings() {
  constexpr double kLeastCosine = 0.7;  // 45 degrees; beyond, the bend is no bound.
  // The triangles at each vertex, one vertex after the other.
  std::vector<std::uint32_t> begin(mesh_.vertices.size() + 1, 0);
  for (const auto& triangle : mesh_.triangles) {
    for (const std::uint32_t v : triangle) {
      ++begin[v + 1];
    }
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint32_t> at_vertex(begin.back());
  std::vector<std::uint32_t> next = begin;
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh_.triangles[t]) {
      at_vertex[next[v]++] = t;
    }
  }
  surroundings_.reserve(mesh_.triangles.size());
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    Surroundings result{0, 0};
    double cosine = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      result.rims = static_cast<std::uint8_t>(result.rims | (mesh_.IsRim(t, k) ? 1U << k : 0U));
      const std::uint32_t v = mesh_.triangles[t][k];
      for (std::uint32_t i = begin[v]; i < begin[v + 1]; ++i) {
        const std::uint32_t other = at_vertex[i];
        if (mesh_.face[other] == mesh_.face[t] && !mesh_.NormalOf(other).isZero()) {
          cosine = std::min(cosine, mesh_.NormalOf(t).dot(mesh_.NormalOf(other)));
        }
      }
    }
    result.bend = cosine < kLeastCosine ? std::numeric_limits<double>::infinity()
                                        : std::sqrt(std::max(0.0, 1 - cosine * cosine)) / cosine;
    surroundings_.push_back(result);
  }
}

// The closest point of a rim lies between the ends of the edge as the point itself does, but for
// what the rim turns there.
bool NearSearch::CanRimBeClosest(std::uint32_t triangle, std::size_t k, const Vec3& c,
                                 double radius, double limit) const {
  const std::uint32_t start = mesh_.triangles[triangle][k];
  const std::uint32_t end = mesh_.triangles[triangle][(k + 1) % 3];
  const Vec3 from_start = c - mesh_.vertices[start];
  const Vec3 edge = mesh_.vertices[end] - mesh_.vertices[start];
  const double length = edge.norm();
  const double along = from_start.dot(edge) / length;
  const double beyond = std::max({0.0, -along, along - length});
  const double distance = (from_start - std::clamp(along, 0.0, length) / length * edge).norm();
  if (distance > limit) {
    return false;
  }
  const double bend = rim_bend_[along < 0 ? start : end];
  return beyond <= (radius + bend * (distance + radius)) * kSlack + kRounding;
}

// A point's closest one on a face is the foot of the normal in a triangle, or on an edge or corner
// between triangles whose normals it lies between, or on the face's rim. In the first two cases the
// point is not far beside the triangle.
bool NearSearch::CanBeClosest(std::uint32_t triangle, const TrianglePoint& point, const Vec3& c,
                              double radius, double limit) const {
  constexpr double kCornerBend = 2;  // At a corner the way may lean more than at an edge.
  const Vec3 way = c - point.q;
  const double distance = way.norm();
  if (distance > limit) {
    return false;
  }
  const Surroundings& around = surroundings_[triangle];
  if (point.feature == TriangleFeature::kInside ||
      around.bend == std::numeric_limits<double>::infinity()) {
    return true;
  }
  const double height = std::abs(way.dot(mesh_.NormalOf(triangle)));
  const double beside = std::sqrt(std::max(0.0, distance * distance - height * height));
  if (beside <= (radius + kCornerBend * around.bend * (height + radius)) * kSlack + kRounding) {
    return true;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if ((around.rims >> k & 1U) != 0 && CanRimBeClosest(triangle, k, c, radius, limit)) {
      return true;
    }
  }
  return false;
}

NearList NearSearch::MakeFullList() const {
  NearList all(mesh_.triangles.size());
  for (std::uint32_t t = 0; t < all.size(); ++t) {
    all[t] = {t, 0.0};
  }
  return all;
}

// First by the triangles' boxes; then by their distance where the box is large against `radius`, so
// says little.
void NearSearch::Filter(const NearList& list, const Vec3& c, double radius, NearList* out) const {
  const auto calc_exact = [&](std::uint32_t triangle) {
    return (mesh_.ClosestOn(triangle, c).q - c).norm();
  };
  const auto limit_of = [&](double least) { return (least + 2 * radius) * kSlack + kRounding; };
  // What was nearest to the larger region's centre is near this one.
  double least = calc_exact(LeastOf(list).triangle);
  double limit = limit_of(least);
  const double first_limit = limit * limit;
  out->resize(list.size());
  NearTriangle lowest{kNoFace, std::numeric_limits<double>::infinity()};
  std::size_t count = 0;
  for (const NearTriangle& candidate : list) {
    const NearTriangle entry{candidate.triangle, boxes_[candidate.triangle].CalcSquaredDistance(c)};
    (*out)[count] = entry;
    count += entry.distance <= first_limit ? 1 : 0;
    lowest = entry.distance < lowest.distance ? entry : lowest;
  }
  out->resize(count);
  least = std::min(least, calc_exact(lowest.triangle));
  limit = limit_of(least);
  std::size_t kept = 0;
  for (const NearTriangle& entry : *out) {
    if (entry.distance > limit * limit) {
      continue;
    }
    double distance = std::sqrt(entry.distance);
    if (boxes_[entry.triangle].radius > 0.5 * radius) {
      distance = calc_exact(entry.triangle);
      if (distance < least) {
        least = distance;
        limit = limit_of(least);
      }
    }
    if (distance <= limit) {
      (*out)[kept++] = {entry.triangle, distance};
    }
  }
  out->resize(kept);
  std::erase_if(*out, [&](const NearTriangle& entry) { return entry.distance > limit; });
}

template <bool is_sorted>
Nearest NearSearch::FindIn(const NearList& list, const Vec3& p, double offset,
                           std::uint32_t hint) const {
  double squared = std::numeric_limits<double>::infinity();
  double limit = squared;
  double limit_squared = squared;
  Nearest nearest;
  const auto look = [&](std::uint32_t triangle) {
    const TrianglePoint point = mesh_.ClosestOn(triangle, p);
    const double found = (point.q - p).squaredNorm();
    if (found < squared) {
      squared = found;
      nearest = {std::sqrt(found), triangle, point};
      limit = nearest.distance * kSlack + kRounding;
      limit_squared = limit * limit;
    }
  };
  look(hint);
  for (const NearTriangle& entry : list) {
    if (entry.distance - offset > limit) {
      if constexpr (is_sorted) {
        break;
      }
      continue;
    }
    if (entry.triangle != hint && boxes_[entry.triangle].CalcSquaredDistance(p) <= limit_squared) {
      look(entry.triangle);
    }
  }
  return nearest;
}

Nearest NearSearch::Find(const NearList& list, const Vec3& p, double offset,
                         std::uint32_t hint) const {
  return FindIn<false>(list, p, offset, hint);
}

Nearest NearSearch::FindSigned(const NearList& list, const Vec3& p, double offset,
                               std::uint32_t hint) const {
  return GiveSign(p, FindIn<false>(list, p, offset, hint));
}

Nearest NearSearch::FindSignedInSorted(const NearList& list, const Vec3& p, double offset,
                                       std::uint32_t hint) const {
  return GiveSign(p, FindIn<true>(list, p, offset, hint));
}

Nearest NearSearch::GiveSign(const Vec3& p, Nearest nearest) const {
  const TriangleFeature feature = nearest.point.feature;
  bool is_inside = (p - nearest.point.q).dot(mesh_.Pseudonormal(nearest.triangle, feature)) < 0;
  if (mesh_.IsOpenAt(nearest.triangle, feature)) {
    is_inside = mesh_.CalcWindingNumber(p) > 0.5;
  }
  if (is_inside) {
    nearest.distance = -nearest.distance;
  }
  return nearest;
}

NearTriangle LeastOf(const NearList& list) {
  return *std::min_element(
      list.begin(), list.end(),
      [](const NearTriangle& a, const NearTriangle& b) { return a.distance < b.distance; });
}

}  // namespace hvas::contact
