#include "contact/near_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "spatial/box.h"

namespace hvas::contact {
namespace {

constexpr double kRounding = 1e-13;  // [m]: the rounding of a double at some hundred metres.

// What is further from a ball's centre than this is nowhere in the ball the closest, `least` being
// the distance of something.
double CalcLimit(double least, double radius) {
  return (least + 2 * radius) * kSlack + kRounding;
}

Vec3 CentreOfOctant(const Vec3& low, const Vec3& high, std::size_t k) {
  return {(k & 1U) != 0 ? high.x() : low.x(), (k & 2U) != 0 ? high.y() : low.y(),
          (k & 4U) != 0 ? high.z() : low.z()};
}

}  // namespace

NearSearch::NearSearch(const Mesh& mesh) : mesh_(mesh) {
  boxes_.reserve(mesh.triangles.size());
  corners_.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    spatial::Box box;
    for (const std::uint32_t v : t) {
      box.Add(mesh.vertices[v]);
    }
    const Vec3 c = box.centre();
    const Vec3 half = 0.5 * box.size();
    corners_.push_back(
        MakeTriangleCorners(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
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
double NearSearch::CalcLeastLimitOfRim(std::uint32_t triangle, std::size_t k, const Vec3& c,
                                       double radius, double most) const {
  const std::uint32_t start = mesh_.triangles[triangle][k];
  const std::uint32_t end = mesh_.triangles[triangle][(k + 1) % 3];
  const Vec3 from_start = c - mesh_.vertices[start];
  const Vec3 edge = mesh_.vertices[end] - mesh_.vertices[start];
  const double length = edge.norm();
  const double along = from_start.dot(edge) / length;
  const double beyond = std::max({0.0, -along, along - length});
  const double distance = (from_start - std::clamp(along, 0.0, length) / length * edge).norm();
  if (distance > most) {
    return kAnywhere;
  }
  const double bend = rim_bend_[along < 0 ? start : end];
  return beyond <= (radius + bend * (distance + radius)) * kSlack + kRounding ? distance
                                                                              : kAnywhere;
}

// A point's closest one on a face is the foot of the normal in a triangle, or on an edge or corner
// between triangles whose normals it lies between, or on the face's rim. In the first two cases the
// point is not far beside the triangle.
double NearSearch::CalcLeastLimit(std::uint32_t triangle, const TrianglePoint& point, const Vec3& c,
                                  double radius, double most) const {
  constexpr double kCornerBend = 2;  // At a corner the way may lean more than at an edge.
  const Vec3 way = c - point.q;
  const double distance = way.norm();
  if (distance > most) {
    return kAnywhere;
  }
  const Surroundings& around = surroundings_[triangle];
  if (point.feature == TriangleFeature::kInside || around.bend == kAnywhere) {
    return distance;
  }
  const double height = std::abs(way.dot(mesh_.NormalOf(triangle)));
  const double beside = std::sqrt(std::max(0.0, distance * distance - height * height));
  if (beside <= (radius + kCornerBend * around.bend * (height + radius)) * kSlack + kRounding) {
    return distance;
  }
  double limit = kAnywhere;
  for (std::size_t k = 0; k < 3; ++k) {
    if ((around.rims >> k & 1U) != 0) {
      limit = std::min(limit, CalcLeastLimitOfRim(triangle, k, c, radius, most));
    }
  }
  return std::max(distance, limit);
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
  BegunFilter begun;
  // What was nearest to the larger region's centre is near this one.
  begun.first = LeastOf(list).triangle;
  begun.least = CalcDistance(begun.first, c);
  begun.lowest = kAnywhere;
  const double limit = CalcLimit(begun.least, radius);
  begun.list.resize(list.size());
  std::size_t count = 0;
  for (const NearTriangle& candidate : list) {
    const TriangleBox& box = boxes_[candidate.triangle];
    const double squared = box.CalcSquaredDistance(c);
    begun.list[count] = {candidate.triangle, static_cast<float>(box.radius), squared};
    begun.lowest = std::min(begun.lowest, squared);
    count += squared <= limit * limit ? 1 : 0;
  }
  begun.list.resize(count);
  NearSet set;
  End(c, radius, begun, &set);
  *out = std::move(set.list);
}

void NearSearch::FilterOctants(const NearSet& set, const Vec3& low, const Vec3& high, double radius,
                               unsigned wanted, std::array<BegunFilter, 8>* begun,
                               std::array<NearSet, 8>* out) const {
  BeginOctants(set, low, high, radius, wanted, begun);
  for (std::size_t k = 0; k < 8; ++k) {
    (*out)[k].list.clear();
    if ((wanted >> k & 1U) != 0) {
      End(CentreOfOctant(low, high, k), radius, (*begun)[k], &(*out)[k]);
    }
  }
}

// The squared distances of the octants' centres from a box are sums of two numbers in x, two in y
// and two in z.
void NearSearch::BeginOctants(const NearSet& set, const Vec3& low, const Vec3& high, double radius,
                              unsigned wanted, std::array<BegunFilter, 8>* out) const {
  std::array<double, 8> limit_squared{};
  std::array<BoxedTriangle*, 8> end{};
  for (std::size_t k = 0; k < 8; ++k) {
    BegunFilter& octant = (*out)[k];
    octant.first = set.least.triangle;
    limit_squared[k] = -1;
    const bool is_wanted = (wanted >> k & 1U) != 0;
    // One more than may be kept is written.
    octant.list.resize(is_wanted ? set.list.size() + 1 : 1);
    end[k] = octant.list.data();
    if (is_wanted) {
      octant.least = CalcDistance(octant.first, CentreOfOctant(low, high, k));
      const double limit = CalcLimit(octant.least, radius);
      limit_squared[k] = limit * limit;
    }
  }
  const Pair x(low.x(), high.x());
  const Pair y(low.y(), high.y());
  const Pair z(low.z(), high.z());
  std::array<Pair, 4> lowest{Pair(kAnywhere), Pair(kAnywhere), Pair(kAnywhere), Pair(kAnywhere)};
  for (const NearTriangle& entry : set.list) {
    const std::uint32_t triangle = entry.triangle;
    const TriangleBox& box = boxes_[triangle];
    const auto box_radius = static_cast<float>(box.radius);
    const Pair xx = box.CalcSquaredAlong(0, x);
    const Pair yy = box.CalcSquaredAlong(1, y);
    const Pair zz = box.CalcSquaredAlong(2, z);
    const Pair xy_low = xx + Pair(yy.low());
    const Pair xy_high = xx + Pair(yy.high());
    const std::array sums{xy_low + Pair(zz.low()), xy_high + Pair(zz.low()),
                          xy_low + Pair(zz.high()), xy_high + Pair(zz.high())};
    for (std::size_t pair = 0; pair < 4; ++pair) {
      const std::size_t k = 2 * pair;
      lowest[pair] = Least(lowest[pair], sums[pair]);
      *end[k] = {triangle, box_radius, sums[pair].low()};
      end[k] += sums[pair].low() <= limit_squared[k] ? 1 : 0;
      *end[k + 1] = {triangle, box_radius, sums[pair].high()};
      end[k + 1] += sums[pair].high() <= limit_squared[k + 1] ? 1 : 0;
    }
  }
  for (std::size_t k = 0; k < 8; ++k) {
    BegunFilter& octant = (*out)[k];
    octant.list.resize(static_cast<std::size_t>(end[k] - octant.list.data()));
    octant.lowest = k % 2 == 0 ? lowest[k / 2].low() : lowest[k / 2].high();
  }
}

// Where the box of a triangle is large against `radius`, it says little: then the distance decides.
void NearSearch::End(const Vec3& c, double radius, const BegunFilter& begun, NearSet* out) const {
  const double small = 0.5 * radius * (1 - 1e-6);  // Single precision tells no more.
  double least = begun.least;
  const auto lowest =
      std::find_if(begun.list.begin(), begun.list.end(),
                   [&](const BoxedTriangle& entry) { return entry.squared == begun.lowest; });
  if (lowest->triangle != begun.first) {
    least = std::min(least, CalcDistance(lowest->triangle, c));
  }
  double limit = CalcLimit(least, radius);
  NearList& list = out->list;
  list.resize(begun.list.size());
  EightTriangles eight(*this, c);
  std::array<std::size_t, EightTriangles::kMost> place{};
  const auto calc = [&] {
    eight.Calc();
    for (int i = 0; i < eight.count(); ++i) {
      const double distance = std::sqrt(eight.squared(i));
      list[place[static_cast<std::size_t>(i)]].distance = -distance;  // Not squared.
      least = std::min(least, distance);
    }
    limit = CalcLimit(least, radius);
    eight.Clear();
  };
  std::size_t kept = 0;
  for (const BoxedTriangle& entry : begun.list) {
    if (entry.squared > limit * limit) {
      continue;
    }
    list[kept] = {entry.triangle, entry.squared};
    if (static_cast<double>(entry.radius) > small && boxes_[entry.triangle].radius > 0.5 * radius) {
      place[static_cast<std::size_t>(eight.count())] = kept;
      if (eight.Add(entry.triangle)) {
        calc();
      }
    }
    ++kept;
  }
  calc();
  list.resize(kept);
  // The limit has sunk on the way.
  out->least = {kNoFace, kAnywhere};
  kept = 0;
  for (NearTriangle entry : list) {
    entry.distance = entry.distance > 0 ? std::sqrt(entry.distance) : -entry.distance;
    list[kept] = entry;
    if (entry.distance <= limit) {
      out->least = entry.distance < out->least.distance ? entry : out->least;
      ++kept;
    }
  }
  list.resize(kept);
}

NearTriangle NearSearch::FindLeast(const Vec3& c, double radius, const BegunFilter& begun) const {
  const double small = 0.5 * radius * (1 - 1e-6);  // Single precision tells no more.
  const double limit = CalcLimit(begun.least, radius);
  NearTriangle least{kNoFace, kAnywhere};
  double most = limit * limit;
  for (const BoxedTriangle& entry : begun.list) {
    if (entry.squared > most) {
      continue;
    }
    const bool is_large =
        static_cast<double>(entry.radius) > small && boxes_[entry.triangle].radius > 0.5 * radius;
    const double distance = is_large ? CalcDistance(entry.triangle, c) : std::sqrt(entry.squared);
    if (distance < least.distance) {
      least = {entry.triangle, distance};
      most = std::min(most, distance * distance * kSlack);
    }
  }
  return least;
}

NearSearch::TriangleBox NearSearch::BoxAround(const NodeGrid& grid) {
  TriangleBox box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = grid.at[axis][0];
    const double high = grid.at[axis][grid.count[axis] - 1];
    box.centre[axis] = 0.5 * (low + high);
    box.half[axis] = 0.5 * (high - low) + kRounding;
  }
  return box;
}

// As for octants, but each node has a list of its own at once: what is no further away than
// `first`.
void NearSearch::FilterNodes(const BoxedList& list, std::uint32_t first, const NodeGrid& grid,
                             std::array<BoxedList, NodeGrid::kMost>* out) const {
  std::array<double, NodeGrid::kMost + 1> limit_squared{};
  std::array<BoxedTriangle*, NodeGrid::kMost + 1> end{};
  std::size_t n = 0;
  EightTriangles eight(*this);
  const auto limit_nodes = [&] {
    eight.Calc();
    for (int i = 0; i < eight.count(); ++i, ++n) {
      const double limit = CalcLimit(std::sqrt(eight.squared(i)), 0);
      limit_squared[n] = limit * limit;
      (*out)[n].resize(list.size() + 1);  // One more than may be kept is written.
      end[n] = (*out)[n].data();
    }
    eight.Clear();
  };
  for (std::size_t k = 0; k < grid.count[2]; ++k) {
    for (std::size_t j = 0; j < grid.count[1]; ++j) {
      for (std::size_t i = 0; i < grid.count[0]; ++i) {
        if (eight.Add(first, grid.NodeAt(i, j, k))) {
          limit_nodes();
        }
      }
    }
  }
  limit_nodes();
  // Most boxes are further from the box around the nodes than any node may be from its closest.
  const double most = *std::max_element(limit_squared.data(), limit_squared.data() + n) * kSlack;
  const TriangleBox around = BoxAround(grid);
  const Pair x(grid.at[0][0], grid.at[0][1]);
  const Pair y(grid.at[1][0], grid.at[1][1]);
  const Pair z(grid.at[2][0], grid.at[2][1]);
  for (const BoxedTriangle& entry : list) {
    const TriangleBox& box = boxes_[entry.triangle];
    if (box.CalcSquaredDistance(around) > most) {
      continue;
    }
    const Pair xx = box.CalcSquaredAlong(0, x);
    const Pair yy = box.CalcSquaredAlong(1, y);
    const Pair zz = box.CalcSquaredAlong(2, z);
    const auto third = [&](std::size_t axis) {
      return grid.count[axis] > 2 ? box.CalcSquaredAlong(axis, Pair(grid.at[axis][2])).low() : 0;
    };
    const double xx_third = third(0);
    const std::array all_yy{yy.low(), yy.high(), third(1)};
    const std::array all_zz{zz.low(), zz.high(), third(2)};
    const auto put = [&](std::size_t node, double squared) {
      *end[node] = {entry.triangle, entry.radius, squared};
      end[node] += squared <= limit_squared[node] ? 1 : 0;
    };
    std::size_t node = 0;
    for (std::size_t k = 0; k < grid.count[2]; ++k) {
      for (std::size_t j = 0; j < grid.count[1]; ++j) {
        const Pair squared = xx + Pair(all_yy[j]) + Pair(all_zz[k]);
        put(node, squared.low());
        if (grid.count[0] > 1) {
          put(node + 1, squared.high());
        }
        if (grid.count[0] > 2) {
          put(node + 2, xx_third + all_yy[j] + all_zz[k]);
        }
        node += grid.count[0];
      }
    }
  }
  for (std::size_t node = 0; node < n; ++node) {
    (*out)[node].resize(static_cast<std::size_t>(end[node] - (*out)[node].data()));
  }
}

// Looks at triangles, eight at once, for the closest one to p: the first of several as close.
class NearSearch::Search {
 public:
  Search(const NearSearch& of, const Vec3& p, std::uint32_t hint) : eight_(of, p) {
    const TrianglePoint point = of.ClosestOn(hint, p);
    Take((point.q - p).squaredNorm(), hint, point);
  }

  void Look(std::uint32_t triangle) {
    if (eight_.Add(triangle)) {
      Finish();
    }
  }

  // Looks at what is left.
  const Nearest& Finish() {
    eight_.Calc();
    for (int i = 0; i < eight_.count(); ++i) {
      if (eight_.squared(i) < squared_) {
        Take(eight_.squared(i), eight_.triangle(i), eight_.PointOf(i));
      }
    }
    eight_.Clear();
    return nearest_;
  }

  // What is further away than this is not the closest.
  [[nodiscard]] double limit() const { return limit_; }

  [[nodiscard]] double limit_squared() const { return limit_squared_; }

 private:
  void Take(double squared, std::uint32_t triangle, const TrianglePoint& point) {
    squared_ = squared;
    nearest_ = {std::sqrt(squared), triangle, point};
    limit_ = nearest_.distance * kSlack + kRounding;
    limit_squared_ = limit_ * limit_;
  }

  EightTriangles eight_;
  double squared_{0};
  double limit_{0};
  double limit_squared_{0};
  Nearest nearest_;
};

template <bool is_sorted>
Nearest NearSearch::FindIn(const NearList& list, const Vec3& p, double offset,
                           std::uint32_t hint) const {
  Search search(*this, p, hint);
  for (const NearTriangle& entry : list) {
    if (entry.distance - offset > search.limit()) {
      if constexpr (is_sorted) {
        break;
      }
      continue;
    }
    if (entry.triangle != hint &&
        boxes_[entry.triangle].CalcSquaredDistance(p) <= search.limit_squared()) {
      search.Look(entry.triangle);
    }
  }
  return search.Finish();
}

Nearest NearSearch::FindSignedInBoxed(const BoxedList& list, const Vec3& p,
                                      std::uint32_t hint) const {
  Search search(*this, p, hint);
  for (const BoxedTriangle& entry : list) {
    if (entry.squared <= search.limit_squared() && entry.triangle != hint) {
      search.Look(entry.triangle);
    }
  }
  return GiveSign(p, search.Finish());
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

std::optional<bool> NearSearch::FindSide(const NearList& list, const Vec3& p, double offset,
                                         std::uint32_t hint) const {
  const double distance = FindIn<false>(list, p, offset, hint).distance;
  const double limit = distance * kSlack + kRounding;
  std::optional<bool> is_inside;
  for (const NearTriangle& entry : list) {
    if (entry.distance - offset > limit || !MayReach(entry.triangle, p, limit)) {
      continue;
    }
    const TrianglePoint point = ClosestOn(entry.triangle, p);
    const double found = (point.q - p).norm();
    if (found <= limit) {
      const bool is_so = GiveSign(p, {found, entry.triangle, point}).distance < 0;
      if (is_inside && *is_inside != is_so) {
        return std::nullopt;
      }
      is_inside = is_so;
    }
  }
  return is_inside;
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
