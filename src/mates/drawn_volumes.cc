#include "mates/drawn_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "product/mesh_ray.h"
#include "spatial/box_pairs.h"

namespace hvas::mates {
namespace {

using product::FaceId;
using product::OccurrenceId;
using product::Part;
using product::Pose;
using product::Product;

constexpr int kRays = 32;             // Along each side of the boxes' overlap: a choice.
constexpr int kMostRays = 64;         // Along a long side: a choice.
constexpr double kRayStep = 2e-3;     // [m]: along long sides rays lie no further apart. A choice.
constexpr double kShift = 0.4142136;  // Of a step: rays keep off the edges of what is drawn round.
constexpr std::size_t kMostPoints = 512;  // Whose depth is looked for: a choice.
constexpr std::size_t kMostInside = 64;   // Points of a part that is inside the other: a choice.
constexpr double kInterference = 1e-6;    // [m]: less is drawn equal.
constexpr double kTouching = 50e-6;       // [m]: faces of meshes that touch may lie this deep.

/** A triangle of a part and its face, in the frame F of a measurement. */
struct Facet {
  std::array<Vec3, 3> corners;
  FaceId face;
};

/** Where a ray goes through a surface. */
struct Crossing {
  double at{0};
  const Facet* facet{nullptr};
};

/** Where a ray enters or leaves the space that two parts share, and whose surface that is. */
struct Border {
  Vec3 p_F{Vec3::Zero()};
  Vec3 normal_F{Vec3::Zero()};
  FaceId face;
};

Vec3 NormalOf(const Facet& facet) {
  const auto& [a, b, c] = facet.corners;
  return (b - a).cross(c - a);
}

FaceId FaceAt(const Part& part, std::size_t triangle) {
  const auto next =
      std::upper_bound(part.faces.begin(), part.faces.end(), triangle,
                       [](std::size_t t, const product::Face& f) { return t < f.first_triangle; });
  return FaceId(static_cast<std::size_t>(next - part.faces.begin()) - 1);
}

/** The triangles of a part that a ray through a box, along one of its axes, can meet. */
std::vector<Facet> CollectFacets(const Part& part, const Pose& X_FB, const spatial::Box& box) {
  std::vector<Vec3> vertices;
  vertices.reserve(part.mesh.vertices.size());
  for (const Vec3& vertex : part.mesh.vertices) {
    vertices.push_back(X_FB * vertex);
  }
  std::vector<Facet> facets;
  for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
    const auto& [i, j, k] = part.mesh.triangles[t];
    const Vec3& a = vertices[i];
    const Vec3& b = vertices[j];
    const Vec3& c = vertices[k];
    const Vec3 low = a.cwiseMin(b).cwiseMin(c);
    const Vec3 high = a.cwiseMax(b).cwiseMax(c);
    const auto meets = (low.array() <= box.high.array()) && (high.array() >= box.low.array());
    if (meets.count() >= 2) {
      facets.push_back({{a, b, c}, FaceAt(part, t)});
    }
  }
  return facets;
}

/** The crossings of a grid of parallel rays with the surface of a part. */
class RayGrid {
 public:
  /** @param axis  Of F, along which the rays go. */
  RayGrid(const spatial::Box& box, int axis) : axis_(axis), box_(box) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double side = box.size()[k == 0 ? u() : v()];
      rays_[k] = std::clamp(static_cast<int>(side / kRayStep), kRays, kMostRays);
      step_[k] = side / rays_[k];
    }
  }

  [[nodiscard]] int u() const { return (axis_ + 1) % 3; }

  [[nodiscard]] int v() const { return (axis_ + 2) % 3; }

  [[nodiscard]] double cell() const { return step_[0] * step_[1]; }

  [[nodiscard]] double at(std::size_t k, int i) const {
    return box_.low[k == 0 ? u() : v()] + (i + kShift) * step_[k];
  }

  /** All rays one after the other, the crossings of each in their order. */
  [[nodiscard]] std::vector<std::vector<Crossing>> Cross(const std::vector<Facet>& facets) const {
    std::vector<std::vector<Crossing>> rays(static_cast<std::size_t>(rays_[0]) *
                                            static_cast<std::size_t>(rays_[1]));
    for (const Facet& facet : facets) {
      AddFacet(facet, &rays);
    }
    for (std::vector<Crossing>& ray : rays) {
      std::sort(ray.begin(), ray.end(),
                [](const Crossing& x, const Crossing& y) { return x.at < y.at; });
    }
    return rays;
  }

  /** Where the i-th ray is at a place along it. */
  [[nodiscard]] Vec3 PointOf(std::size_t ray, double along) const {
    Vec3 p;
    p[axis_] = along;
    p[u()] = at(0, static_cast<int>(ray) / rays_[1]);
    p[v()] = at(1, static_cast<int>(ray) % rays_[1]);
    return p;
  }

 private:
  /** The first and last ray that a facet can meet along a side. */
  [[nodiscard]] std::pair<int, int> RangeOf(const Facet& facet, std::size_t k) const {
    const int axis = k == 0 ? u() : v();
    const auto& [a, b, c] = facet.corners;
    const auto index = [&](double x) { return (x - box_.low[axis]) / step_[k] - kShift; };
    const double first = std::ceil(index(std::min({a[axis], b[axis], c[axis]})));
    const double last = std::floor(index(std::max({a[axis], b[axis], c[axis]})));
    return {static_cast<int>(std::clamp(first, 0.0, 1.0 * rays_[k])),
            static_cast<int>(std::clamp(last, -1.0, rays_[k] - 1.0))};
  }

  void AddFacet(const Facet& facet, std::vector<std::vector<Crossing>>* rays) const {
    const Vec3 normal = NormalOf(facet);
    if (normal[axis_] == 0) {
      return;
    }
    const Vec3& a = facet.corners[0];
    const auto [u_first, u_last] = RangeOf(facet, 0);
    const auto [v_first, v_last] = RangeOf(facet, 1);
    for (int i = u_first; i <= u_last; ++i) {
      for (int j = v_first; j <= v_last; ++j) {
        if (IsInside(facet, at(0, i), at(1, j))) {
          const double along =
              a[axis_] - (normal[u()] * (at(0, i) - a[u()]) + normal[v()] * (at(1, j) - a[v()])) /
                             normal[axis_];
          (*rays)[static_cast<std::size_t>(i * rays_[1] + j)].push_back({along, &facet});
        }
      }
    }
  }

  [[nodiscard]] bool IsInside(const Facet& facet, double x, double y) const {
    const auto side = [&](const Vec3& p, const Vec3& q) {
      return (q[u()] - p[u()]) * (y - p[v()]) - (q[v()] - p[v()]) * (x - p[u()]);
    };
    const auto& [a, b, c] = facet.corners;
    const double ab = side(a, b);
    const double bc = side(b, c);
    const double ca = side(c, a);
    return (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
  }

  int axis_;
  const spatial::Box& box_;
  std::array<int, 2> rays_{};
  std::array<double, 2> step_{};
};

/** What rays find of the space that two parts share. */
struct Found {
  double volume{0};
  int hits{0};
  std::vector<Border> of_a, of_b;  // Where the space ends, by whose surface that is.
};

/** Adds the piece of a ray that is inside both parts, where there is one, from where it enters and
 leaves each. @returns whether there is one. */
bool AddPiece(const RayGrid& grid, std::size_t ray, const Crossing* of_a, const Crossing* of_b,
              Found* found) {
  const bool begins_with_a = of_a[0].at > of_b[0].at;
  const bool ends_with_a = of_a[1].at < of_b[1].at;
  const Crossing& begin = begins_with_a ? of_a[0] : of_b[0];
  const Crossing& end = ends_with_a ? of_a[1] : of_b[1];
  if (end.at <= begin.at) {
    return false;
  }
  const auto border = [&](const Crossing& crossing) {
    return Border{grid.PointOf(ray, crossing.at), NormalOf(*crossing.facet).normalized(),
                  crossing.facet->face};
  };
  found->volume += (end.at - begin.at) * grid.cell();
  (begins_with_a ? found->of_a : found->of_b).push_back(border(begin));
  (ends_with_a ? found->of_a : found->of_b).push_back(border(end));
  return true;
}

Found Intersect(const RayGrid& grid, const std::vector<Facet>& a, const std::vector<Facet>& b) {
  Found found;
  const auto rays_a = grid.Cross(a);
  const auto rays_b = grid.Cross(b);
  for (std::size_t r = 0; r < rays_a.size(); ++r) {
    const std::vector<Crossing>& of_a = rays_a[r];
    const std::vector<Crossing>& of_b = rays_b[r];
    if (of_a.size() % 2 != 0 || of_b.size() % 2 != 0) {
      continue;  // The surface is open there.
    }
    bool is_hit = false;
    for (std::size_t i = 0; i + 1 < of_a.size(); i += 2) {
      for (std::size_t k = 0; k + 1 < of_b.size(); k += 2) {
        is_hit = AddPiece(grid, r, &of_a[i], &of_b[k], &found) || is_hit;
      }
    }
    found.hits += is_hit ? 1 : 0;
  }
  return found;
}

/** Intersects along all three axes; the volume is that of the axis with the most hits. */
Found IntersectAll(const spatial::Box& box, const std::vector<Facet>& a,
                   const std::vector<Facet>& b) {
  Found all;
  for (int axis = 0; axis < 3; ++axis) {
    Found found = Intersect(RayGrid(box, axis), a, b);
    if (found.hits > all.hits) {
      all.hits = found.hits;
      all.volume = found.volume;
    }
    all.of_a.insert(all.of_a.end(), found.of_a.begin(), found.of_a.end());
    all.of_b.insert(all.of_b.end(), found.of_b.begin(), found.of_b.end());
  }
  return all;
}

/** A box around all borders, a step of the rays in the wider box larger. */
spatial::Box BoxAround(const Found& found, const spatial::Box& wider) {
  spatial::Box box;
  for (const std::vector<Border>* borders : {&found.of_a, &found.of_b}) {
    for (const Border& border : *borders) {
      box.Add(border.p_F);
    }
  }
  const Vec3 step = wider.size() / kRays;
  return {(box.low - step).cwiseMax(wider.low), (box.high + step).cwiseMin(wider.high)};
}

/** Intersects once more where what is shared is much smaller than the boxes' overlap. */
Found IntersectClosely(const spatial::Box& box, const std::vector<Facet>& a,
                       const std::vector<Facet>& b) {
  constexpr double kMuch = 0.5;  // Of a side of the boxes' overlap: a choice.
  Found found = IntersectAll(box, a, b);
  if (found.hits == 0) {
    return found;
  }
  const spatial::Box close = BoxAround(found, box);
  if ((close.size().array() < kMuch * box.size().array()).any()) {
    if (Found again = IntersectAll(close, a, b); again.hits > 0) {
      return again;
    }
  }
  return found;
}

using Depths = std::map<std::pair<FaceId, FaceId>, double>;

/** Finds the nearest of some points: they are sorted along an axis, and looked at from there on. */
class NearestPoint {
 public:
  explicit NearestPoint(std::vector<Border> points) : points_(std::move(points)) {
    std::sort(points_.begin(), points_.end(),
              [](const Border& x, const Border& y) { return x.p_F.x() < y.p_F.x(); });
  }

  /** @pre There is one. */
  [[nodiscard]] const Border& Of(const Vec3& p_F) const {
    const auto at =
        std::lower_bound(points_.begin(), points_.end(), p_F.x(),
                         [](const Border& x, double along) { return x.p_F.x() < along; });
    const Border* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](const Border& point) {
      const double along = point.p_F.x() - p_F.x();
      if (along * along >= least) {
        return false;
      }
      if (const double distance = (point.p_F - p_F).squaredNorm(); distance < least) {
        least = distance;
        nearest = &point;
      }
      return true;
    };
    for (auto up = at; up != points_.end() && look(*up); ++up) {
    }
    for (auto down = at; down != points_.begin() && look(*std::prev(down)); --down) {
    }
    return *nearest;
  }

 private:
  std::vector<Border> points_;
};

/** Adds how deep the points of a surface lie inside the other one, by their faces: the distance to
 the plane of the nearest point. @param is_a  The points are those of the first part. */
void AddDepths(const std::vector<Border>& points, const std::vector<Border>& surface, bool is_a,
               Depths* depths) {
  if (surface.empty()) {
    return;
  }
  const NearestPoint nearest(surface);
  // Each ray has its points in pairs, one on either side of the part: an even step would leave out
  // a side.
  const std::size_t step = (1 + points.size() / kMostPoints) | 1U;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Border& point = points[i];
    const Border& other = nearest.Of(point.p_F);
    double& deepest =
        (*depths)[is_a ? std::pair(point.face, other.face) : std::pair(other.face, point.face)];
    deepest = std::max(deepest, std::abs((other.p_F - point.p_F).dot(other.normal_F)));
  }
}

/** Adds how deep a part lies whose surface is all inside the material of the other one: the
 shortest way out along the axes of F and the surface's normal. */
void AddInside(const std::vector<Border>& points, const Part& other, const Pose& X_FB, bool is_a,
               Depths* depths) {
  const Pose X_BF = X_FB.Inverse();
  const double reach = 2 * other.box_B.size().norm();
  const std::size_t step = (1 + points.size() / kMostInside) | 1U;  // As in AddDepths().
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Border& point = points[i];
    std::optional<product::RayHit> nearest;
    for (const Vec3& dir_F :
         std::array<Vec3, 7>{point.normal_F, Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitY(),
                             -Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitZ()}) {
      const auto hit = product::FindFirstHit(other, X_BF * point.p_F, X_BF.q() * dir_F,
                                             nearest ? nearest->distance : reach);
      nearest = hit ? hit : nearest;
    }
    if (nearest) {
      const FaceId face = FaceAt(other, nearest->triangle);
      double& deepest = (*depths)[is_a ? std::pair(point.face, face) : std::pair(face, point.face)];
      deepest = std::max(deepest, nearest->distance);
    }
  }
}

spatial::Box BoxOf(const Product& product, OccurrenceId id) {
  return spatial::Transform(product.occurrences[id.index()].X_WB, product.part_of(id).box_B);
}

/** The mates with a fit of two parts, in their order. */
using Fits = std::vector<const product::Mate*>;

/** The mate whose drawn radii overlap most; null where none do. */
const product::Mate* FindInterference(const Fits& fits) {
  const product::Mate* widest = nullptr;
  double most = kInterference;
  for (const product::Mate* mate : fits) {
    if (mate->shaft_radius - mate->hole_radius > most) {
      most = mate->shaft_radius - mate->hole_radius;
      widest = mate;
    }
  }
  return widest;
}

/** The first thread; null where there is none. */
const product::Mate* FindThread(const Fits& fits) {
  const auto found = std::find_if(fits.begin(), fits.end(), [](const product::Mate* mate) {
    return mate->fit->kind == product::FitKind::kThread;
  });
  return found == fits.end() ? nullptr : *found;
}

/** What of the space between two parts a mate explains. */
void Explain(const Fits& fits, SharedVolume* shared) {
  const product::Mate* mate = FindInterference(fits);
  // The ring that locks a nut is narrower than its thread: in ISO 7040 by 0.22 of the radius.
  constexpr double kRing = 0.3;  // Of the screw's radius: a choice.
  const product::Mate* thread = mate == nullptr ? FindThread(fits) : nullptr;
  if (thread != nullptr && shared->depth > kTouching &&
      shared->depth < kRing * thread->shaft_radius) {
    shared->mate = thread->id;
    shared->cause = SharedVolume::Cause::kThread;
    return;
  }
  const double interference = mate != nullptr ? mate->shaft_radius - mate->hole_radius : 0;
  if (mate == nullptr || shared->depth > interference + kTouching) {
    return;
  }
  shared->mate = mate->id;
  shared->depth = interference;
  shared->cause = mate->fit->kind == product::FitKind::kThread ? SharedVolume::Cause::kThread
                                                               : SharedVolume::Cause::kPressFit;
}

/** The exact interference of two cylinders about one axis, of which one is in the other. */
std::optional<double> CalcCylinderOverlap(const spatial::Surface& a, const spatial::Surface& b) {
  constexpr double kParallel = 1e-3;  // Sine: InferenceLimits::angle is 1.7e-3.
  const bool are_cylinders = a.kind == product::SurfaceKind::kCylinder &&
                             b.kind == product::SurfaceKind::kCylinder && a.outward != b.outward;
  if (!are_cylinders || a.axis.cross(b.axis).norm() > kParallel ||
      a.axis.cross(b.origin - a.origin).norm() > kTouching) {
    return std::nullopt;
  }
  return a.outward > 0 ? a.radius - b.radius : b.radius - a.radius;
}

/** The faces that lie in one another, the deepest first, each pair with its own depth. */
std::vector<FaceOverlap> ListFaces(const Product& product, const SharedVolume& shared,
                                   const Depths& depths) {
  constexpr double kInHole = 0.5;  // Of the radii's difference: a choice.
  const auto surface_of = [&](OccurrenceId id, FaceId face) {
    return face.is_valid() ? spatial::Transform(product.occurrences[id.index()].X_WB,
                                                product.part_of(id).faces[face.index()].surface)
                           : spatial::Surface();
  };
  std::vector<FaceOverlap> faces;
  for (const auto& [pair, depth] : depths) {
    const auto exact =
        CalcCylinderOverlap(surface_of(shared.a, pair.first), surface_of(shared.b, pair.second));
    // Where the nearest way out is another one, the shaft is not in that hole.
    const bool is_in_hole = exact && *exact > 0 && depth > kInHole * *exact;
    const bool is_clear = exact && *exact <= 0;  // What is measured comes of the meshes.
    faces.push_back({pair.first, pair.second,
                     is_in_hole ? *exact
                     : is_clear ? 0.0
                                : depth,
                     is_in_hole});
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const FaceOverlap& x, const FaceOverlap& y) { return x.depth > y.depth; });
  return faces;
}

/** Measures in the frame of the smaller part, so that equal pairs have equal rays through it. */
SharedVolume Measure(const Product& product, const Fits& fits, SharedVolume shared) {
  const Part& part_a = product.part_of(shared.a);
  const Part& part_b = product.part_of(shared.b);
  const bool is_a_smaller = part_a.box_B.size().prod() < part_b.box_B.size().prod();
  const Pose X_FW =
      product.occurrences[(is_a_smaller ? shared.a : shared.b).index()].X_WB.Inverse();
  const Pose X_FA = X_FW * product.occurrences[shared.a.index()].X_WB;
  const Pose X_FB = X_FW * product.occurrences[shared.b.index()].X_WB;
  const spatial::Box box_a = spatial::Transform(X_FA, part_a.box_B);
  const spatial::Box box_b = spatial::Transform(X_FB, part_b.box_B);
  const spatial::Box box{box_a.low.cwiseMax(box_b.low), box_a.high.cwiseMin(box_b.high)};
  // Without a fit, what is no deeper than faces that touch is not looked into.
  if (box.is_empty() || box.size().minCoeff() <= (fits.empty() ? kTouching : kInterference)) {
    return shared;
  }
  const Found found =
      IntersectClosely(box, CollectFacets(part_a, X_FA, box), CollectFacets(part_b, X_FB, box));
  shared.volume = found.volume;
  Depths depths;
  if (found.of_a.empty()) {
    AddInside(found.of_b, part_a, X_FA, false, &depths);
  } else if (found.of_b.empty()) {
    AddInside(found.of_a, part_b, X_FB, true, &depths);
  }
  AddDepths(found.of_a, found.of_b, true, &depths);
  AddDepths(found.of_b, found.of_a, false, &depths);
  shared.faces = ListFaces(product, shared, depths);
  shared.depth = shared.faces.empty() ? 0 : shared.faces.front().depth;
  Explain(fits, &shared);
  return shared;
}

}  // namespace

const char* ToString(SharedVolume::Cause cause) {
  switch (cause) {
    case SharedVolume::Cause::kPressFit:
      return "press_fit";
    case SharedVolume::Cause::kThread:
      return "thread";
    case SharedVolume::Cause::kOverlap:
      break;
  }
  return "overlap";
}

SharedVolume MeasureSharedVolume(const Product& product, OccurrenceId a, OccurrenceId b) {
  SharedVolume shared;
  shared.a = a;
  shared.b = b;
  Fits fits;
  for (const product::Mate& mate : product.mates) {
    if (mate.fit && mate.Joins(a, b)) {
      fits.push_back(&mate);
    }
  }
  return Measure(product, fits, shared);
}

std::vector<SharedVolume> ListSharedVolumes(const Product& product, WorkWatch* watch) {
  std::vector<spatial::Box> boxes;
  for (const product::Occurrence& occurrence : product.occurrences) {
    boxes.push_back(BoxOf(product, occurrence.id));
  }
  std::map<std::pair<OccurrenceId, OccurrenceId>, Fits> fits;
  for (const product::Mate& mate : product.mates) {
    if (mate.fit) {
      fits[std::minmax(mate.a.occurrence, mate.b.occurrence)].push_back(&mate);
    }
  }
  const Fits none;
  std::vector<SharedVolume> list;
  spatial::ForEachPair(boxes, 0, watch, [&](std::size_t a, std::size_t b) {
    SharedVolume shared;
    shared.a = OccurrenceId(a);
    shared.b = OccurrenceId(b);
    const auto known = fits.find(std::pair(shared.a, shared.b));
    shared = Measure(product, known == fits.end() ? none : known->second, shared);
    if (shared.cause != SharedVolume::Cause::kOverlap || shared.depth > kTouching) {
      list.push_back(shared);
    }
    return true;
  });
  return list;
}

}  // namespace hvas::mates
