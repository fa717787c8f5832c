// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace colonnade {

/// LOG without `.rawlog` or `.rawlog.gz`: what stands beside a log shares this beginning.
std::filesystem::path logStem(const std::filesystem::path& log);

}  // namespace colonnade
