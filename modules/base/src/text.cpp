// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/base/text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace colonnade {

std::string trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(kBlank) - first + 1));
}

std::string joined(const std::vector<std::string>& words, std::string_view separator) {
  std::string text;
  for (const auto& word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

std::vector<std::string> words(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r\n";
  std::vector<std::string> result;
  for (auto start = line.find_first_not_of(kBlank); start != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(kBlank, start), line.size());
    result.emplace_back(line.substr(start, end - start));
    start = line.find_first_not_of(kBlank, end);
  }
  return result;
}

std::vector<std::string> fields(std::string_view line, char separator) {
  std::vector<std::string> result;
  for (std::size_t start = 0;;) {
    const auto end = line.find(separator, start);
    result.push_back(trimmed(line.substr(start, end - start)));
    if (end == std::string_view::npos) return result;
    start = end + 1;
  }
}

std::optional<double> parseDouble(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string formatDouble(double value) {
  std::array<char, 64> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string formatDouble(double value, int significant_digits) {
  std::array<char, 64> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                    std::chars_format::general, significant_digits);
  return {buffer.data(), result.ptr};
}

std::string formatFixed(double value, int decimals) {
  std::array<char, 400> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                    std::chars_format::fixed, decimals);
  return {buffer.data(), result.ptr};
}

}  // namespace colonnade
