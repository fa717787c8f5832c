// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "panel_product.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <vector>

namespace colonnade {
namespace {

/// Whatever the processor: each entry's products are added in their order, then the sum.
TEST(PanelProduct, GivesTheBitsOfSumsTakenOneByOne) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  const auto numbers = [&](std::ptrdiff_t count) {
    std::vector<double> values(static_cast<std::size_t>(count));
    for (double& value : values) value = noise(random);
    return values;
  };
  const auto at = [](std::ptrdiff_t i) { return static_cast<std::size_t>(i); };
  for (const std::ptrdiff_t columns : {1, 2, 33}) {
    for (const std::ptrdiff_t depth : {0, 1, 33}) {
      const std::ptrdiff_t rows = columns + 5;
      const auto A = numbers(kPanelRows * depth);
      auto B = numbers(rows * depth);
      // What begins with zeros is passed over.
      for (std::ptrdiff_t c = 5; c < rows; ++c)
        for (std::ptrdiff_t k = 0; k < depth / 2; ++k) B[at(k * rows + c)] = 0.0;
      auto C = numbers(kPanelRows * columns);
      auto expected = C;
      for (std::ptrdiff_t c = 0; c < columns; ++c) {
        for (std::ptrdiff_t r = 0; r < kPanelRows; ++r) {
          double sum = 0.0;
          for (std::ptrdiff_t k = 0; k < depth; ++k)
            sum += A[at(k * kPanelRows + r)] * B[at(k * rows + c)];
          expected[at(c * kPanelRows + r)] += sum;
        }
      }
      const Strips strips(Eigen::Map<const Eigen::MatrixXd>(B.data(), rows, depth));
      addPanelProduct(C.data(), columns, A.data(), strips);
      EXPECT_EQ(C, expected) << columns << " columns, depth " << depth;
    }
  }
}

/// As those of panels are, which six does not divide.
TEST(PanelProduct, TakesStripsThatWereWrittenInParts) {
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(kPanelRows, 9);
  Eigen::MatrixXd B = Eigen::MatrixXd::Random(14, 9);
  B.block(8, 0, 6, 4).setZero();
  B.row(2).setZero();
  Strips strips;
  strips.clear(9, 14);
  strips.growRows(8);
  strips.write(0, B.topRows(8));
  strips.growRows(14);
  strips.write(8, B.bottomRows(6));
  for (int round = 0; round < 2; ++round) {
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(kPanelRows, 14);
    addPanelProduct(C.data(), A.data(), strips);
    EXPECT_LT((C - A * B.transpose()).cwiseAbs().maxCoeff(), 1e-14);
    B.row(7).setZero();
    strips.setZero(7);
  }
}

TEST(PanelProduct, MultipliesRowsWhateverTheSizes) {
  for (const int rows : {1, 32, 75}) {
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(rows, 9), B = Eigen::MatrixXd::Random(7, 9);
    EXPECT_LT((productOfRows(A, B) - A * B.transpose()).cwiseAbs().maxCoeff(), 1e-13);
  }
}

}  // namespace
}  // namespace colonnade
