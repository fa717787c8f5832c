// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Before a function of plain loops: compiled for wider vectors as well, and for those with masks,
/// which conditions in a loop gain from; each runs where the processor has them. The bits stay the
/// same, since -ffp-contract=off keeps products and sums apart. Sanitizers do not go with functions
/// chosen at load time.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define COLONNADE_VECTOR_KERNEL \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
/// Before a second version in the widest vectors, where another shape of the loops pays; called
/// only after hasWidestVectors().
#define COLONNADE_WIDEST_VECTORS __attribute__((target("arch=x86-64-v4")))
#else
#define COLONNADE_VECTOR_KERNEL
#endif

namespace colonnade {

inline bool hasWidestVectors() {
#ifdef COLONNADE_WIDEST_VECTORS
  static const bool has = __builtin_cpu_supports("x86-64-v4") != 0;
  return has;
#else
  return false;
#endif
}

}  // namespace colonnade
