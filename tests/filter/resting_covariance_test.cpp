// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/resting_covariance.hpp"

#include <gtest/gtest.h>

#include <random>

namespace colonnade {
namespace {

using Indices = std::vector<Eigen::Index>;
constexpr Eigen::Index kRows = RowPanels::kRows;

class RestingCovarianceTest : public ::testing::Test {
 protected:
  Eigen::MatrixXd draw(Eigen::Index rows, Eigen::Index cols) {
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal_(random_); });
  }
  /// Rows and columns of these indices become new values.
  void write(const Indices& indices) {
    for (const Eigen::Index index : indices) {
      dense.col(index) = draw(dense.rows(), 1);
      dense.row(index) = dense.col(index).transpose();
    }
    covariance.forgive(indices);
    for (Eigen::Index panel = 0; panel < covariance.panels(); ++panel) {
      Eigen::MatrixXd values =
          Eigen::MatrixXd::Zero(kRows, static_cast<Eigen::Index>(indices.size()));
      const Eigen::Index rows = std::min(kRows, dense.rows() - panel * kRows);
      values.topRows(rows) = dense.middleRows(panel * kRows, rows)(Eigen::all, indices);
      covariance.writeRows(panel, indices, values.data());
    }
  }
  void owe(Eigen::Index cols) {
    const Eigen::MatrixXd D = draw(dense.rows(), cols);
    const Eigen::Index first = covariance.owe(cols);
    for (Eigen::Index row = 0; row < D.rows(); ++row)
      covariance.owed().row(row).segment(first, cols) = D.row(row);
    dense -= D * D.transpose();
  }
  void grow(Eigen::Index size) {
    const Eigen::Index before = dense.rows();
    dense.conservativeResize(size, size);
    dense.rightCols(size - before).setZero();
    dense.bottomRows(size - before).setZero();
    covariance.grow(size);
  }
  void expectEqual(const Indices& indices) const {
    const auto columns = covariance.columns(indices);
    Eigen::MatrixXd read(kRows, static_cast<Eigen::Index>(indices.size()));
    for (Eigen::Index panel = 0; panel < covariance.panels(); ++panel) {
      covariance.readRows(panel, columns, read.data());
      const Eigen::Index rows = std::min(kRows, dense.rows() - panel * kRows);
      const Eigen::MatrixXd expected = dense.middleRows(panel * kRows, rows)(Eigen::all, indices);
      EXPECT_LT((read.topRows(rows) - expected).cwiseAbs().maxCoeff(), 1e-11) << panel;
    }
    for (const Eigen::Index row : indices)
      for (Eigen::Index column = 0; column < dense.rows(); column += 7) {
        EXPECT_NEAR(dense(row, column), covariance(row, column), 1e-11);
        EXPECT_EQ(covariance(column, row), covariance(row, column));
      }
  }

  RestingCovariance covariance;
  Eigen::MatrixXd dense;

 private:
  std::mt19937 random_{1};
  std::normal_distribution<double> normal_{0.0, 1.0};
};

TEST_F(RestingCovarianceTest, IsTheMatrixWhateverIsOwedAndPaid) {
  grow(20);
  write({3, 10, 19});
  owe(5);
  grow(150);
  write({40, 3, 99, 149, 70});
  const Indices indices{0, 3, 31, 32, 64, 99, 128, 149};
  bool half_paid = false;
  for (int round = 0; round < 60; ++round) {
    if (round % 3 == 0) owe(37);
    if (round % 7 == 0) write({round, 149 - round});
    covariance.workOff();
    half_paid |= covariance.columns(indices).in_paid_panels > 0;
    expectEqual(indices);
  }
  EXPECT_TRUE(half_paid);
  covariance.settle();
  EXPECT_EQ(0, covariance.owed().cols());
  expectEqual(indices);
}

}  // namespace
}  // namespace colonnade
