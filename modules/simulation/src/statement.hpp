// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "colonnade/base/options.hpp"

namespace colonnade {

/// One line of a world file: a keyword, words, and key=value pairs. Everything asked of it is
/// checked, and every error names file and line. As an OptionVisitor it fills options structs.
class Statement : public OptionVisitor {
 public:
  /// An empty line gives an empty keyword; # begins a comment.
  Statement(const std::string& line, std::string where);

  const std::string& keyword() const { return keyword_; }
  const std::string& where() const { return where_; }  ///< file:line
  std::size_t wordCount() const { return words_.size(); }

  const std::string& word(std::size_t index, const char* meaning) const;
  double numberWord(std::size_t index, const char* meaning) const;
  Eigen::Vector2d point(std::size_t index, const char* meaning) const;

  bool has(const std::string& key) const { return values_.count(key) > 0; }
  std::string text(const char* key, const std::string& otherwise);
  void pair(const char* key, Eigen::Vector2d& value, Range range);
  void triple(const char* key, Eigen::Vector3d& value, Range range);

  void number(const char* key, double& value, Range range, const char* meaning) override;
  void angle(const char* key, double& value_rad, Range range_deg, const char* meaning) override;
  void integer(const char* key, int& value, Range range, const char* meaning) override;
  void flag(const char* key, bool& value, const char* meaning) override;
  void choice(const char* key, std::string& value, const std::vector<std::string>& allowed,
              const char* meaning) override;

  /// Throws when a key was given that nobody asked for, or more words than were asked for.
  void finish(std::size_t words) const;
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::vector<double> numbers(const char* key, std::size_t count, Range range);
  const std::string* find(const char* key);

  std::string where_;
  std::string keyword_;
  std::vector<std::string> words_;
  std::map<std::string, std::string> values_;
  std::set<std::string> asked_;
};

}  // namespace colonnade
