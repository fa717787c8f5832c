// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <new>

namespace colonnade {

/// For programs that work through frames: each needs again what the one before has freed. The C
/// library would hand images back to the system in between, and the page faults of getting them
/// again can cost more than the detectors. Freed memory then stays with the process (glibc; without
/// effect elsewhere). Call it first in main().
void keepFreedMemory();

/// Memory for large arrays, aligned to cache lines. From two mebibytes on it comes in huge pages
/// where the system gives them (Linux): what is read across rows misses the translation of
/// addresses less often, and fresh memory costs one page fault in place of five hundred. nullptr
/// when there is none.
void* allocateLarge(std::size_t bytes);
void freeLarge(void* memory);

/// For containers of large arrays.
template <class T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) {}
  T* allocate(std::size_t count) {
    if (void* memory = allocateLarge(count * sizeof(T))) return static_cast<T*>(memory);
    throw std::bad_alloc();
  }
  void deallocate(T* memory, std::size_t) { freeLarge(memory); }
  bool operator==(const LargeAllocator&) const { return true; }
};

}  // namespace colonnade
