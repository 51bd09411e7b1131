#include "mates/solve_together.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <Eigen/Sparse>

#include "mates/mate_kind.h"
#include "mates/singular_values.h"

namespace hvas::mates {
namespace {

using product::MateKind;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

constexpr int kMaxSteps = 300;       // Closed loops take 5 to 20, contradictions more. A choice.
constexpr double kMaxDamping = 1e6;  // No step helps any more: a choice.
constexpr double kSmallestStep = 1e-13;  // [m]: below the rounding of poses of some metres.
constexpr double kLeastLength = 1e-3;    // [m]: of mates that are all at one place. A choice.

Vec3 DirectionOf(const Pose& X_WC) {
  return X_WC.q() * Vec3::UnitZ();
}

/** Equations of a set of mates in the unknowns (L w, v) of the bodies that move, v at the mean of
 each body's connectors. */
class TogetherEquations {
 public:
  TogetherEquations(std::span<const BodyMate> mates, std::span<const double> weights,
                    const std::vector<bool>& is_fixed, const std::vector<Pose>& X_WB)
      : mates_(mates), weights_(weights), X_WB_(X_WB), column_of_(X_WB.size(), -1) {
    std::vector<Vec3> sums(X_WB.size(), Vec3::Zero());
    std::vector<int> counts(X_WB.size(), 0);
    for (const BodyMate& mate : mates) {
      sums[mate.a] += X_WB[mate.a] * mate.X_AM.p();
      sums[mate.b] += X_WB[mate.b] * mate.X_BN.p();
      ++counts[mate.a];
      ++counts[mate.b];
    }
    for (std::size_t body = 0; body < X_WB.size(); ++body) {
      p_WR_.push_back(counts[body] > 0 ? Vec3(sums[body] / counts[body]) : X_WB[body].p());
      if (!is_fixed[body] && counts[body] > 0) {
        column_of_[body] = columns_;
        columns_ += 6;
      }
    }
    for (const BodyMate& mate : mates) {
      length_ = std::max({length_, (X_WB[mate.a] * mate.X_AM.p() - p_WR_[mate.a]).norm(),
                          (X_WB[mate.b] * mate.X_BN.p() - p_WR_[mate.b]).norm()});
    }
    Linearise();
  }

  [[nodiscard]] Eigen::Index columns() const { return columns_; }

  [[nodiscard]] Eigen::Index ColumnOf(std::size_t body) const { return column_of_[body]; }

  [[nodiscard]] double length() const { return length_; }

  [[nodiscard]] const Vec3& ReferenceOf(std::size_t body) const { return p_WR_[body]; }

  [[nodiscard]] const Vector& right_side() const { return right_; }

  [[nodiscard]] SparseMatrix matrix() const {
    SparseMatrix matrix(right_.size(), columns_);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    return matrix;
  }

  /** Poses after a step of all unknowns. */
  [[nodiscard]] std::vector<Pose> Move(const Vector& step) const {
    std::vector<Pose> moved = X_WB_;
    for (std::size_t body = 0; body < moved.size(); ++body) {
      if (column_of_[body] < 0) {
        continue;
      }
      const Quat turn = spatial::RotationFromVector(step.segment<3>(column_of_[body]) / length_);
      const Vec3 shift = step.segment<3>(column_of_[body] + 3);
      moved[body] = {(turn * moved[body].q()).normalized(),
                     p_WR_[body] + turn * (moved[body].p() - p_WR_[body]) + shift};
    }
    return moved;
  }

 private:
  void Linearise() {
    std::vector<double> right;
    for (std::size_t i = 0; i < mates_.size(); ++i) {
      const BodyMate& mate = mates_[i];
      const MateConstraint constraint =
          MakeBodyConstraint(mate, true, X_WB_[mate.a], IsNearerTurned(mate, X_WB_));
      const Pose X_WN = X_WB_[mate.b] * constraint.X_BN;
      const MateEquations equations = CalcEquations(constraint, X_WN);
      for (std::size_t k = 0; k < equations.count; ++k) {
        const MateEquation& equation = equations.items[k];
        Add(static_cast<int>(right.size()), mate.b, 1, weights_[i], equation, X_WN.p());
        Add(static_cast<int>(right.size()), mate.a, -1, weights_[i], equation, X_WN.p());
        right.push_back(weights_[i] * (equation.is_tilt ? length_ : 1.0) * equation.right);
      }
    }
    right_ = Eigen::Map<const Vector>(right.data(), static_cast<Eigen::Index>(right.size()));
  }

  void Add(int row, std::size_t body, double sign, double weight, const MateEquation& equation,
           const Vec3& p_WN) {
    const Eigen::Index column = column_of_[body];
    if (column < 0) {
      return;
    }
    const Vec3 arm_W = (p_WN - p_WR_[body]) / length_;
    const Vec3 w = equation.is_tilt ? equation.axis_W : Vec3(arm_W.cross(equation.axis_W));
    const Vec3 v = equation.is_tilt ? Vec3(Vec3::Zero()) : equation.axis_W;
    for (int k = 0; k < 3; ++k) {
      entries_.emplace_back(row, static_cast<int>(column) + k, sign * weight * w[k]);
      entries_.emplace_back(row, static_cast<int>(column) + 3 + k, sign * weight * v[k]);
    }
  }

  std::span<const BodyMate> mates_;
  std::span<const double> weights_;
  const std::vector<Pose>& X_WB_;
  std::vector<Eigen::Index> column_of_;  // -1: the body does not move.
  std::vector<Vec3> p_WR_;
  Eigen::Index columns_{0};
  double length_{kLeastLength};
  std::vector<Eigen::Triplet<double>> entries_;
  Vector right_;
};

/** Splits the motions of one body, columns (L w, v at its reference point), into shifts and turns.
 */
BodyFreedom SplitMotions(const Matrix& motions, double length, const Vec3& p_RB_W) {
  BodyFreedom freedom;
  const SingularValues all = CalcSingularValues(motions);
  const Eigen::Index rank = all.CountAbove(kRankTolerance);
  if (rank == 0) {
    return freedom;
  }
  const Matrix basis = all.U.leftCols(rank);
  const Matrix split = basis.lazyProduct(CalcSingularValues(basis.topRows(3)).V);
  for (Eigen::Index k = 0; k < rank; ++k) {
    const Vec3 w = split.col(k).head<3>() / length;
    const Vec3 v = split.col(k).tail<3>();
    const double size = split.col(k).head<3>().norm();
    if (size < kRankTolerance) {
      freedom.shifts.push_back(v.normalized());
    } else {
      freedom.turns.push_back({w / w.norm(), (v + w.cross(p_RB_W)) / w.norm()});
    }
  }
  return freedom;
}

/** Motions of all bodies that the equations leave, as columns: those of Q beyond the rank, to which
 the reflections are applied one by one. */
Matrix CalcNullspace(const SparseMatrix& equations) {
  Eigen::ColPivHouseholderQR<Matrix> qr(Matrix(equations.transpose()));
  qr.setThreshold(kRankTolerance);
  const Eigen::Index rows = equations.cols();
  const Eigen::Index columns = rows - qr.rank();
  Matrix motions = Matrix::Zero(rows, columns);
  motions.bottomRows(columns).setIdentity();
  Vector workspace(columns);
  for (Eigen::Index k = qr.hCoeffs().size(); k-- > 0 && columns > 0;) {
    motions.bottomRows(rows - k).applyHouseholderOnTheLeft(qr.matrixQR().col(k).tail(rows - k - 1),
                                                           qr.hCoeffs()[k], workspace.data());
  }
  return motions;
}

std::vector<BodyFreedom> CalcFreedomsTogether(std::span<const BodyMate> mates,
                                              const std::vector<bool>& is_fixed,
                                              const std::vector<Pose>& X_WB) {
  std::vector<BodyFreedom> freedoms(X_WB.size());
  const std::vector<double> weights(mates.size(), 1.0);
  const TogetherEquations equations(mates, weights, is_fixed, X_WB);
  if (equations.columns() == 0) {
    return freedoms;
  }
  const Matrix motions = CalcNullspace(equations.matrix());
  for (std::size_t body = 0; body < X_WB.size() && motions.cols() > 0; ++body) {
    if (equations.ColumnOf(body) >= 0) {
      freedoms[body] =
          SplitMotions(motions.middleRows(equations.ColumnOf(body), 6), equations.length(),
                       X_WB[body].p() - equations.ReferenceOf(body));
    }
  }
  return freedoms;
}

/** The step that is best for the linearised equations, and for its own length times `damping`. */
Vector CalcDampedStep(const TogetherEquations& equations, double damping) {
  const Eigen::Index rows = equations.right_side().size();
  const Eigen::Index columns = equations.columns();
  SparseMatrix matrix = equations.matrix();
  matrix.conservativeResize(rows + columns, columns);
  for (Eigen::Index k = 0; k < columns; ++k) {
    matrix.coeffRef(rows + k, k) = damping;
  }
  matrix.makeCompressed();
  Vector right = Vector::Zero(rows + columns);
  right.head(rows) = equations.right_side();
  Eigen::LeastSquaresConjugateGradient<SparseMatrix, Eigen::IdentityPreconditioner> solver;
  solver.setTolerance(1e-14);
  solver.setMaxIterations(4 * columns + 20);
  solver.compute(matrix);
  return solver.solve(right);
}

}  // namespace

MateConstraint MakeBodyConstraint(const BodyMate& mate, bool holds_b, const Pose& X_WOther,
                                  bool is_turned) {
  MateConstraint constraint{mate.kind, X_WOther * (holds_b ? mate.X_AM : mate.X_BN),
                            holds_b ? mate.X_BN : mate.X_AM};
  if (is_turned) {
    constraint.X_BN = constraint.X_BN * Pose(Quat(0, 1, 0, 0), Vec3::Zero());
  }
  return constraint;
}

bool IsNearerTurned(const BodyMate& mate, const std::vector<Pose>& X_WB) {
  return mate.is_sense_open &&
         DirectionOf(X_WB[mate.a] * mate.X_AM).dot(DirectionOf(X_WB[mate.b] * mate.X_BN)) < 0;
}

MateError CalcError(const BodyMate& mate, const std::vector<Pose>& X_WB) {
  const MateConstraint constraint =
      MakeBodyConstraint(mate, true, X_WB[mate.a], IsNearerTurned(mate, X_WB));
  const Pose X_WN = X_WB[mate.b] * constraint.X_BN;
  const Vec3 zhat_W = DirectionOf(constraint.X_WM);
  const Vec3 p_MN_W = X_WN.p() - constraint.X_WM.p();
  const double along = zhat_W.dot(p_MN_W);
  MateError error;
  error.distance = std::hypot(HoldsAcross(mate.kind) ? (p_MN_W - along * zhat_W).norm() : 0.0,
                              HoldsAlong(mate.kind) ? along : 0.0);
  if (HoldsDirection(mate.kind)) {
    const Vec3 target = mate.kind == MateKind::kFaceFace ? Vec3(-zhat_W) : zhat_W;
    error.angle = std::atan2(target.cross(DirectionOf(X_WN)).norm(), target.dot(DirectionOf(X_WN)));
  }
  return error;
}

bool IsFulfilled(const BodyMate& mate, const std::vector<Pose>& X_WB) {
  const MateError error = CalcError(mate, X_WB);
  return error.distance < mate.distance_limit && error.angle < mate.angle_limit;
}

void SolveTogether(std::span<const BodyMate> mates, std::span<const double> weights,
                   const std::vector<bool>& is_fixed, std::vector<Pose>* X_WB) {
  double damping = 1e-3;
  for (int i = 0; i < kMaxSteps && damping < kMaxDamping; ++i) {
    const TogetherEquations equations(mates, weights, is_fixed, *X_WB);
    const double before = equations.right_side().norm();
    if (equations.columns() == 0 || before < kSmallestStep) {
      return;
    }
    const Vector step = CalcDampedStep(equations, damping);
    std::vector<Pose> moved = equations.Move(step);
    // Lengths differ a little from step to step: so does the weight of angles.
    const bool is_better =
        TogetherEquations(mates, weights, is_fixed, moved).right_side().norm() < before;
    damping *= is_better ? 0.1 : 10;
    if (is_better) {
      *X_WB = std::move(moved);
    }
    if (step.norm() < kSmallestStep) {
      return;
    }
  }
}

std::vector<BodyFreedom> CalcBodyFreedoms(std::span<const BodyMate> mates,
                                          const std::vector<bool>& is_fixed,
                                          const std::vector<Pose>& X_WB) {
  const auto moving = static_cast<std::size_t>(std::count(is_fixed.begin(), is_fixed.end(), false));
  if (moving <= kMaxTogether) {
    return CalcFreedomsTogether(mates, is_fixed, X_WB);
  }
  std::vector<BodyFreedom> freedoms(X_WB.size());
  for (std::size_t body = 0; body < X_WB.size(); ++body) {
    std::vector<BodyMate> own;
    std::copy_if(mates.begin(), mates.end(), std::back_inserter(own),
                 [body](const BodyMate& mate) { return mate.a == body || mate.b == body; });
    if (!is_fixed[body] && !own.empty()) {
      std::vector<bool> are_others_fixed(X_WB.size(), true);
      are_others_fixed[body] = false;
      freedoms[body] = CalcFreedomsTogether(own, are_others_fixed, X_WB)[body];
    }
  }
  return freedoms;
}

}  // namespace hvas::mates
