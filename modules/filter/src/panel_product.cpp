// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "panel_product.hpp"

#include <algorithm>
#include <cstring>

#include "colonnade/base/vector_kernel.hpp"

namespace colonnade {
namespace {

/// Four doubles are one AVX register, or two of SSE2; eight are one of AVX-512.
using Quad = double __attribute__((vector_size(32)));
using Octet = double __attribute__((vector_size(64)));

/// One strip of B, so many rows of each column in registers as `kVectors` vectors hold.
template <class Vector, int kVectors>
inline __attribute__((always_inline)) void addStrip(double* C, std::ptrdiff_t columns,
                                                    const double* A, const double* B,
                                                    std::ptrdiff_t depth) {
  constexpr std::ptrdiff_t kWidth = sizeof(Vector) / sizeof(double);
  constexpr int kColumns = Strips::kWidth;
  for (std::ptrdiff_t row = 0; row < kPanelRows; row += kVectors * kWidth) {
    Vector sum[kColumns][kVectors] = {};
    for (std::ptrdiff_t k = 0; k < depth; ++k) {
      Vector a[kVectors];
#pragma GCC unroll 8
      for (int i = 0; i < kVectors; ++i)
        std::memcpy(&a[i], A + k * kPanelRows + row + kWidth * i, sizeof(Vector));
#pragma GCC unroll 8
      for (int c = 0; c < kColumns; ++c)
#pragma GCC unroll 8
        for (int i = 0; i < kVectors; ++i) sum[c][i] += a[i] * B[k * kColumns + c];
    }
#pragma GCC unroll 8
    for (int c = 0; c < kColumns; ++c) {
      if (c >= columns) break;
#pragma GCC unroll 8
      for (int i = 0; i < kVectors; ++i) {
        double* to = C + c * kPanelRows + row + kWidth * i;
        Vector old;
        std::memcpy(&old, to, sizeof old);
        old += sum[c][i];
        std::memcpy(to, &old, sizeof old);
      }
    }
  }
}

template <class Vector, int kVectors>
inline __attribute__((always_inline)) void add(double* C, std::ptrdiff_t columns, const double* A,
                                               const Strips& B) {
  for (std::ptrdiff_t strip = 0; strip * Strips::kWidth < columns; ++strip) {
    const std::ptrdiff_t first = strip * Strips::kWidth, skipped = B.zeroColumns(strip);
    addStrip<Vector, kVectors>(C + first * kPanelRows, columns - first, A + skipped * kPanelRows,
                               B.strip(strip) + skipped * Strips::kWidth, B.depth() - skipped);
  }
}

#ifdef COLONNADE_WIDEST_VECTORS
COLONNADE_WIDEST_VECTORS
void addInWidestVectors(double* C, std::ptrdiff_t columns, const double* A, const Strips& B) {
  add<Octet, 4>(C, columns, A, B);
}
#endif

COLONNADE_VECTOR_KERNEL
void addInVectors(double* C, std::ptrdiff_t columns, const double* A, const Strips& B) {
  add<Quad, 2>(C, columns, A, B);
}

}  // namespace

void addPanelProduct(double* C, std::ptrdiff_t columns, const double* A, const Strips& B) {
  if (B.depth() == 0) return;
#ifdef COLONNADE_WIDEST_VECTORS
  if (hasWidestVectors()) return addInWidestVectors(C, columns, A, B);
#endif
  addInVectors(C, columns, A, B);
}

Eigen::MatrixXd productOfRows(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  Eigen::MatrixXd product(A.rows(), B.rows());
  const Strips strips(B);
  Eigen::Matrix<double, kPanelRows, Eigen::Dynamic> A_panel(kPanelRows, A.cols()),
      panel(kPanelRows, B.rows());
  for (Eigen::Index row = 0; row < A.rows(); row += kPanelRows) {
    const Eigen::Index rows = std::min<Eigen::Index>(kPanelRows, A.rows() - row);
    A_panel.bottomRows(kPanelRows - rows).setZero();
    A_panel.topRows(rows) = A.middleRows(row, rows);
    panel.setZero();
    addPanelProduct(panel.data(), A_panel.data(), strips);
    product.middleRows(row, rows) = panel.topRows(rows);
  }
  return product;
}

}  // namespace colonnade
