// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "statement.hpp"

#include <cmath>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {

Statement::Statement(const std::string& line, std::string where) : where_(std::move(where)) {
  for (const auto& word : colonnade::words(line.substr(0, line.find('#')))) {
    const auto equals = word.find('=');
    if (keyword_.empty()) {
      keyword_ = word;
    } else if (equals == std::string::npos) {
      if (!values_.empty()) fail("'" + word + "' stands after key=value; words come first");
      words_.push_back(word);
    } else {
      const auto key = word.substr(0, equals);
      if (!values_.emplace(key, word.substr(equals + 1)).second) fail("key '" + key + "' twice");
    }
  }
}

void Statement::fail(const std::string& what) const {
  throw Error(where_ + ": " + (keyword_.empty() ? "" : keyword_ + ": ") + what, ExitCode::kUsage);
}

const std::string& Statement::word(std::size_t index, const char* meaning) const {
  if (index >= words_.size()) fail(std::string(meaning) + " is missing");
  return words_[index];
}

double Statement::numberWord(std::size_t index, const char* meaning) const {
  const auto& text = word(index, meaning);
  const auto value = parseDouble(text);
  if (!value || !std::isfinite(*value)) {
    fail(std::string(meaning) + " must be a number, not '" + text + "'");
  }
  if (std::abs(*value) > 1e5) fail(std::string(meaning) + " is beyond 100000: " + text);
  return *value;
}

Eigen::Vector2d Statement::point(std::size_t index, const char* meaning) const {
  return {numberWord(index, meaning), numberWord(index + 1, meaning)};
}

const std::string* Statement::find(const char* key) {
  asked_.insert(key);
  const auto found = values_.find(key);
  return found == values_.end() ? nullptr : &found->second;
}

std::vector<double> Statement::numbers(const char* key, std::size_t count, Range range) {
  const auto* text = find(key);
  if (!text) return {};
  std::vector<double> result;
  for (const auto& field : fields(*text, ',')) {
    const auto value = parseDouble(field);
    if (!value) fail(std::string(key) + " must be a number, not '" + field + "'");
    if (!(*value >= range.low && *value <= range.high)) {
      fail(std::string(key) + " = " + field + " is outside " + formatDouble(range.low) + " to " +
           formatDouble(range.high));
    }
    result.push_back(*value);
  }
  if (result.size() != count) {
    fail(std::string(key) + " needs " + std::to_string(count) + " number(s), has " +
         std::to_string(result.size()));
  }
  return result;
}

std::string Statement::text(const char* key, const std::string& otherwise) {
  const auto* text = find(key);
  return text ? *text : otherwise;
}

void Statement::pair(const char* key, Eigen::Vector2d& value, Range range) {
  const auto list = numbers(key, 2, range);
  if (!list.empty()) value = {list[0], list[1]};
}

void Statement::triple(const char* key, Eigen::Vector3d& value, Range range) {
  const auto list = numbers(key, 3, range);
  if (!list.empty()) value = {list[0], list[1], list[2]};
}

void Statement::number(const char* key, double& value, Range range, const char*) {
  const auto list = numbers(key, 1, range);
  if (!list.empty()) value = list[0];
}

void Statement::angle(const char* key, double& value_rad, Range range_deg, const char*) {
  const auto list = numbers(key, 1, range_deg);
  if (!list.empty()) value_rad = radians(list[0]);
}

void Statement::integer(const char* key, int& value, Range range, const char*) {
  const auto list = numbers(key, 1, range);
  if (list.empty()) return;
  if (list[0] != std::round(list[0])) fail(std::string(key) + " must be a whole number");
  value = static_cast<int>(list[0]);
}

void Statement::flag(const char* key, bool& value, const char*) {
  const auto* text = find(key);
  if (!text) return;
  if (*text != "0" && *text != "1") fail(std::string(key) + " must be 0 or 1, not '" + *text + "'");
  value = *text == "1";
}

void Statement::choice(const char* key, std::string& value, const std::vector<std::string>& allowed,
                       const char*) {
  const auto* text = find(key);
  if (!text) return;
  for (const auto& option : allowed) {
    if (option == *text) {
      value = option;
      return;
    }
  }
  fail(std::string(key) + " must be one of " + joined(allowed, ", ") + ", not '" + *text + "'");
}

void Statement::finish(std::size_t words) const {
  if (words_.size() > words) fail("'" + words_[words] + "' is not expected here");
  for (const auto& [key, value] : values_) {
    if (asked_.count(key)) continue;
    const std::vector<std::string> known(asked_.begin(), asked_.end());
    fail("unknown key '" + key + "'; known: " + (known.empty() ? "none" : joined(known, ", ")));
  }
}

}  // namespace colonnade
