#pragma once

#include <Eigen/Core>

namespace hvas::mates {

/** Singular value decomposition A = U diag(values) V^T of an m x n matrix, of which U is as thin as
 the values allow and V is square. Compiled once: Eigen's template takes ten seconds in each source
 that instantiates it. */
struct SingularValues {
  Eigen::VectorXd values;  ///< Falling, min(m, n) of them.
  Eigen::MatrixXd U;       ///< m x min(m, n)
  Eigen::MatrixXd V;       ///< n x n

  /** Number of values above `least`. */
  [[nodiscard]] Eigen::Index CountAbove(double least) const;

  /** The x of least norm that minimises |A x - b|; values up to `tolerance` times the largest count
   as zero. */
  [[nodiscard]] Eigen::VectorXd Solve(const Eigen::VectorXd& b, double tolerance) const;
};

/** Decomposes a matrix by Jacobi rotations; for matrices of up to some hundred rows and columns. */
[[nodiscard]] SingularValues CalcSingularValues(const Eigen::MatrixXd& A);

}  // namespace hvas::mates
