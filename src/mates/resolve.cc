#include "mates/resolve.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "mates/mate_kind.h"

namespace hvas::mates {
namespace {

using product::MateKind;

constexpr double kConverged = 1e-10;      // [m]: the rounding of poses of some metres.
constexpr double kSmallestLength = 1e-3;  // [m]: mates closer together turn nothing. A choice.
constexpr double kLoneLength = 10e-3;     // One mate alone gives no length [m].
// Newton's steps at most, and how often one is halved until it is an improvement: choices;
// resolve_test has how many are taken.
constexpr int kMaxIterations = 40;
constexpr int kMaxHalvings = 8;

using Row = Eigen::Matrix<double, 1, 7>;
using Triangle = Eigen::Matrix<double, 6, 7>;

Vec3 AxisOf(const Pose& X_WC) {
  return X_WC.q() * Vec3::UnitZ();
}

/** Where z_N has to point. */
Vec3 TargetOf(const MateConstraint& mate) {
  const Vec3 zhat_W = AxisOf(mate.X_WM);
  return mate.kind == MateKind::kFaceFace ? Vec3(-zhat_W) : zhat_W;
}

/** Rotation vector that takes the held axis to where it has to point. */
Vec3 CalcTurn(const MateConstraint& mate, const Vec3& zhat_N_W) {
  if (!HoldsDirection(mate.kind)) {
    return Vec3::Zero();
  }
  return spatial::RotationVector(spatial::RotationTaking(zhat_N_W, TargetOf(mate)));
}

struct Scale {
  Vec3 p_WR{Vec3::Zero()};
  double length{kLoneLength};
};

/** Mean of the held connectors, of axes if there are any, else of centres, and how far all of them
 (in B) spread from it. Independent of the pose. A turn that is left free is about an axis or a
 centre, so a reference point on it stays where it is and turning does not mix with sliding. */
Scale CalcScale(std::span<const MateConstraint> mates, const Pose& X_WB) {
  Scale scale;
  const auto is_axis = [](const MateConstraint& mate) { return IsAxial(mate.kind); };
  const auto is_centre = [](const MateConstraint& mate) { return IsCentre(mate.kind); };
  const bool has_axis = std::any_of(mates.begin(), mates.end(), is_axis);
  const bool has_centre = std::any_of(mates.begin(), mates.end(), is_centre);
  Vec3 mean_B = Vec3::Zero();
  double count = 0;
  for (const MateConstraint& mate : mates) {
    if (has_axis ? is_axis(mate) : !has_centre || is_centre(mate)) {
      mean_B += mate.X_BN.p();
      ++count;
    }
  }
  mean_B /= std::max(count, 1.0);
  double spread = 0;
  for (const MateConstraint& mate : mates) {
    spread = std::max(spread, (mate.X_BN.p() - mean_B).norm());
  }
  scale.p_WR = X_WB * mean_B;
  scale.length = spread > kSmallestLength ? spread : kLoneLength;
  return scale;
}

/** The stacked equations as a triangle R with the right side in its last column: rows are turned
 in one at a time (Givens), so any number of mates takes the same memory, and the singular values
 are those of the whole, not their squares. */
class Equations {
 public:
  void Add(const Vec3& w, const Vec3& v, double right) {
    Row row;
    row << w.transpose(), v.transpose(), right;
    for (Eigen::Index k = 0; k < 6; ++k) {
      const double y = row[k];
      if (y == 0) {
        continue;
      }
      const double x = R_(k, k);
      const double norm = std::hypot(x, y);
      const double c = x / norm;
      const double s = y / norm;
      const Row turned = c * R_.row(k) + s * row;
      row = c * row - s * R_.row(k);
      R_.row(k) = turned;
    }
  }

  [[nodiscard]] Mat6 matrix() const { return R_.leftCols<6>(); }

  [[nodiscard]] Vec6 right_side() const { return R_.col(6); }

 private:
  Triangle R_{Triangle::Zero()};
};

/** Linearised at X_WB in the unknowns (L w, v of the reference point). */
Equations Linearise(std::span<const MateConstraint> mates, const Pose& X_WB, const Scale& scale) {
  Equations equations;
  for (const MateConstraint& mate : mates) {
    const Pose X_WN = X_WB * mate.X_BN;
    const Vec3 arm_W = (X_WN.p() - scale.p_WR) / scale.length;
    const MateEquations of_mate = CalcEquations(mate, X_WN);
    for (std::size_t i = 0; i < of_mate.count; ++i) {
      const MateEquation& equation = of_mate.items[i];
      if (equation.is_tilt) {
        equations.Add(equation.axis_W, Vec3::Zero(), scale.length * equation.right);
      } else {
        equations.Add(arm_W.cross(equation.axis_W), equation.axis_W, equation.right);
      }
    }
  }
  return equations;
}

/** Turns the first `count` columns of a matrix among each other until they are orthogonal and in
 order of falling length, and those of a second one with them: one-sided Jacobi (Hestenes, 1958).
 With the identity as the second, the lengths become the first one's singular values and the second
 its right vectors. */
void MakeColumnsOrthogonal(int count, Mat6* matrix, Mat6* follower) {
  // A bound of Jacobi's sweeps, which end when nothing is left to turn: a choice.
  constexpr int kMaxSweeps = 30;
  bool is_done = false;
  for (int sweep = 0; sweep < kMaxSweeps && !is_done; ++sweep) {
    is_done = true;
    for (Eigen::Index i = 0; i + 1 < count; ++i) {
      for (Eigen::Index j = i + 1; j < count; ++j) {
        const double aa = matrix->col(i).squaredNorm();
        const double bb = matrix->col(j).squaredNorm();
        const double ab = matrix->col(i).dot(matrix->col(j));
        if (!(ab * ab > 1e-30 * aa * bb) && !(bb > (1 + 1e-12) * aa)) {
          continue;
        }
        is_done = false;
        // A half-angle that makes ab zero and leaves the longer column first.
        const double angle = 0.5 * std::atan2(2 * ab, aa - bb);
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        for (Mat6* turned : {matrix, follower}) {
          const Vec6 first = c * turned->col(i) + s * turned->col(j);
          turned->col(j) = c * turned->col(j) - s * turned->col(i);
          turned->col(i) = first;
        }
      }
    }
  }
}

/** Splits the unknowns into held and free directions. */
struct Split {
  Mat6 images;  // Of the directions, by the equations: orthogonal to each other.
  Mat6 directions{Mat6::Identity()};  // Columns: held directions first, by falling singular value.
  int rank{0};

  explicit Split(const Mat6& equations) : images(equations) {
    MakeColumnsOrthogonal(6, &images, &directions);
    while (rank < 6 && images.col(rank).norm() > kRankTolerance * images.col(0).norm()) {
      ++rank;
    }
  }

  [[nodiscard]] Vec6 ShortestStep(const Vec6& right) const {
    Vec6 step = Vec6::Zero();
    for (int k = 0; k < rank; ++k) {
      step += directions.col(k) * (images.col(k).dot(right) / images.col(k).squaredNorm());
    }
    return step;
  }

  [[nodiscard]] Vec6 ProjectOnFree(const Vec6& x) const {
    Vec6 out = Vec6::Zero();
    for (int k = rank; k < 6; ++k) {
      out += directions.col(k) * directions.col(k).dot(x);
    }
    return out;
  }
};

/** Moves B: the reference point by v, and B about it by w. */
Pose Move(const Pose& X_WB, const Scale& scale, const Vec6& step) {
  const Quat turn = spatial::RotationFromVector(step.head<3>() / scale.length);
  return {(turn * X_WB.q()).normalized(),
          scale.p_WR + turn * (X_WB.p() - scale.p_WR) + step.tail<3>()};
}

double CalcResidual(std::span<const MateConstraint> mates, const Pose& X_WB, double length) {
  double sum = 0;
  for (const MateConstraint& mate : mates) {
    const Pose X_WN = X_WB * mate.X_BN;
    const Vec3 zhat_W = AxisOf(mate.X_WM);
    const Vec3 p_MN_W = X_WN.p() - mate.X_WM.p();
    const double along = zhat_W.dot(p_MN_W);
    const double turn = length * CalcTurn(mate, AxisOf(X_WN)).norm();
    sum += turn * turn;
    sum += HoldsAcross(mate.kind) ? (p_MN_W - along * zhat_W).squaredNorm() : 0.0;
    sum += HoldsAlong(mate.kind) ? along * along : 0.0;
  }
  return std::sqrt(sum);
}

/** Gauss-Newton with halved steps where the full one does not help. */
Resolution Iterate(std::span<const MateConstraint> mates, const Pose& X_WBStart) {
  Resolution result;
  result.X_WB = X_WBStart;
  const double length = CalcScale(mates, X_WBStart).length;
  result.residual = CalcResidual(mates, X_WBStart, length);
  for (; result.iterations < kMaxIterations && result.residual > 1e-3 * kConverged;
       ++result.iterations) {
    const Scale scale = CalcScale(mates, result.X_WB);
    const Equations equations = Linearise(mates, result.X_WB, scale);
    Vec6 step = Split(equations.matrix()).ShortestStep(equations.right_side());
    const double before = result.residual;
    bool is_better = false;
    for (int halving = 0; halving <= kMaxHalvings && !is_better; ++halving, step *= 0.5) {
      const Pose X_WB = Move(result.X_WB, scale, step);
      const double residual = CalcResidual(mates, X_WB, length);
      if (residual < result.residual) {
        result.X_WB = X_WB;
        result.residual = residual;
        is_better = true;
      }
    }
    if (!is_better || result.residual > 0.99 * before) {
      break;  // What is left contradicts itself.
    }
  }
  result.is_converged = result.residual < kConverged;
  return result;
}

/** A start near the solution, from anywhere: the first mate's axis aligned, then the turn about it
 that a second mate asks for. */
Pose Prealign(std::span<const MateConstraint> mates, const Pose& X_WBStart) {
  // One with a direction, if there is any.
  const auto with_direction =
      std::find_if(mates.begin(), mates.end(),
                   [](const MateConstraint& mate) { return HoldsDirection(mate.kind); });
  const MateConstraint& first = with_direction != mates.end() ? *with_direction : mates.front();
  Pose X_WB = AlignToAxis(first, X_WBStart);
  const Vec3 zhat_W = TargetOf(first);
  const Vec3 p_WO = (X_WB * first.X_BN).p();
  const auto square = [&](const Vec3& x) { return Vec3(x - zhat_W.dot(x) * zhat_W); };
  Vec3 best_from = Vec3::Zero();
  Vec3 best_to = Vec3::Zero();
  double best = 1e-6;
  const double length = CalcScale(mates, X_WB).length;
  for (const MateConstraint& mate : mates) {
    if (&mate == &first) {
      continue;
    }
    const Pose X_WN = X_WB * mate.X_BN;
    // A direction held at an angle to the axis, or, for parallel axes, the one between the two.
    std::array<Vec3, 2> from{Vec3::Zero(), Vec3::Zero()};
    std::array<Vec3, 2> to{Vec3::Zero(), Vec3::Zero()};
    if (HoldsDirection(mate.kind)) {
      from[0] = square(AxisOf(X_WN));
      to[0] = square(TargetOf(mate));
    }
    if (HoldsAcross(mate.kind) && HoldsAcross(first.kind)) {
      from[1] = square(X_WN.p() - p_WO) / length;
      to[1] = square(mate.X_WM.p() - first.X_WM.p()) / length;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      if (from[k].norm() * to[k].norm() > best) {
        best = from[k].norm() * to[k].norm();
        best_from = from[k];
        best_to = to[k];
      }
    }
  }
  const double angle = std::atan2(zhat_W.dot(best_from.cross(best_to)), best_from.dot(best_to));
  const Quat turn = spatial::RotationFromVector(angle * zhat_W);
  return {(turn * X_WB.q()).normalized(), p_WO + turn * (X_WB.p() - p_WO)};
}

}  // namespace

MateConstraint MakeConstraint(const product::Mate& mate, product::OccurrenceId held,
                              const Pose& X_WP) noexcept {
  HVAS_ASSERT(mate.a.occurrence == held || mate.b.occurrence == held);
  const bool holds_b = mate.b.occurrence == held;
  const product::Connector& placed_side = holds_b ? mate.a : mate.b;
  const product::Connector& held_side = holds_b ? mate.b : mate.a;
  return {mate.kind, X_WP * placed_side.X_BM, held_side.X_BM};
}

MateEquations CalcEquations(const MateConstraint& mate, const Pose& X_WN) noexcept {
  MateEquations equations;
  const auto add = [&equations](const Vec3& axis_W, double right, bool is_tilt) {
    equations.items[equations.count++] = {axis_W, right, is_tilt};
  };
  const Mat3 R_WM = mate.X_WM.R();
  const Vec3 turn_W = CalcTurn(mate, AxisOf(X_WN));
  const Vec3 p_NM_W = mate.X_WM.p() - X_WN.p();
  // Tilts about the in-plane axes of M.
  for (Eigen::Index k = 0; HoldsDirection(mate.kind) && k < 2; ++k) {
    const Vec3 axis_W = R_WM.col(k);
    add(axis_W, axis_W.dot(turn_W), true);
  }
  // Shifts: across the axis, out of the plane, or both.
  for (Eigen::Index k = HoldsAcross(mate.kind) ? 0 : 2; k < (HoldsAlong(mate.kind) ? 3 : 2); ++k) {
    const Vec3 axis_W = R_WM.col(k);
    add(axis_W, axis_W.dot(p_NM_W), false);
  }
  return equations;
}

double CalcResidual(std::span<const MateConstraint> mates, const Pose& X_WB) noexcept {
  return CalcResidual(mates, X_WB, CalcScale(mates, X_WB).length);
}

FreeTwists CalcFreeTwists(std::span<const MateConstraint> mates, const Pose& X_WB) noexcept {
  const Scale scale = CalcScale(mates, X_WB);
  const Split split(Linearise(mates, X_WB, scale).matrix());
  FreeTwists free;
  free.p_WR = scale.p_WR;
  free.length = scale.length;
  const int count = 6 - split.rank;
  // Turns the free basis so that it ends with the directions that do not rotate.
  Mat6 basis = Mat6::Zero();
  basis.leftCols(count) = split.directions.rightCols(count);
  Mat6 rotation = Mat6::Zero();
  rotation.topRows<3>() = basis.topRows<3>();
  MakeColumnsOrthogonal(count, &rotation, &basis);
  for (Eigen::Index k = 0; k < count; ++k) {
    Vec6 x = basis.col(count - 1 - k);
    const bool is_translation = x.head<3>().norm() < kRankTolerance;
    if (is_translation) {
      x.head<3>().setZero();
      x.normalize();
    }
    Twist& twist = free.basis[static_cast<std::size_t>(k)];
    twist.w = x.head<3>() / scale.length;
    twist.v = x.tail<3>() + twist.w.cross(X_WB.p() - scale.p_WR);
    ++(is_translation ? free.translations : free.rotations);
  }
  return free;
}

Pose AlignToAxis(const MateConstraint& mate, const Pose& X_WBStart) noexcept {
  const Pose X_WN = X_WBStart * mate.X_BN;
  const Quat turn = HoldsDirection(mate.kind)
                        ? spatial::RotationTaking(AxisOf(X_WN), TargetOf(mate))
                        : Quat::Identity();
  const Vec3 zhat_W = AxisOf(mate.X_WM);
  const Vec3 p_NM_W = mate.X_WM.p() - X_WN.p();
  const Vec3 along_W = zhat_W.dot(p_NM_W) * zhat_W;
  Vec3 shift_W = p_NM_W;
  if (!HoldsAcross(mate.kind)) {
    shift_W = along_W;
  } else if (!HoldsAlong(mate.kind)) {
    shift_W -= along_W;
  }
  return {(turn * X_WBStart.q()).normalized(),
          X_WN.p() + turn * (X_WBStart.p() - X_WN.p()) + shift_W};
}

Resolution Resolve(std::span<const MateConstraint> mates, const Pose& X_WBStart) noexcept {
  Resolution result = Iterate(mates, X_WBStart);
  if (result.is_converged || mates.size() < 2) {
    return result;
  }
  Resolution retry = Iterate(mates, Prealign(mates, X_WBStart));
  retry.iterations += result.iterations;
  return retry.residual < result.residual ? retry : result;
}

Resolution ResolveToward(std::span<const MateConstraint> mates, const Pose& X_WBStart,
                         const Pose& X_WBGoal) noexcept {
  Resolution result = Resolve(mates, X_WBStart);
  for (int i = 0; i < kMaxIterations; ++i) {
    const Scale scale = CalcScale(mates, result.X_WB);
    const Split split(Linearise(mates, result.X_WB, scale).matrix());
    Vec6 error;
    error.head<3>() = scale.length * spatial::RotationBetween(result.X_WB.q(), X_WBGoal.q());
    error.tail<3>() = X_WBGoal * (result.X_WB.Inverse() * scale.p_WR) - scale.p_WR;
    const Vec6 step = split.ProjectOnFree(error);
    if (step.norm() < 1e-3 * kConverged) {
      break;
    }
    const int iterations = result.iterations;
    result = Iterate(mates, Move(result.X_WB, scale, step));
    result.iterations += iterations + 1;
  }
  return result;
}

}  // namespace hvas::mates
