#include "spatial/decompose.h"

#include <gtest/gtest.h>

#include "spatial/test/random_pose.h"

namespace hvas::spatial {
namespace {

Mat3 RandomMatrix(Random* random) {
  Mat3 A;
  A << RandomVector(random, 1), RandomVector(random, 1), RandomVector(random, 1);
  return A;
}

TEST(Decompose, EigensystemOfATurnedDiagonalMatrixIsThatOfTheDiagonal) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Mat3 R = RandomRotation(&random).toRotationMatrix();
    const Eigensystem system = CalcEigensystem(R * Vec3(5, -1, 2).asDiagonal() * R.transpose());
    EXPECT_LT((system.values - Vec3(-1, 2, 5)).norm(), 1e-13);
    EXPECT_NEAR(std::abs(system.vectors.col(0).dot(R.col(1))), 1, 1e-13);
    EXPECT_NEAR(std::abs(system.vectors.col(2).dot(R.col(0))), 1, 1e-13);
  }
}

TEST(Decompose, LeastEigenvectorIsTheOneThatAProjectionLeavesOut) {
  Vec6 left_out;
  left_out << 1, -2, 3, 0.5, 0, 4;
  left_out.normalize();
  const Mat6 projection = Mat6::Identity() - left_out * left_out.transpose();
  EXPECT_NEAR(std::abs(CalcLeastEigenvector(projection).dot(left_out)), 1, 1e-13);
}

TEST(Decompose, NormalEquationsAreSolvedOrSingular) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Mat3 rows = RandomMatrix(&random);
    const Vec3 x = RandomVector(&random, 1);
    const Mat3 A = rows.transpose() * rows;
    const std::optional<Vec3> solution = SolveNormalEquations(A, A * x);
    ASSERT_TRUE(solution);
    EXPECT_LT((rows * (*solution - x)).norm(), 1e-7);
  }
  const Vec3 only = Vec3(1, 2, 3);
  EXPECT_FALSE(SolveNormalEquations(only * only.transpose(), only));
  EXPECT_FALSE(SolveNormalEquations(Mat3::Zero(), only));
}

TEST(Decompose, SingularValuesGiveTheMatrixBack) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Mat3 A = RandomMatrix(&random);
    const SingularValues3 svd = CalcSingularValues(A);
    EXPECT_LT((svd.U * svd.values.asDiagonal() * svd.V.transpose() - A).norm(), 1e-13);
    EXPECT_LT((svd.U.transpose() * svd.U - Mat3::Identity()).norm(), 1e-13);
    EXPECT_GE(svd.values[0], svd.values[1]);
    EXPECT_GE(svd.values[1], svd.values[2]);
    EXPECT_GE(svd.values[2], 0);
  }
}

}  // namespace
}  // namespace hvas::spatial
