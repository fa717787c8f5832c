// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace colonnade {

constexpr std::ptrdiff_t kPanelRows = 32;

/// C += A B^T, all by columns: C kPanelRows x columns without gaps, A kPanelRows x depth without
/// gaps, B columns x depth with `stride_b` from column to column. Uses wide vectors where the
/// processor has them; the sums are taken in the same order everywhere, so the result is the same
/// to the bit.
void addPanelProduct(double* C, std::ptrdiff_t columns, const double* A, const double* B,
                     std::ptrdiff_t stride_b, std::ptrdiff_t depth);

/// A B^T by the same means, whatever the sizes.
Eigen::MatrixXd productOfRows(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace colonnade
