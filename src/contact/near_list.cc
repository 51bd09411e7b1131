#include "contact/near_list.h"

#include <algorithm>
#include <array>
#include <bit>
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
    boxes_.push_back({{c.x(), c.y(), c.z(), 0}, {half.x(), half.y(), half.z(), half.norm()}});
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
  const TriangleCorners& corners = corners_[triangle];
  const std::array<const double*, 3> corner{corners.a, corners.b, corners.c};
  const Eigen::Map<const Vec3> start(corner[k]);
  const Vec3 from_start = c - start;
  const Vec3 edge = Eigen::Map<const Vec3>(corner[(k + 1) % 3]) - start;
  const double along = from_start.dot(edge) / edge.squaredNorm();  // In edges.
  const double squared = (from_start - std::clamp(along, 0.0, 1.0) * edge).squaredNorm();
  if (squared > most * most) {
    return kAnywhere;
  }
  const double distance = std::sqrt(squared);
  if (along >= 0 && along <= 1) {
    return distance;
  }
  const double bend = rim_bend_[mesh_.triangles[triangle][along < 0 ? k : (k + 1) % 3]];
  const double allowed = (radius + bend * (distance + radius)) * kSlack + kRounding;
  if (std::max(-along, along - 1) * edge.norm() <= allowed) {
    return distance;
  }
  return kAnywhere;
}

// A point's closest one on a face is the foot of the normal in a triangle, or on an edge or corner
// between triangles whose normals it lies between, or on the face's rim. In the first two cases the
// point is not far beside the triangle.
double NearSearch::CalcLeastLimit(std::uint32_t triangle, const TrianglePoint& point, const Vec3& c,
                                  double radius, double most) const {
  constexpr double kCornerBend = 2;  // At a corner the way may lean more than at an edge.
  const Vec3 way = c - point.q;
  const double squared = way.squaredNorm();
  if (squared > most * most) {
    return kAnywhere;
  }
  const double distance = std::sqrt(squared);
  const Surroundings& around = surroundings_[triangle];
  if (point.feature == TriangleFeature::kInside || around.bend == kAnywhere) {
    return distance;
  }
  const double height = std::abs(way.dot(mesh_.NormalOf(triangle)));
  const double beside =
      (radius + kCornerBend * around.bend * (height + radius)) * kSlack + kRounding;
  if (squared - height * height <= beside * beside) {
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
    begun.list[count] = {candidate.triangle, static_cast<float>(box.radius()), squared};
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
    const auto box_radius = static_cast<float>(box.radius());
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
  const std::uint32_t lowest = begun.FindLowest();
  if (lowest != begun.first) {
    least = std::min(least, CalcDistance(lowest, c));
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
    if (static_cast<double>(entry.radius) > small &&
        boxes_[entry.triangle].radius() > 0.5 * radius) {
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
    const double root = Pair(std::abs(entry.distance)).Root().low();
    entry.distance = entry.distance > 0 ? root : -entry.distance;
    list[kept] = entry;
    kept += entry.distance <= limit ? 1 : 0;
    if (entry.distance < out->least.distance) {
      out->least = entry;  // Not beyond the limit, as that is no less than the least.
    }
  }
  list.resize(kept);
}

NearSearch::TriangleBox NearSearch::BoxAround(const NodeGrid& grid) {
  TriangleBox box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = grid.at[axis][0];
    const double high = grid.at[axis][grid.count[axis] - 1];
    box.centre[axis] = 0.5 * (low + high);
    box.half[axis] = 0.5 * (high - low) + kRounding;
    box.half[3] += box.half[axis];
  }
  return box;
}

// Looks at triangles, eight at once, for the closest one to p: of several as close, the one with
// the least number, in whatever order they are looked at.
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
      if (IsCloser(eight_.squared(i), eight_.triangle(i))) {
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
  [[nodiscard]] bool IsCloser(double squared, std::uint32_t triangle) const {
    return squared < squared_ || (squared == squared_ && triangle < nearest_.triangle);
  }

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

Nearest NearSearch::Find(const NearList& list, const Vec3& p, double offset,
                         std::uint32_t hint) const {
  Search search(*this, p, hint);
  for (const NearTriangle& entry : list) {
    if (entry.distance - offset <= search.limit() && entry.triangle != hint &&
        boxes_[entry.triangle].CalcSquaredDistance(p) <= search.limit_squared()) {
      search.Look(entry.triangle);
    }
  }
  return search.Finish();
}

Nearest NearSearch::FindSigned(const NearList& list, const Vec3& p, double offset,
                               std::uint32_t hint) const {
  return GiveSign(p, Find(list, p, offset, hint));
}

Nearest NearSearch::FindSignedInBoxed(const BegunFilter& begun, const Vec3& p) const {
  const std::uint32_t lowest = begun.FindLowest();
  Search search(*this, p, lowest);
  for (const BoxedTriangle& entry : begun.list) {
    if (entry.squared <= search.limit_squared() && entry.triangle != lowest) {
      search.Look(entry.triangle);
    }
  }
  return GiveSign(p, search.Finish());
}

// Looks at pairs of a node and a triangle, eight at once, for the closest triangle to each node: of
// several as close, the one with the least number.
class NearSearch::NodeSearch {
 public:
  NodeSearch(const NearSearch& of, const NodeGrid& grid, std::array<Nearest, NodeGrid::kMost>* out)
      : eight_(of), out_(*out) {
    for (std::size_t k = 0; k < grid.count[2]; ++k) {
      for (std::size_t j = 0; j < grid.count[1]; ++j) {
        for (std::size_t i = 0; i < grid.count[0]; ++i) {
          points_[count_] = grid.NodeAt(i, j, k);
          out_[count_] = {};
          squared_[count_++] = kAnywhere;
        }
      }
    }
  }

  void Look(std::size_t node, std::uint32_t triangle) {
    nodes_[static_cast<std::size_t>(eight_.count())] = node;
    if (eight_.Add(triangle, points_[node])) {
      Finish();
    }
  }

  void LookEverywhere(std::uint32_t triangle) {
    for (std::size_t node = 0; node < count_; ++node) {
      Look(node, triangle);
    }
    Finish();
  }

  // Looks at what is left.
  void Finish() {
    eight_.Calc();
    for (int i = 0; i < eight_.count(); ++i) {
      const std::size_t node = nodes_[static_cast<std::size_t>(i)];
      const double squared = eight_.squared(i);
      Nearest& nearest = out_[node];
      if (squared < squared_[node] ||
          (squared == squared_[node] && eight_.triangle(i) < nearest.triangle)) {
        squared_[node] = squared;
        nearest.triangle = eight_.triangle(i);
        nearest.point = eight_.PointOf(i);
      }
    }
    eight_.Clear();
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  [[nodiscard]] const Vec3& point(std::size_t node) const { return points_[node]; }

  // The square of the least distance found.
  [[nodiscard]] double squared(std::size_t node) const { return squared_[node]; }

  // The largest of the least distances.
  [[nodiscard]] double FindMost() const {
    return std::sqrt(*std::max_element(squared_.data(), squared_.data() + count_));
  }

 private:
  EightTriangles eight_;
  std::array<std::size_t, EightTriangles::kMost> nodes_{};  // Of those that are looked at.
  std::array<Vec3, NodeGrid::kMost> points_;
  std::array<double, NodeGrid::kMost> squared_;
  std::size_t count_{0};
  std::array<Nearest, NodeGrid::kMost>& out_;
};

// The distance from a triangle is convex: from the middle of the grid, with its gradient there, it
// has a lower bound at each node. Few triangles have one that is less than the distance of what is
// closest to the middle.
template <typename List>
void NearSearch::FindSignedAtNodes(const List& list, std::uint32_t first, const NodeGrid& grid,
                                   NodeRoom* room,
                                   std::array<Nearest, NodeGrid::kMost>* out) const {
  constexpr double kSingle = 1e-6;  // Bounds are sums of four numbers, each rounded to 6e-8.
  NodeSearch search(*this, grid, out);
  search.LookEverywhere(first);
  const double reach = CalcLimit(search.FindMost(), 0);
  const TriangleBox around = BoxAround(grid);
  room->triangles.resize(list.size() + 1);  // One more than may be kept is written.
  std::size_t count = 0;
  for (const auto& entry : list) {
    const double squared = boxes_[entry.triangle].CalcSquaredDistance(around);
    room->triangles[count] = entry.triangle;
    count += squared <= reach * reach && entry.triangle != first ? 1 : 0;
  }
  room->triangles.resize(count);
  const std::uint32_t closest =
      FindSlopes({around.centre[0], around.centre[1], around.centre[2]}, room);
  if (closest != kNoFace) {
    search.LookEverywhere(closest);
  }
  const double rounding = kSingle * (reach + around.radius());
  for (std::size_t node = 0; node < search.count(); ++node) {
    const Vec3& p = search.point(node);
    const auto along = [&](std::size_t axis) {
      return Quad(static_cast<float>(p[static_cast<int>(axis)] - around.centre[axis]));
    };
    const Quad x = along(0);
    const Quad y = along(1);
    const Quad z = along(2);
    const Quad limit(static_cast<float>(CalcLimit(std::sqrt(search.squared(node)), 0) + rounding));
    for (std::size_t n = 0; n < count; n += 4) {
      const NodeRoom::Slopes& slopes = room->slopes[n / EightTriangles::kMost];
      const std::size_t i = n % EightTriangles::kMost;
      const Quad bound = Quad(&slopes.distance[i]) + Quad(&slopes.gradient[0][i]) * x +
                         (Quad(&slopes.gradient[1][i]) * y + Quad(&slopes.gradient[2][i]) * z);
      for (unsigned bits = BitsAtMost(bound, limit); bits != 0; bits &= bits - 1) {
        search.Look(node, room->triangles[n + static_cast<std::size_t>(std::countr_zero(bits))]);
      }
    }
  }
  search.Finish();
  for (std::size_t node = 0; node < search.count(); ++node) {
    Nearest& nearest = (*out)[node];
    nearest.distance = std::sqrt(search.squared(node));
    nearest = GiveSign(search.point(node), nearest);
  }
}

std::uint32_t NearSearch::FindSlopes(const Vec3& middle, NodeRoom* room) const {
  constexpr float kLeast = 1e-12F;  // [m]; nearer than this a gradient is noise.
  constexpr std::size_t kEight = EightTriangles::kMost;  // What the kernel takes at once.
  const std::size_t count = room->triangles.size();
  room->slopes.resize((count + kEight - 1) / kEight);
  double least = kAnywhere;
  std::uint32_t closest = kNoFace;
  EightTriangles eight(*this, middle);
  for (std::size_t begin = 0; begin < count; begin += kEight) {
    eight.Clear();
    for (std::size_t n = begin; n < std::min(begin + kEight, count); ++n) {
      eight.Add(room->triangles[n]);
    }
    eight.Calc();
    for (int i = 0; i < eight.count(); ++i) {
      if (eight.squared(i) < least) {
        least = eight.squared(i);
        closest = eight.triangle(i);
      }
    }
    NodeRoom::Slopes& slopes = room->slopes[begin / kEight];
    for (int i = 0; i < static_cast<int>(kEight); ++i) {
      // Those that are not wanted are nowhere near.
      slopes.distance[i] = static_cast<float>(i < eight.count() ? eight.squared(i) : kAnywhere);
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < static_cast<int>(kEight); ++i) {
        slopes.gradient[axis][i] = static_cast<float>(middle[axis] - eight.closest().q.at[axis][i]);
      }
    }
    for (std::size_t i = 0; i < kEight; i += 4) {
      const Quad distance = Quad(&slopes.distance[i]).Root();
      distance.Store(&slopes.distance[i]);
      for (float* const way : slopes.gradient_rows(i)) {
        (Quad(way) / Most(distance, Quad(kLeast))).Store(way);
      }
    }
  }
  return closest;
}

template void NearSearch::FindSignedAtNodes(const BoxedList&, std::uint32_t, const NodeGrid&,
                                            NodeRoom*, std::array<Nearest, NodeGrid::kMost>*) const;
template void NearSearch::FindSignedAtNodes(const NearList&, std::uint32_t, const NodeGrid&,
                                            NodeRoom*, std::array<Nearest, NodeGrid::kMost>*) const;

std::optional<bool> NearSearch::FindSide(const NearList& list, const Vec3& p, double offset,
                                         std::uint32_t hint) const {
  const double distance = Find(list, p, offset, hint).distance;
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
