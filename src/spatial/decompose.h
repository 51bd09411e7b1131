#pragma once

#include <optional>

#include "spatial/pose.h"

namespace hvas::spatial {

/** Eigenvalues of a symmetric matrix, ascending, and its unit eigenvectors as columns. */
struct Eigensystem {
  Vec3 values;
  Mat3 vectors;
};

/** Eigensystem of a symmetric matrix. Only its lower triangle is read. */
[[nodiscard]] Eigensystem CalcEigensystem(const Mat3& A);

/** Unit eigenvector of the least eigenvalue of a symmetric matrix. Only its lower triangle is read.
 */
[[nodiscard]] Vec6 CalcLeastEigenvector(const Mat6& A);

/** Solution x of A x = b for a symmetric A without negative eigenvalues, as normal equations have
 it; nothing where A is singular to machine precision. */
[[nodiscard]] std::optional<Vec3> SolveNormalEquations(const Mat3& A, const Vec3& b);

/** A = U diag(values) V^T with orthogonal U and V, and values that descend and are not negative. */
struct SingularValues3 {
  Mat3 U;
  Vec3 values;
  Mat3 V;
};

/** Singular values of a matrix. */
[[nodiscard]] SingularValues3 CalcSingularValues(const Mat3& A);

}  // namespace hvas::spatial
