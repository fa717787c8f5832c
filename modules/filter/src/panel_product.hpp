// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "colonnade/filter/strips.hpp"

namespace colonnade {

constexpr std::ptrdiff_t kPanelRows = 32;

/// C += A B^T: A kPanelRows x B.depth() and C kPanelRows x columns, both by columns without gaps;
/// of B the first `columns` rows. Uses wide vectors where the processor has them; the sums are
/// taken in the same order everywhere, so the result is the same to the bit.
void addPanelProduct(double* C, std::ptrdiff_t columns, const double* A, const Strips& B);
inline void addPanelProduct(double* C, const double* A, const Strips& B) {
  addPanelProduct(C, B.rows(), A, B);
}

/// A B^T by the same means, whatever the sizes.
Eigen::MatrixXd productOfRows(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace colonnade
