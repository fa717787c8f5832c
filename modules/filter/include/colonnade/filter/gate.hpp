// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace colonnade {

/// The value a chi-square variable of `degrees_of_freedom` stays below with this probability;
/// infinite for probability 1: no gate.
double chiSquareQuantile(double probability, int degrees_of_freedom);

}  // namespace colonnade
