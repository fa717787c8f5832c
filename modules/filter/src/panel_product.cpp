// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "panel_product.hpp"

#include <cstring>

#include "colonnade/base/vector_kernel.hpp"

namespace colonnade {
namespace {

/// Four doubles: one AVX register, or two of SSE2.
using Quad = double __attribute__((vector_size(32)));

inline __attribute__((always_inline)) void load(Quad& quad, const double* from) {
  std::memcpy(&quad, from, sizeof quad);
}

/// Adds `kColumns` columns at a time, sixteen rows of each in registers.
template <int kColumns>
inline __attribute__((always_inline)) void addColumns(double* C, const double* A, const double* B,
                                                      std::ptrdiff_t stride_b,
                                                      std::ptrdiff_t depth) {
  for (std::ptrdiff_t half = 0; half < kPanelRows; half += 16) {
    Quad sum[kColumns][4] = {};
    for (std::ptrdiff_t k = 0; k < depth; ++k) {
      Quad a[4];
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i) load(a[i], A + k * kPanelRows + half + 4 * i);
#pragma GCC unroll 4
      for (int c = 0; c < kColumns; ++c)
#pragma GCC unroll 4
        for (int i = 0; i < 4; ++i) sum[c][i] += a[i] * B[k * stride_b + c];
    }
#pragma GCC unroll 4
    for (int c = 0; c < kColumns; ++c)
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i) {
        double* to = C + c * kPanelRows + half + 4 * i;
        Quad old;
        load(old, to);
        old += sum[c][i];
        std::memcpy(to, &old, sizeof old);
      }
  }
}

inline __attribute__((always_inline)) void add(double* C, std::ptrdiff_t columns, const double* A,
                                               const double* B, std::ptrdiff_t stride_b,
                                               std::ptrdiff_t depth) {
  std::ptrdiff_t column = 0;
  for (; column + 2 <= columns; column += 2)
    addColumns<2>(C + column * kPanelRows, A, B + column, stride_b, depth);
  if (column < columns) addColumns<1>(C + column * kPanelRows, A, B + column, stride_b, depth);
}

}  // namespace

COLONNADE_VECTOR_KERNEL
void addPanelProduct(double* C, std::ptrdiff_t columns, const double* A, const double* B,
                     std::ptrdiff_t stride_b, std::ptrdiff_t depth) {
  add(C, columns, A, B, stride_b, depth);
}

}  // namespace colonnade
