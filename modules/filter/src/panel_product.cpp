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

/// Adds `kColumns` columns, so many rows of each in registers as `kVectors` vectors hold.
template <class Vector, int kColumns, int kVectors>
inline __attribute__((always_inline)) void addColumns(double* C, const double* A, const double* B,
                                                      std::ptrdiff_t stride_b,
                                                      std::ptrdiff_t depth) {
  constexpr std::ptrdiff_t kWidth = sizeof(Vector) / sizeof(double);
  for (std::ptrdiff_t row = 0; row < kPanelRows; row += kVectors * kWidth) {
    Vector sum[kColumns][kVectors] = {};
    for (std::ptrdiff_t k = 0; k < depth; ++k) {
      Vector a[kVectors];
#pragma GCC unroll 4
      for (int i = 0; i < kVectors; ++i)
        std::memcpy(&a[i], A + k * kPanelRows + row + kWidth * i, sizeof(Vector));
#pragma GCC unroll 4
      for (int c = 0; c < kColumns; ++c)
#pragma GCC unroll 4
        for (int i = 0; i < kVectors; ++i) sum[c][i] += a[i] * B[k * stride_b + c];
    }
#pragma GCC unroll 4
    for (int c = 0; c < kColumns; ++c)
#pragma GCC unroll 4
      for (int i = 0; i < kVectors; ++i) {
        double* to = C + c * kPanelRows + row + kWidth * i;
        Vector old;
        std::memcpy(&old, to, sizeof old);
        old += sum[c][i];
        std::memcpy(to, &old, sizeof old);
      }
  }
}

template <class Vector, int kVectors>
inline __attribute__((always_inline)) void add(double* C, std::ptrdiff_t columns, const double* A,
                                               const double* B, std::ptrdiff_t stride_b,
                                               std::ptrdiff_t depth) {
  std::ptrdiff_t column = 0;
  for (; column + 4 <= columns; column += 4)
    addColumns<Vector, 4, kVectors>(C + column * kPanelRows, A, B + column, stride_b, depth);
  for (; column < columns; ++column)
    addColumns<Vector, 1, kVectors>(C + column * kPanelRows, A, B + column, stride_b, depth);
}

#ifdef COLONNADE_WIDEST_VECTORS
COLONNADE_WIDEST_VECTORS
void addInWidestVectors(double* C, std::ptrdiff_t columns, const double* A, const double* B,
                        std::ptrdiff_t stride_b, std::ptrdiff_t depth) {
  add<Octet, 4>(C, columns, A, B, stride_b, depth);
}
#endif

COLONNADE_VECTOR_KERNEL
void addInVectors(double* C, std::ptrdiff_t columns, const double* A, const double* B,
                  std::ptrdiff_t stride_b, std::ptrdiff_t depth) {
  add<Quad, 2>(C, columns, A, B, stride_b, depth);
}

}  // namespace

void addPanelProduct(double* C, std::ptrdiff_t columns, const double* A, const double* B,
                     std::ptrdiff_t stride_b, std::ptrdiff_t depth) {
#ifdef COLONNADE_WIDEST_VECTORS
  if (hasWidestVectors()) return addInWidestVectors(C, columns, A, B, stride_b, depth);
#endif
  addInVectors(C, columns, A, B, stride_b, depth);
}

Eigen::MatrixXd productOfRows(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  Eigen::MatrixXd product(A.rows(), B.rows());
  Eigen::Matrix<double, kPanelRows, Eigen::Dynamic> A_panel(kPanelRows, A.cols()),
      panel(kPanelRows, B.rows());
  for (Eigen::Index row = 0; row < A.rows(); row += kPanelRows) {
    const Eigen::Index rows = std::min<Eigen::Index>(kPanelRows, A.rows() - row);
    A_panel.bottomRows(kPanelRows - rows).setZero();
    A_panel.topRows(rows) = A.middleRows(row, rows);
    panel.setZero();
    addPanelProduct(panel.data(), B.rows(), A_panel.data(), B.data(), B.rows(), A.cols());
    product.middleRows(row, rows) = panel.topRows(rows);
  }
  return product;
}

}  // namespace colonnade
