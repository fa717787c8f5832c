// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace colonnade {

/// For programs that work through frames: each needs again what the one before has freed. The C
/// library would hand images back to the system in between, and the page faults of getting them
/// again can cost more than the detectors. Freed memory then stays with the process (glibc; without
/// effect elsewhere). Call it first in main().
void keepFreedMemory();

}  // namespace colonnade
