#include "mates/drawn_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "spatial/box_pairs.h"

namespace hvas::mates {
namespace {

using product::OccurrenceId;
using product::Part;
using product::Pose;
using product::Product;

constexpr int kRays = 32;             // Along each side of the boxes' overlap: a choice.
constexpr double kShift = 0.4142136;  // Of a step: rays keep off the edges of what is drawn round.
constexpr std::size_t kMostPoints = 512;  // Whose depth is looked for: a choice.
constexpr double kInterference = 1e-6;    // [m]: less is drawn equal.
constexpr double kTouching = 50e-6;       // [m]: faces of meshes that touch may lie this deep.

/** Where a ray goes through a surface. */
struct Crossing {
  double at{0};
  Vec3 normal{Vec3::Zero()};
};

/** Where a ray enters or leaves the space that two parts share, and whose surface that is. */
struct Border {
  Vec3 p_W{Vec3::Zero()};
  Vec3 normal_W{Vec3::Zero()};
};

/** A part's triangles in W. */
struct Triangles {
  std::vector<Vec3> vertices;
  const Part* part{nullptr};

  Triangles(const Product& product, OccurrenceId id) : part(&product.part_of(id)) {
    const Pose& X_WB = product.occurrences[id.index()].X_WB;
    for (const Vec3& vertex : part->mesh.vertices) {
      vertices.push_back(X_WB * vertex);
    }
  }
};

/** The crossings of a grid of parallel rays with the surface of a part. */
class RayGrid {
 public:
  /** @param axis  Of W, along which the rays go. */
  RayGrid(const spatial::Box& box, int axis) : axis_(axis), box_(box) {
    step_ = {box.size()[u()] / kRays, box.size()[v()] / kRays};
  }

  [[nodiscard]] int u() const { return (axis_ + 1) % 3; }

  [[nodiscard]] int v() const { return (axis_ + 2) % 3; }

  [[nodiscard]] double cell() const { return step_[0] * step_[1]; }

  [[nodiscard]] double at(int k, int i) const {
    return box_.low[k == 0 ? u() : v()] + (i + kShift) * step_[static_cast<std::size_t>(k)];
  }

  /** All rays one after the other, the crossings of each in their order. */
  [[nodiscard]] std::vector<std::vector<Crossing>> Cross(const Triangles& triangles) const {
    std::vector<std::vector<Crossing>> rays(static_cast<std::size_t>(kRays) * kRays);
    for (const auto& [i, j, k] : triangles.part->mesh.triangles) {
      AddTriangle(triangles.vertices[i], triangles.vertices[j], triangles.vertices[k], &rays);
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
    p[u()] = at(0, static_cast<int>(ray) / kRays);
    p[v()] = at(1, static_cast<int>(ray) % kRays);
    return p;
  }

 private:
  void AddTriangle(const Vec3& a, const Vec3& b, const Vec3& c,
                   std::vector<std::vector<Crossing>>* rays) const {
    const Vec3 normal = (b - a).cross(c - a);
    if (normal[axis_] == 0) {
      return;
    }
    const auto range = [&](int k, int axis) {
      const double low = std::min({a[axis], b[axis], c[axis]});
      const double high = std::max({a[axis], b[axis], c[axis]});
      const double step = step_[static_cast<std::size_t>(k)];
      const auto index = [&](double x) { return (x - box_.low[axis]) / step - kShift; };
      return std::pair(static_cast<int>(std::clamp(std::ceil(index(low)), 0.0, 1.0 * kRays)),
                       static_cast<int>(std::clamp(std::floor(index(high)), -1.0, kRays - 1.0)));
    };
    const auto [u_first, u_last] = range(0, u());
    const auto [v_first, v_last] = range(1, v());
    for (int i = u_first; i <= u_last; ++i) {
      for (int j = v_first; j <= v_last; ++j) {
        if (IsInside(a, b, c, at(0, i), at(1, j))) {
          const double along =
              a[axis_] - (normal[u()] * (at(0, i) - a[u()]) + normal[v()] * (at(1, j) - a[v()])) /
                             normal[axis_];
          (*rays)[static_cast<std::size_t>(i * kRays + j)].push_back({along, normal.normalized()});
        }
      }
    }
  }

  [[nodiscard]] bool IsInside(const Vec3& a, const Vec3& b, const Vec3& c, double x,
                              double y) const {
    const auto side = [&](const Vec3& p, const Vec3& q) {
      return (q[u()] - p[u()]) * (y - p[v()]) - (q[v()] - p[v()]) * (x - p[u()]);
    };
    const double ab = side(a, b);
    const double bc = side(b, c);
    const double ca = side(c, a);
    return (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
  }

  int axis_;
  const spatial::Box& box_;
  std::array<double, 2> step_{};
};

/** What rays in one direction find of the space that two parts share. */
struct Found {
  double volume{0};
  int hits{0};
  std::vector<Border> of_a, of_b;  // Where the space ends, by whose surface that is.
};

/** Adds the piece of a ray that is inside both parts, where there is one, from where it enters and
 leaves either. Returns whether there is one. */
bool AddPiece(const RayGrid& grid, std::size_t ray, const Crossing* of_a, const Crossing* of_b,
              Found* found) {
  const bool begins_with_a = of_a[0].at > of_b[0].at;
  const bool ends_with_a = of_a[1].at < of_b[1].at;
  const Crossing& begin = begins_with_a ? of_a[0] : of_b[0];
  const Crossing& end = ends_with_a ? of_a[1] : of_b[1];
  if (end.at <= begin.at) {
    return false;
  }
  found->volume += (end.at - begin.at) * grid.cell();
  (begins_with_a ? found->of_a : found->of_b)
      .push_back({grid.PointOf(ray, begin.at), begin.normal});
  (ends_with_a ? found->of_a : found->of_b).push_back({grid.PointOf(ray, end.at), end.normal});
  return true;
}

Found Intersect(const RayGrid& grid, const Triangles& a, const Triangles& b) {
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

/** How deep the deepest of these points lies inside the other surface: the distance to the plane of
 its nearest point. */
double CalcDepth(const std::vector<Border>& points, const std::vector<Border>& surface) {
  double deepest = 0;
  const std::size_t step = 1 + points.size() / kMostPoints;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Border& point = points[i];
    double nearest = std::numeric_limits<double>::infinity();
    double depth = 0;
    for (const Border& other : surface) {
      const Vec3 d = other.p_W - point.p_W;
      if (d.squaredNorm() < nearest) {
        nearest = d.squaredNorm();
        depth = std::abs(d.dot(other.normal_W));
      }
    }
    deepest = std::max(deepest, depth);
  }
  return deepest;
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

SharedVolume Measure(const Product& product, const Fits& fits, const Triangles& a,
                     const Triangles& b, SharedVolume shared) {
  const spatial::Box box_a = BoxOf(product, shared.a);
  const spatial::Box box_b = BoxOf(product, shared.b);
  const spatial::Box box{box_a.low.cwiseMax(box_b.low), box_a.high.cwiseMin(box_b.high)};
  if (box.is_empty() || box.size().minCoeff() <= kInterference) {
    return shared;
  }
  std::vector<Border> of_a;
  std::vector<Border> of_b;
  int most_hits = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Found found = Intersect(RayGrid(box, axis), a, b);
    if (found.hits > most_hits) {
      most_hits = found.hits;
      shared.volume = found.volume;
    }
    of_a.insert(of_a.end(), found.of_a.begin(), found.of_a.end());
    of_b.insert(of_b.end(), found.of_b.begin(), found.of_b.end());
  }
  shared.depth = std::max(CalcDepth(of_a, of_b), CalcDepth(of_b, of_a));
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
  return Measure(product, fits, Triangles(product, a), Triangles(product, b), shared);
}

std::vector<SharedVolume> ListSharedVolumes(const Product& product, WorkWatch* watch) {
  std::vector<spatial::Box> boxes;
  for (const product::Occurrence& occurrence : product.occurrences) {
    boxes.push_back(BoxOf(product, occurrence.id));
  }
  std::vector<std::optional<Triangles>> triangles(boxes.size());
  const auto triangles_of = [&](std::size_t i) -> const Triangles& {
    if (!triangles[i]) {
      triangles[i].emplace(product, OccurrenceId(i));
    }
    return *triangles[i];
  };
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
    shared = Measure(product, known == fits.end() ? none : known->second, triangles_of(a),
                     triangles_of(b), shared);
    if (shared.cause != SharedVolume::Cause::kOverlap || shared.depth > kTouching) {
      list.push_back(shared);
    }
    return true;
  });
  return list;
}

}  // namespace hvas::mates
