#include "sequence/gap_proof.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "contact/mesh.h"
#include "sequence/face_reliefs.h"
#include "spatial/box.h"

namespace hvas::sequence {
namespace {

using product::OccurrenceId;

constexpr double kZero = 1e-6;  // Of products of unit vectors: what rounding leaves. A choice.

/** The least distance of A x from b over x >= 0.
 Source: Lawson and Hanson, Solving Least Squares Problems, 1974, chapter 23. */
class NonNegativeLeastSquares {
 public:
  NonNegativeLeastSquares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b)
      : A_(A),
        b_(b),
        x_(Eigen::VectorXd::Zero(A.cols())),
        is_used_(static_cast<std::size_t>(A.cols()), false) {}

  double Solve() {
    // Lawson and Hanson: it ends; rounding may cycle.
    const Eigen::Index most_rounds = 10 * A_.cols() + 100;
    for (Eigen::Index round = 0; round < most_rounds; ++round) {
      const std::optional<Eigen::Index> best = FindSteepest();
      if (!best) {
        break;
      }
      is_used_[static_cast<std::size_t>(*best)] = true;
      while (!TrySolveUsed()) {
      }
    }
    return (A_ * x_ - b_).norm();
  }

 private:
  /** The unused variable that the distance falls fastest with. */
  [[nodiscard]] std::optional<Eigen::Index> FindSteepest() const {
    const Eigen::VectorXd gradient = A_.transpose() * (b_ - A_ * x_);
    std::optional<Eigen::Index> best;
    for (Eigen::Index i = 0; i < A_.cols(); ++i) {
      if (!is_used_[static_cast<std::size_t>(i)] && gradient[i] > kZero * kZero &&
          (!best || gradient[i] > gradient[*best])) {
        best = i;
      }
    }
    return best;
  }

  [[nodiscard]] std::vector<Eigen::Index> ListUsed() const {
    std::vector<Eigen::Index> used;
    for (Eigen::Index i = 0; i < A_.cols(); ++i) {
      if (is_used_[static_cast<std::size_t>(i)]) {
        used.push_back(i);
      }
    }
    return used;
  }

  /** Moves the used variables towards the least distance without a bound, until the first comes to
   zero and is used no more. Returns whether none had to. */
  bool TrySolveUsed() {
    const std::vector<Eigen::Index> used = ListUsed();
    if (used.empty()) {
      return true;
    }
    Eigen::MatrixXd columns(A_.rows(), static_cast<Eigen::Index>(used.size()));
    for (std::size_t k = 0; k < used.size(); ++k) {
      columns.col(static_cast<Eigen::Index>(k)) = A_.col(used[k]);
    }
    const Eigen::VectorXd z = columns.completeOrthogonalDecomposition().solve(b_);
    double share = 1;
    for (std::size_t k = 0; k < used.size(); ++k) {
      const double to = z[static_cast<Eigen::Index>(k)];
      if (to <= 0) {
        share = std::min(share, x_[used[k]] / std::max(x_[used[k]] - to, 1e-300));
      }
    }
    bool is_removed = false;
    for (std::size_t k = 0; k < used.size(); ++k) {
      double& value = x_[used[k]];
      value += share * (z[static_cast<Eigen::Index>(k)] - value);
      if (share < 1 && value <= kZero * kZero) {
        value = 0;
        is_used_[static_cast<std::size_t>(used[k])] = false;
        is_removed = true;
      }
    }
    return share == 1 || !is_removed;
  }

  const Eigen::MatrixXd& A_;
  const Eigen::VectorXd& b_;
  Eigen::VectorXd x_;
  std::vector<bool> is_used_;  // Variables that may be more than zero.
};

/** The motions that leave a part of revolution where it is: turns about its axis, or about the
 centre of a ball; none for others. In B, torque arms from `centre`. */
struct Revolution {
  Vec3 centre_B{Vec3::Zero()};
  std::vector<Vec3> axes_B;
};

Revolution FindRevolution(const product::Part& part) {
  constexpr double kSame = 1e-6;  // [m], and sine of an angle: the accuracy of CAD kernels.
  using spatial::SurfaceKind;
  Revolution revolution;
  revolution.centre_B = part.box_B.centre();
  const auto is_ball = [&](const product::Face& face) {
    return face.surface.kind == SurfaceKind::kSphere &&
           (face.surface.origin - part.faces.front().surface.origin).norm() < kSame;
  };
  if (!part.faces.empty() && std::all_of(part.faces.begin(), part.faces.end(), is_ball)) {
    revolution.centre_B = part.faces.front().surface.origin;
    revolution.axes_B = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    return revolution;
  }
  const auto round = std::find_if(part.faces.begin(), part.faces.end(), [](const auto& face) {
    const SurfaceKind kind = face.surface.kind;
    return kind == SurfaceKind::kCylinder || kind == SurfaceKind::kCone ||
           kind == SurfaceKind::kTorus;
  });
  if (round == part.faces.end()) {
    return revolution;
  }
  const Vec3 origin = round->surface.origin;
  const Vec3 axis = round->surface.axis;
  const bool is_round =
      std::all_of(part.faces.begin(), part.faces.end(), [&](const product::Face& face) {
        const bool is_along = face.surface.axis.cross(axis).norm() < kSame;
        const bool is_on = (face.surface.origin - origin).cross(axis).norm() < kSame;
        switch (face.surface.kind) {
          case SurfaceKind::kPlane:
            return is_along;
          case SurfaceKind::kSphere:
            return is_on;
          case SurfaceKind::kCylinder:
          case SurfaceKind::kCone:
          case SurfaceKind::kTorus:
            return is_along && is_on;
          case SurfaceKind::kFreeform:
            return false;
        }
        return false;
      });
  if (is_round) {
    revolution.centre_B = origin + axis.dot(part.box_B.centre() - origin) * axis;
    revolution.axes_B = {axis};
  }
  return revolution;
}

/** Normal in W of a face's exact surface near a point; none where it has no exact surface. */
std::optional<Vec3> FindNormal(const product::Product& product, OccurrenceId id, std::uint32_t face,
                               const Vec3& p_WC) {
  const product::Part& part = product.part_of(id);
  if (face >= part.faces.size()) {
    return std::nullopt;
  }
  const product::Pose& X_WB = product.occurrences[id.index()].X_WB;
  const auto at = spatial::CalcDistance(part.faces[face].surface, X_WB.Inverse() * p_WC);
  return at.is_valid ? std::optional<Vec3>(X_WB.q() * at.gradient) : std::nullopt;
}

double CalcTriangleDistance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return (p - contact::CalcClosestOnTriangle(p, a, b, c).q).norm();
}

/** A ball inside of a part. */
struct InnerBall {
  Vec3 centre_B{Vec3::Zero()};
  double radius{0};  // [m]
};

/** Where a ray from inside meets a mesh first; infinite where it does not.
 Source: Moeller and Trumbore, J. Graphics Tools 2, 1997. */
double CalcRayLength(const product::Mesh& mesh, const Vec3& from, const Vec3& direction) {
  constexpr double kSkin = 1e-7;  // [m]: past the triangle that the ray begins on.
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3& a = mesh.vertices[i];
    const Vec3 ab = mesh.vertices[j] - a;
    const Vec3 ac = mesh.vertices[k] - a;
    const Vec3 across = direction.cross(ac);
    const double det = ab.dot(across);
    if (det == 0) {
      continue;
    }
    const Vec3 to = from - a;
    const double u = to.dot(across) / det;
    const Vec3 q = to.cross(ab);
    const double v = direction.dot(q) / det;
    const double t = ac.dot(q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && t > kSkin) {
      nearest = std::min(nearest, t);
    }
  }
  return nearest;
}

double CalcMeshDistance(const product::Mesh& mesh, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : mesh.triangles) {
    nearest = std::min(
        nearest, CalcTriangleDistance(p, mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]));
  }
  return nearest;
}

/** Finds a large ball inside of a part: half-way along rays from its surface to the opposite one.
 */
InnerBall FindInnerBall(const product::Part& part) {
  constexpr std::size_t kMostRays = 64;  // A choice: each takes a pass over the triangles.
  const product::Mesh& mesh = part.mesh;
  InnerBall best;
  const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / kMostRays);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += stride) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 normal =
        (mesh.vertices[j] - mesh.vertices[i]).cross(mesh.vertices[k] - mesh.vertices[i]);
    if (normal.norm() == 0) {
      continue;
    }
    const Vec3 inward = -normal.normalized();
    const Vec3 from = (mesh.vertices[i] + mesh.vertices[j] + mesh.vertices[k]) / 3;
    const double length = CalcRayLength(mesh, from, inward);
    if (!std::isfinite(length) || 0.5 * length <= best.radius) {
      continue;
    }
    const Vec3 middle = from + 0.5 * length * inward;
    const double radius = CalcMeshDistance(mesh, middle);
    if (radius > best.radius) {
      best = {middle, radius};
    }
  }
  return best;
}

/** Cells of a box in W, and whether a ball's centre is certainly not in them. */
class CageGrid {
 public:
  CageGrid(const spatial::Box& box_W, double cell) : low_(box_W.low), cell_(cell) {
    for (int k = 0; k < 3; ++k) {
      counts_[static_cast<std::size_t>(k)] =
          std::max(1, static_cast<int>(std::ceil(box_W.size()[k] / cell)));
    }
    is_closed_.assign(static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(counts_[1]) *
                          static_cast<std::size_t>(counts_[2]),
                      false);
  }

  /** Closes the cells whose centre is nearer to a triangle than `reach`. */
  void Close(const Vec3& a, const Vec3& b, const Vec3& c, double reach) {
    std::array<int, 3> first{};
    std::array<int, 3> last{};
    for (int k = 0; k < 3; ++k) {
      const auto n = static_cast<std::size_t>(k);
      const double low = std::min({a[k], b[k], c[k]}) - reach - low_[k];
      const double high = std::max({a[k], b[k], c[k]}) + reach - low_[k];
      const double most = counts_[n];
      first[n] = static_cast<int>(std::ceil(std::clamp(low / cell_ - 0.5, 0.0, most)));
      last[n] = static_cast<int>(std::floor(std::clamp(high / cell_ - 0.5, -1.0, most - 1)));
    }
    for (int x = first[0]; x <= last[0]; ++x) {
      for (int y = first[1]; y <= last[1]; ++y) {
        for (int z = first[2]; z <= last[2]; ++z) {
          if (!is_closed_[At(x, y, z)] &&
              CalcTriangleDistance(CentreOf(x, y, z), a, b, c) < reach) {
            is_closed_[At(x, y, z)] = true;
          }
        }
      }
    }
  }

  /** Whether one gets from the cell of a point to the side of the box. */
  [[nodiscard]] bool IsOpenFrom(const Vec3& p_W) const {
    std::vector<bool> is_seen(is_closed_.size(), false);
    std::vector<std::array<int, 3>> open;
    std::array<int, 3> start{};
    for (int k = 0; k < 3; ++k) {
      const auto n = static_cast<std::size_t>(k);
      start[n] = std::clamp(static_cast<int>((p_W[k] - low_[k]) / cell_), 0, counts_[n] - 1);
    }
    open.push_back(start);
    is_seen[At(start[0], start[1], start[2])] = true;
    while (!open.empty()) {
      const std::array<int, 3> at = open.back();
      open.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        if (at[k] == 0 || at[k] == counts_[k] - 1) {
          return true;
        }
      }
      for (int x = at[0] - 1; x <= at[0] + 1; ++x) {
        for (int y = at[1] - 1; y <= at[1] + 1; ++y) {
          for (int z = at[2] - 1; z <= at[2] + 1; ++z) {
            const std::size_t next = At(x, y, z);
            if (!is_seen[next] && !is_closed_[next]) {
              is_seen[next] = true;
              open.push_back({x, y, z});
            }
          }
        }
      }
    }
    return false;
  }

 private:
  [[nodiscard]] std::size_t At(int x, int y, int z) const {
    return (static_cast<std::size_t>(x) * static_cast<std::size_t>(counts_[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(counts_[2]) +
           static_cast<std::size_t>(z);
  }

  [[nodiscard]] Vec3 CentreOf(int x, int y, int z) const {
    return low_ + cell_ * Vec3(x + 0.5, y + 0.5, z + 0.5);
  }

  Vec3 low_;
  double cell_;  // [m]
  std::array<int, 3> counts_{};
  std::vector<bool> is_closed_;
};

}  // namespace

bool DoRowsHold(const std::vector<Vec6>& rows, const std::vector<Vec6>& free) {
  // What is orthogonal to the free motions, as columns.
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(6, 6);
  if (!free.empty()) {
    Eigen::MatrixXd known(6, static_cast<Eigen::Index>(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i) {
      known.col(static_cast<Eigen::Index>(i)) = free[i];
    }
    const Eigen::MatrixXd q = known.householderQr().householderQ();
    basis = q.rightCols(6 - known.cols());
  }
  Eigen::MatrixXd columns(basis.cols(), static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = basis.transpose() * rows[i];
  }
  // How far a twist has to be from free for this to be sure: a choice, of lengths of one.
  constexpr double kLeastSingular = 1e-3;
  if (columns.cols() <= columns.rows() ||
      columns.jacobiSvd().singularValues().minCoeff() < kLeastSingular) {
    return false;
  }
  const Eigen::VectorXd sum = columns.rowwise().sum();
  return NonNegativeLeastSquares(columns, -sum).Solve() < kZero * std::max(1.0, sum.norm());
}

bool IsHeldByContacts(const product::Product& product, const contact::Scene& scene, OccurrenceId id,
                      std::span<const contact::IgnoredPair> ignored) {
  constexpr double kOpposite = 0.999;  // Cosine of 2.6 degrees: edges have no normal. A choice.
  const product::Pose& X_WB = product.occurrences[id.index()].X_WB;
  const product::Part& part = product.part_of(id);
  const Revolution revolution = FindRevolution(part);
  const Vec3 p_W = X_WB * revolution.centre_B;
  const double length = 0.5 * part.box_B.size().norm();
  contact::QueryWorkspace workspace;
  contact::QueryOptions query;
  query.margin = kDepthTolerance;
  query.ignored = ignored;
  query.self = contact::BodyId(id.index());
  scene.Query(scene.shape(query.self), X_WB, query, &workspace);
  std::vector<Vec6> rows;
  for (const contact::Contact& contact : workspace.contacts()) {
    if (!contact.body.is_valid() || std::abs(contact.distance) > kDepthTolerance) {
      continue;
    }
    const OccurrenceId other(contact.body.index());
    const auto own = FindNormal(product, id, contact.held_face, contact.p_WC);
    const auto its = FindNormal(product, other, contact.scene_face, contact.p_WC);
    const Vec3& n = contact.nhat_W;
    if (own && its && own->dot(n) < -kOpposite && its->dot(n) > kOpposite) {
      Vec6 row;
      row << n, (contact.p_WC - p_W).cross(n) / length;
      rows.push_back(row);
    }
  }
  std::vector<Vec6> free;
  for (const Vec3& axis_B : revolution.axes_B) {
    Vec6 twist;
    twist << Vec3::Zero(), X_WB.q() * axis_B;
    free.push_back(twist);
  }
  return DoRowsHold(rows, free);
}

double FindInnerRadius(const product::Part& part) {
  return FindInnerBall(part).radius;
}

Cage FindCage(const product::Product& product, OccurrenceId id,
              std::span<const OccurrenceId> others, double allowed) {
  constexpr double kMostCellsAcross = 96;  // A choice: a million cells take a tenth of a second.
  constexpr double kCellsPerRadius = 4;    // A choice: gaps of a third of the radius stay closed.
  constexpr double kLeastReach = 0.75;     // In cells: with less, walls have holes. A choice.
  const product::Part& part = product.part_of(id);
  const product::Pose& X_WB = product.occurrences[id.index()].X_WB;
  const InnerBall ball = FindInnerBall(part);
  Cage cage;
  cage.radius = ball.radius;
  // Meshes of parts deviate from their surfaces by no more than this in contact (docs/import.md).
  const double room = allowed + 2 * kDepthTolerance;
  const spatial::Box own = spatial::Transform(X_WB, part.box_B);
  for (const double beyond : {0.25, 1.0}) {  // Of the part's size, around it: choices.
    const Vec3 margin =
        beyond * own.size() + Vec3::Constant(2 * ball.radius + beyond * own.size().minCoeff());
    const spatial::Box box{own.low - margin, own.high + margin};
    const double cell =
        std::max(ball.radius / kCellsPerRadius, box.size().maxCoeff() / kMostCellsAcross);
    const double reach = ball.radius - room - 0.5 * std::sqrt(3.0) * cell;
    if (reach < kLeastReach * cell) {
      break;
    }
    CageGrid grid(box, cell);
    for (const OccurrenceId other : others) {
      const product::Mesh& mesh = product.part_of(other).mesh;
      const product::Pose& X_WO = product.occurrences[other.index()].X_WB;
      const spatial::Box other_box = spatial::Transform(X_WO, product.part_of(other).box_B);
      if (other == id || (other_box.low.array() > box.high.array()).any() ||
          (other_box.high.array() < box.low.array()).any()) {
        continue;
      }
      for (const auto& [i, j, k] : mesh.triangles) {
        grid.Close(X_WO * mesh.vertices[i], X_WO * mesh.vertices[j], X_WO * mesh.vertices[k],
                   reach);
      }
    }
    if (!grid.IsOpenFrom(X_WB * ball.centre_B)) {
      cage.is_closed = true;
      break;
    }
  }
  return cage;
}

}  // namespace hvas::sequence
