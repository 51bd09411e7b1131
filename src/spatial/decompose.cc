#include "spatial/decompose.h"

#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace hvas::spatial {

Eigensystem CalcEigensystem(const Mat3& A) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Vec6 CalcLeastEigenvector(const Mat6& A) {
  return Eigen::SelfAdjointEigenSolver<Mat6>(A).eigenvectors().col(0);
}

std::optional<Vec3> SolveNormalEquations(const Mat3& A, const Vec3& b) {
  const Eigensystem system = CalcEigensystem(A);
  // Rounding of the eigenvalues, as Eigen's own decompositions have it: their number times epsilon.
  if (!(system.values[0] > 3 * std::numeric_limits<double>::epsilon() * system.values[2])) {
    return std::nullopt;
  }
  return system.vectors * (system.vectors.transpose() * b).cwiseQuotient(system.values);
}

SingularValues3 CalcSingularValues(const Mat3& A) {
  const Eigen::JacobiSVD<Mat3> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

}  // namespace hvas::spatial
