#include "mates/singular_values.h"

#include <Eigen/SVD>

namespace hvas::mates {

SingularValues CalcSingularValues(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

Eigen::Index SingularValues::CountAbove(double least) const {
  Eigen::Index count = 0;
  while (count < values.size() && values[count] > least) {
    ++count;
  }
  return count;
}

Eigen::VectorXd SingularValues::Solve(const Eigen::VectorXd& b, double tolerance) const {
  const Eigen::Index rank = values.size() == 0 ? 0 : CountAbove(tolerance * values[0]);
  const Eigen::VectorXd shares =
      (U.leftCols(rank).transpose() * b).cwiseQuotient(values.head(rank));
  return V.leftCols(rank) * shares;
}

}  // namespace hvas::mates
