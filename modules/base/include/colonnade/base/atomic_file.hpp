// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace colonnade {

/// Writes a whole file or nothing: into a temporary neighbour, flushed to the disk, then renamed.
/// Throws Error naming the file; a former file of that name stays untouched then.
void writeFileAtomically(const std::filesystem::path& path, std::string_view content);

/// The same for libraries that insist on writing to a path themselves. `write` gets a temporary
/// path with the same extension and must leave a complete file there (or throw).
void writeFileAtomically(const std::filesystem::path& path,
                         const std::function<void(const std::filesystem::path&)>& write);

}  // namespace colonnade
