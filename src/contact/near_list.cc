#include "contact/near_list.h"

#include <algorithm>
#include <cmath>

#include "spatial/box.h"

namespace hvas::contact {
namespace {

constexpr double kSlack = 1 + 1e-9;
constexpr double kRounding = 1e-13;  // [m]

}  // namespace

double NearSearch::TriangleBox::CalcSquaredDistance(const Vec3& p) const {
  const double x = std::max(std::abs(p.x() - centre[0]) - half[0], 0.0);
  const double y = std::max(std::abs(p.y() - centre[1]) - half[1], 0.0);
  const double z = std::max(std::abs(p.z() - centre[2]) - half[2], 0.0);
  return x * x + y * y + z * z;
}

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
void NearSearch::Filter(const NearList& list, const Vec3& c, double radius, bool is_exact,
                        NearList* out) const {
  const auto calc_exact = [&](std::uint32_t triangle) {
    return (mesh_.ClosestOn(triangle, c).q - c).norm();
  };
  const auto limit_of = [&](double least) { return (least + 2 * radius) * kSlack + kRounding; };
  out->resize(list.size());
  NearTriangle lowest{kNoFace, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::uint32_t triangle = list[i].triangle;
    const NearTriangle entry{triangle, boxes_[triangle].CalcSquaredDistance(c)};
    (*out)[i] = entry;
    if (entry.distance < lowest.distance) {
      lowest = entry;
    }
  }
  double least = calc_exact(lowest.triangle);
  double limit = limit_of(least);
  std::size_t kept = 0;
  for (const NearTriangle& entry : *out) {
    if (entry.distance > limit * limit) {
      continue;
    }
    double distance = std::sqrt(entry.distance);
    if (is_exact || boxes_[entry.triangle].radius > 0.5 * radius) {
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
  out->erase(std::remove_if(out->begin(), out->end(),
                            [&](const NearTriangle& entry) { return entry.distance > limit; }),
             out->end());
}

Nearest NearSearch::Find(const NearList& list, const Vec3& p, double offset,
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
    if (entry.distance - offset <= limit && entry.triangle != hint &&
        boxes_[entry.triangle].CalcSquaredDistance(p) <= limit_squared) {
      look(entry.triangle);
    }
  }
  return nearest;
}

Nearest NearSearch::FindSigned(const NearList& list, const Vec3& p, double offset,
                               std::uint32_t hint) const {
  Nearest nearest = Find(list, p, offset, hint);
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
