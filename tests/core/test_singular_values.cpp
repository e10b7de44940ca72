// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/grip/matrices.h"
#include "tests/support/string_samples.h"
#include "tests/support/test.h"

namespace spidar::test::singular_values_test {
namespace {

// Rounding of one-sided rotations: some n² of them in ten rounds, each of 2⁻⁵³ of a number below
// ‖A‖.
constexpr double kTolerance = 1e-12;

Eigen::MatrixXd random_matrix(Random& random, int rows, int columns) {
  Eigen::MatrixXd A(rows, columns);
  for (Eigen::Index i = 0; i < A.size(); ++i) A.data()[i] = uniform(random, -1, 1);
  return A;
}

// AᵀA = V diag(values²) Vᵀ and VᵀV = I determine values and V.
void expect_decomposed(const Eigen::MatrixXd& A) {
  SCOPED_TRACE(::testing::Message() << A.rows() << " rows, " << A.cols() << " columns");
  const auto found = singular_values(A);
  ASSERT_EQ(found.values.size(), A.cols());
  const Eigen::MatrixXd& V = found.directions;
  EXPECT_TRUE((V.transpose() * V).isIdentity(kTolerance));
  const Eigen::MatrixXd squares = found.values.array().square().matrix().asDiagonal();
  EXPECT_LE((A.transpose() * A - V * squares * V.transpose()).norm(), kTolerance * A.squaredNorm());
  for (Eigen::Index k = 0; k < A.cols(); ++k)
    EXPECT_TRUE(found.values[k] >= 0 && (k == 0 || found.values[k] <= found.values[k - 1])) << k;
}

TEST(SingularValues, OfAnyShape) {
  Random random(1);
  for (const auto& [rows, columns] :
       {std::pair{1, 1}, {8, 8}, {6, 8}, {6, 24}, {40, 27}, {2000, 9}})
    expect_decomposed(random_matrix(random, rows, columns));
}

TEST(SingularValues, ColumnsBeyondTheRankAreTheNullSpace) {
  Random random(2);
  for (const int rows : {5, 8, 30}) {
    const Eigen::MatrixXd A = random_matrix(random, rows, 3) * random_matrix(random, 3, 8);
    expect_decomposed(A);
    const auto found = singular_values(A);
    EXPECT_LE(found.values.tail(5).maxCoeff(), kTolerance * A.norm());
    EXPECT_LE((A * found.directions.rightCols(5)).norm(), kTolerance * A.norm());
  }
}

TEST(SingularValues, OfZeros) {
  expect_decomposed(Eigen::MatrixXd::Zero(6, 8));
}

}  // namespace
}  // namespace spidar::test::singular_values_test
