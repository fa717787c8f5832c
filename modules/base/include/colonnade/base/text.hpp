// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace colonnade {

/// Text helpers that never depend on the locale: a decimal comma must not change a file.

std::string trimmed(std::string_view text);
std::string joined(const std::vector<std::string>& words, std::string_view separator);
/// The words of a line, split at blanks and tabs.
std::vector<std::string> words(std::string_view line);
/// The fields of a line, split at every `separator`, blanks around them removed.
std::vector<std::string> fields(std::string_view line, char separator);

/// The whole text as a number, or nothing.
std::optional<double> parseDouble(std::string_view text);

/// The shortest text that reads back as the same double.
std::string formatDouble(double value);
/// At most `significant_digits`, without trailing zeros.
std::string formatDouble(double value, int significant_digits);
/// A fixed number of decimals.
std::string formatFixed(double value, int decimals);

}  // namespace colonnade
