#include "contact/smooth_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

namespace hvas::contact {
namespace {

// The surface leaves an edge by no more than this share of the part's diagonal, four times what the
// meshes of CAD faces do, or 16 um: coarser meshes are taken as they are. Choices.
constexpr double kMostSag = 3.2e-4;
constexpr double kLeastSag = 16e-6;  // [m]
constexpr double kSagOfBend = 0.25;  // A parabola's height in the middle.
constexpr int kFitRings =
    2;  // Rings of triangles beside those of a corner, for its normal: a choice.
constexpr int kMostTriangles = 64;  // Bounds the triangles on the way to a foot: a choice.
// Steps of Newton's method: each leaves distance / radius of what was wrong beside the foot, whose
// square is wrong in the distance.
constexpr int kFootSteps = 2;
constexpr double kWithin = 1e-9;        // Weights this far below zero are within: rounding.
constexpr double kContinued = 1.0 / 3;  // How far a patch is continued beyond a rim, in weights.
constexpr double kFarFoot = 0.5;        // Weights below which the patch is not asked yet.

struct Weights {
  double a;
  double b;
  double c;

  [[nodiscard]] double least() const { return std::min({a, b, c}); }

  [[nodiscard]] std::size_t corner_of_least() const {
    return a <= b && a <= c ? 0 : (b <= c ? 1 : 2);
  }
};

Weights MakeWeights(double u, double v) {
  return {1 - u - v, u, v};
}

class Patch {
 public:
  Patch(const Mesh& mesh, std::uint32_t t)
      : a_(mesh.vertices[mesh.triangles[t][0]]),
        ab_(mesh.vertices[mesh.triangles[t][1]] - a_),
        ac_(mesh.vertices[mesh.triangles[t][2]] - a_),
        bend0_(mesh.bends[t][0].full()),
        bend1_(mesh.bends[t][1].full()),
        bend2_(mesh.bends[t][2].full()) {}

  [[nodiscard]] Vec3 At(const Weights& w) const {
    return a_ + w.b * ab_ + w.c * ac_ - w.a * w.b * bend0_ - w.b * w.c * bend1_ -
           w.c * w.a * bend2_;
  }

  // Derivative by the weight of the second corner.
  [[nodiscard]] Vec3 AlongB(const Weights& w) const {
    return ab_ - (w.a - w.b) * bend0_ - w.c * (bend1_ - bend2_);
  }

  // Derivative by the weight of the third corner.
  [[nodiscard]] Vec3 AlongC(const Weights& w) const {
    return ac_ + w.b * (bend0_ - bend1_) - (w.a - w.c) * bend2_;
  }

  // The foot of p on the plane of the corners.
  [[nodiscard]] bool StartAt(const Vec3& p, Weights* w) const { return Step(ab_, ac_, p - a_, w); }

  // One step towards the foot of p on the patch.
  [[nodiscard]] bool Improve(const Vec3& p, Weights* w) const {
    Weights change{};
    if (!Step(AlongB(*w), AlongC(*w), p - At(*w), &change)) {
      return false;
    }
    *w = MakeWeights(w->b + change.b, w->c + change.c);
    return true;
  }

 private:
  static bool Step(const Vec3& x, const Vec3& y, const Vec3& r, Weights* w) {
    const double xx = x.squaredNorm();
    const double xy = x.dot(y);
    const double yy = y.squaredNorm();
    const double det = xx * yy - xy * xy;
    if (!(det > 1e-12 * xx * yy)) {
      return false;  // A sliver: its neighbours have the foot as well.
    }
    const double rx = r.dot(x);
    const double ry = r.dot(y);
    *w = MakeWeights((rx * yy - ry * xy) / det, (ry * xx - rx * xy) / det);
    return true;
  }

  const Vec3& a_;
  Vec3 ab_;
  Vec3 ac_;
  Vec3 bend0_;
  Vec3 bend1_;
  Vec3 bend2_;
};

CurvedPoint PointAt(const Patch& patch, std::uint32_t triangle, const Weights& w) {
  CurvedPoint point;
  point.q = patch.At(w);
  point.normal = patch.AlongB(w).cross(patch.AlongC(w)).normalized();
  point.triangle = triangle;
  point.is_inside = w.least() >= -kWithin;
  return point;
}

// The triangle across an edge where the face goes on; else none.
std::uint32_t AcrossWithinFace(const Mesh& mesh, std::uint32_t t, std::size_t k) {
  return mesh.IsRim(t, k) ? kNoFace : mesh.neighbour[t][k];
}

// The triangle across an edge where the smooth surface goes on, also into another freeform face
// that bends.
std::uint32_t AcrossSmooth(const Mesh& mesh, std::uint32_t t, std::size_t k) {
  const std::uint32_t next = mesh.neighbour[t][k];
  if (next == kNoFace || mesh.edge_kind[t][k] != EdgeKind::kSmooth) {
    return kNoFace;
  }
  const auto bends = [](const ShortVec3& bend) { return bend.v != ShortVec3().v; };
  return mesh.face[next] == mesh.face[t] ||
                 std::any_of(mesh.bends[next].begin(), mesh.bends[next].end(), bends)
             ? next
             : kNoFace;
}

// Fits paraboloids to the corners around a corner.
class NormalFinder {
 public:
  NormalFinder(const std::vector<spatial::Surface>& faces, const Mesh& mesh)
      : faces_(faces), mesh_(mesh), found_by_(mesh.triangles.size(), 0) {}

  /** The normal in corner k of triangle t, for all triangles around it in this face: those are told
   to `visit` with the number of their corner. */
  template <typename Visit>
  Vec3 Find(std::uint32_t t, std::size_t k, Visit visit) {
    const std::uint32_t v = mesh_.triangles[t][k];
    near_.clear();
    ++search_;
    corner_normal_.setZero();
    has_analytic_ = false;
    Walk(t, k, v, true, visit);
    Walk(t, k, v, false, visit);
    return has_analytic_ ? analytic_ : Fit(mesh_.vertices[v]);
  }

 private:
  // Goes around a corner from triangle to triangle, one way.
  template <typename Visit>
  void Walk(std::uint32_t t, std::size_t k, std::uint32_t v, bool is_forward, Visit visit) {
    Mesh::Corner at{t, k};
    for (;;) {
      if (AddNear(at.triangle)) {
        corner_normal_ += Angle(at.triangle, at.k) * mesh_.NormalOf(at.triangle);
        visit(at.triangle, at.k);
      } else if (at.triangle != t) {
        return;
      }
      const std::size_t edge = is_forward ? at.k : (at.k + 2) % 3;
      if (AcrossWithinFace(mesh_, at.triangle, edge) == kNoFace) {
        NoteAnalytic(at.triangle, edge, v);
        return;
      }
      at = mesh_.TurnAbout(at, is_forward);
      if (at.triangle == kNoFace || at.triangle == t) {
        return;
      }
    }
  }

  // False where it is there already.
  bool AddNear(std::uint32_t t) {
    if (found_by_[t] == search_) {
      return false;
    }
    found_by_[t] = search_;
    near_.push_back(t);
    return true;
  }

  [[nodiscard]] double Angle(std::uint32_t t, std::size_t k) const {
    const auto& c = mesh_.triangles[t];
    const Vec3 x = mesh_.vertices[c[(k + 1) % 3]] - mesh_.vertices[c[k]];
    const Vec3 y = mesh_.vertices[c[(k + 2) % 3]] - mesh_.vertices[c[k]];
    return std::atan2(x.cross(y).norm(), x.dot(y));
  }

  // Where the face goes over into an analytic one, that one's normal is known.
  void NoteAnalytic(std::uint32_t t, std::size_t edge, std::uint32_t v) {
    const std::uint32_t other = mesh_.neighbour[t][edge];
    if (other == kNoFace || mesh_.edge_kind[t][edge] != EdgeKind::kSmooth ||
        mesh_.face[other] == mesh_.face[t]) {
      return;
    }
    const auto exact = spatial::CalcDistance(faces_[mesh_.face[other]], mesh_.vertices[v]);
    if (exact.is_valid && std::abs(exact.distance) < kOnSurface) {
      analytic_ = exact.gradient;
      has_analytic_ = true;
    }
  }

  void AddRings() {
    for (int ring = 0; ring < kFitRings; ++ring) {
      const std::size_t end = near_.size();
      for (std::size_t i = 0; i < end; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t next = AcrossWithinFace(mesh_, near_[i], k);
          if (next != kNoFace) {
            AddNear(next);
          }
        }
      }
    }
  }

  // Heights z = a x + b y + (c x^2 + 2 d x y + e y^2) / 2 over the plane of the triangles' mean
  // normal, by least squares that count what is near more. Where two rows of corners do not tell
  // slope from curvature, it is slope.
  Vec3 Fit(const Vec3& origin) {
    using Vec5 = Eigen::Matrix<double, 5, 1>;
    using Mat5 = Eigen::Matrix<double, 5, 5>;
    const double length = corner_normal_.norm();
    if (!(length > 0)) {
      return Vec3::Zero();
    }
    Vec3 n = corner_normal_ / length;
    AddRings();
    points_.clear();
    for (const std::uint32_t t : near_) {
      points_.insert(points_.end(), mesh_.triangles[t].begin(), mesh_.triangles[t].end());
    }
    std::sort(points_.begin(), points_.end());
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
    const Vec3 x = n.unitOrthogonal();
    const Vec3 y = n.cross(x);
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t point : points_) {
      const double squared = (mesh_.vertices[point] - origin).squaredNorm();
      nearest = squared > 0 ? std::min(nearest, squared) : nearest;
    }
    if (!std::isfinite(nearest)) {
      return n;
    }
    const double unit = 1 / std::sqrt(nearest);
    Mat5 A = Mat5::Zero();
    Vec5 b = Vec5::Zero();
    for (const std::uint32_t point : points_) {
      const Vec3 r = unit * (mesh_.vertices[point] - origin);
      const double squared = r.squaredNorm();
      if (!(squared > 0)) {
        continue;
      }
      const double px = r.dot(x);
      const double py = r.dot(y);
      Vec5 row;
      row << px, py, 0.5 * px * px, px * py, 0.5 * py * py;
      const double weight = 1 / (squared * squared);
      A += weight * row * row.transpose();
      b += weight * r.dot(n) * row;
    }
    constexpr double kPreferSlope = 1e-9;  // Far below what corners tell: a choice.
    A.diagonal() += kPreferSlope * (Vec5() << 1e-3, 1e-3, 1, 1, 1).finished();
    const Vec5 fit = A.ldlt().solve(b);
    const Vec3 fitted = (n - fit[0] * x - fit[1] * y).normalized();
    constexpr double kFarOff = 0.9;  // Cosine, 26 degrees from the mean: no paraboloid. A choice.
    return fitted.allFinite() && fitted.dot(n) > kFarOff ? fitted : n;
  }

  const std::vector<spatial::Surface>& faces_;
  const Mesh& mesh_;
  std::vector<std::uint32_t> near_;
  std::vector<std::uint32_t> found_by_;  // The number of the search that found a triangle last.
  std::uint32_t search_{0};
  std::vector<std::uint32_t> points_;
  Vec3 corner_normal_{Vec3::Zero()};
  Vec3 analytic_{Vec3::Zero()};
  bool has_analytic_{false};
};

Vec3 CalcBend(const Vec3& d, const Vec3& n0, const Vec3& n1, double most_sag) {
  const Vec3 sum = n0 + n1;
  const double length = sum.norm();
  const double cosine = 0.5 * length;  // The cosine of half the angle between the normals.
  constexpr double kTooFar = 0.7;      // 90 degrees between the normals: an edge, no arc. A choice.
  if (!(cosine > kTooFar)) {
    return Vec3::Zero();
  }
  const double size = 0.5 * (n0.dot(d) - n1.dot(d)) / cosine;
  return kSagOfBend * std::abs(size) <= most_sag ? Vec3(size / length * sum) : Vec3::Zero();
}

/** Normals at the corners of triangles; zero where they are not known. */
using CornerNormals = std::vector<std::array<Vec3, 3>>;

/** Finds the normals at the corners of the triangles that are wanted, once for all triangles around
 a corner. */
CornerNormals FindCornerNormals(const std::vector<spatial::Surface>& faces, const Mesh& mesh,
                                const std::vector<std::uint32_t>& wanted) {
  const std::size_t count = mesh.triangles.size();
  CornerNormals normals(count, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
  std::vector<std::array<bool, 3>> is_known(count, {false, false, false});
  NormalFinder finder(faces, mesh);
  std::vector<std::pair<std::uint32_t, std::size_t>> around;
  for (const std::uint32_t t : wanted) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (is_known[t][k]) {
        continue;
      }
      around.clear();
      const Vec3 n = finder.Find(t, k, [&](std::uint32_t triangle, std::size_t corner) {
        around.emplace_back(triangle, corner);
      });
      for (const auto& [triangle, corner] : around) {
        normals[triangle][corner] = n;
        is_known[triangle][corner] = true;
      }
    }
  }
  return normals;
}

/** Finds the normal at a vertex of triangle t on its edge k. A freeform face that goes over into
 another one shares the edge with it. */
Vec3 FindEdgeNormal(const ExactTable& exact, const Mesh& mesh, const CornerNormals& normals,
                    std::uint32_t t, std::size_t k, std::size_t corner) {
  Vec3 n = normals[t][corner];
  const std::uint32_t other = mesh.neighbour[t][k];
  if (other != kNoFace && mesh.edge_kind[t][k] == EdgeKind::kSmooth &&
      exact.IsFreeform(mesh.face[other])) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (mesh.triangles[other][j] == mesh.triangles[t][corner]) {
        n += normals[other][j];
      }
    }
  }
  return n;
}

}  // namespace

void FindBends(double diagonal, ExactTable* exact, Mesh* mesh) {
  const double most_sag = std::max(kMostSag * diagonal, kLeastSag);
  const auto count = static_cast<std::uint32_t>(mesh->triangles.size());
  mesh->bends.clear();
  std::vector<std::uint32_t> wanted;
  for (std::uint32_t t = 0; t < count; ++t) {
    if (exact->IsFreeform(mesh->face[t])) {
      wanted.push_back(t);
    }
  }
  if (wanted.empty()) {
    return;
  }
  const CornerNormals normals = FindCornerNormals(exact->faces, *mesh, wanted);
  mesh->bends.assign(count, {});
  for (const std::uint32_t t : wanted) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const Vec3 n0 = FindEdgeNormal(*exact, *mesh, normals, t, k, k);
      const Vec3 n1 = FindEdgeNormal(*exact, *mesh, normals, t, k, next);
      if (!n0.isZero() && !n1.isZero()) {
        const auto& corners = mesh->triangles[t];
        const Vec3 bend = CalcBend(mesh->vertices[corners[next]] - mesh->vertices[corners[k]],
                                   n0.normalized(), n1.normalized(), most_sag);
        mesh->bends[t][k] = ShortVec3(bend);
        double& deviation = exact->deviation[mesh->face[t]];
        deviation = std::max(deviation, kSagOfBend * bend.norm());
      }
    }
  }
}

CurvedPoint PointOfPatch(const Mesh& mesh, std::uint32_t triangle, double u, double v) noexcept {
  return PointAt(Patch(mesh, triangle), triangle, MakeWeights(u, v));
}

bool FindFoot(const Mesh& mesh, std::uint32_t triangle, const Vec3& p, FootOn on,
              CurvedPoint* foot) noexcept {
  const auto across = on == FootOn::kFace ? &AcrossWithinFace : &AcrossSmooth;
  std::array<std::uint32_t, kMostTriangles> visited;
  std::size_t count = 0;
  std::uint32_t t = triangle;
  for (;;) {
    const Patch patch(mesh, t);
    Weights w{};
    if (!patch.StartAt(p, &w)) {
      return false;
    }
    for (int step = 0; step < kFootSteps && w.least() > -kFarFoot; ++step) {
      if (!patch.Improve(p, &w)) {
        return false;
      }
    }
    if (w.least() >= -kWithin) {
      *foot = PointAt(patch, t, w);
      return true;
    }
    visited[count++] = t;
    // On across the edge that the foot is beyond most, or beyond at all.
    const std::array<double, 3> weights{w.a, w.b, w.c};
    const std::size_t least = w.corner_of_least();
    std::uint32_t next = across(mesh, t, (least + 1) % 3);
    bool is_rim = next == kNoFace;
    for (std::size_t i = 1; i < 3 && is_rim; ++i) {
      const std::size_t corner = (least + i) % 3;
      if (weights[corner] < -kWithin) {
        next = across(mesh, t, (corner + 1) % 3);
        is_rim = next == kNoFace;
      }
    }
    const bool is_again = std::find(visited.begin(), visited.begin() + count, next) !=
                          visited.begin() + static_cast<std::ptrdiff_t>(count);
    if (is_rim || is_again || count == visited.size()) {
      // Beside a ridge both sides may say that the foot is on the other one: it is on the ridge.
      *foot = PointAt(patch, t, w);
      foot->is_inside = is_again && w.least() > -kContinued;
      return w.least() > -kContinued && foot->q.allFinite();
    }
    t = next;
  }
}

}  // namespace hvas::contact
