// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace colonnade {

/// Makes the folder results go to: `asked` if it is not empty, which must not hold anything yet
/// (Error, kUsage), otherwise STEM_results, STEM_results-2 and so on. Nothing is ever deleted.
std::filesystem::path makeResultsFolder(const std::filesystem::path& asked,
                                        const std::filesystem::path& log);

}  // namespace colonnade
