// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/base/config.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

[[noreturn]] void refuse(const std::string& message) { throw Error(message, ExitCode::kUsage); }

/// Levenshtein distance: the fewest insertions, deletions and replacements between two keys.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string nearest(const std::string& word, const std::vector<std::string>& known) {
  return *std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
    return editDistance(word, a) < editDistance(word, b);
  });
}

std::string withoutComment(const std::string& line) {
  return trimmed(line.substr(0, std::min({line.find("//"), line.find(';'), line.find('#')})));
}

}  // namespace

class Config::Reader : public OptionVisitor {
 public:
  Reader(Config& config, std::string section) : config_(config), section_(std::move(section)) {}

  void number(const char* key, double& value, Range range, const char*) override {
    if (const Entry* entry = take(key)) value = parse(key, *entry, range);
  }
  void angle(const char* key, double& value_rad, Range range_deg, const char*) override {
    if (const Entry* entry = take(key)) value_rad = radians(parse(key, *entry, range_deg));
  }
  void integer(const char* key, int& value, Range range, const char*) override {
    const Entry* entry = take(key);
    if (!entry) return;
    const double number = parse(key, *entry, range);
    if (number != std::floor(number)) complain(key, *entry, "is not a whole number");
    value = static_cast<int>(number);
  }
  void flag(const char* key, bool& value, const char*) override {
    const Entry* entry = take(key);
    if (!entry) return;
    if (entry->value == "true" || entry->value == "1") {
      value = true;
    } else if (entry->value == "false" || entry->value == "0") {
      value = false;
    } else {
      complain(key, *entry, "is not true or false");
    }
  }
  void choice(const char* key, std::string& value, const std::vector<std::string>& allowed,
              const char*) override {
    const Entry* entry = take(key);
    if (!entry) return;
    if (std::find(allowed.begin(), allowed.end(), entry->value) == allowed.end())
      complain(key, *entry, "is none of " + joined(allowed, ", "));
    value = entry->value;
  }

 private:
  const Entry* take(const char* key) {
    config_.known_[section_].emplace_back(key);
    const auto section = config_.entries_.find(section_);
    if (section == config_.entries_.end()) return nullptr;
    const auto entry = section->second.find(key);
    if (entry == section->second.end()) return nullptr;
    entry->second.used = true;
    return &entry->second;
  }
  [[noreturn]] void complain(const char* key, const Entry& entry, const std::string& what) const {
    refuse(entry.where + ": " + section_ + "." + key + " = " + entry.value + " " + what);
  }
  double parse(const char* key, const Entry& entry, Range range) const {
    const auto number = parseDouble(entry.value);
    if (!number || !std::isfinite(*number)) complain(key, entry, "is not a number");
    if (*number < range.low || *number > range.high)
      complain(key, entry,
               "is outside " + formatDouble(range.low) + " .. " + formatDouble(range.high));
    return *number;
  }

  Config& config_;
  std::string section_;
};

Config Config::fromFile(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path))
    refuse(path.string() + ": cannot be read as a configuration file");
  std::ostringstream text;
  text << file.rdbuf();
  return fromText(text.str(), path.string());
}

Config Config::fromText(const std::string& text, const std::string& name) {
  Config config;
  std::istringstream lines(text);
  std::string raw;
  std::string section;
  for (int number = 1; std::getline(lines, raw); ++number) {
    const std::string line = withoutComment(raw);
    const std::string where = name + ":" + std::to_string(number);
    if (line.empty()) continue;
    if (line.front() == '[') {
      if (line.back() != ']' || line.size() < 3) refuse(where + ": a section is written [Name]");
      section = line.substr(1, line.size() - 2);
      continue;
    }
    const auto equals = line.find('=');
    if (equals == std::string::npos || equals == 0)
      refuse(where + ": expected \"key = value\", found \"" + line + "\"");
    if (section.empty()) refuse(where + ": a key must stand under a [Section]");
    const std::string key = trimmed(line.substr(0, equals));
    const auto [entry, isNew] =
        config.entries_[section].emplace(key, Entry{trimmed(line.substr(equals + 1)), where});
    if (!isNew)
      refuse(where + ": " + section + "." + key + " stands already at " + entry->second.where);
  }
  return config;
}

void Config::set(const std::string& assignment) {
  const auto dot = assignment.find('.');
  const auto equals = assignment.find('=');
  if (dot == std::string::npos || equals == std::string::npos || dot == 0 || equals < dot + 2)
    refuse("--set " + assignment + ": expected Section.key=value");
  entries_[trimmed(assignment.substr(0, dot))]
          [trimmed(assignment.substr(dot + 1, equals - dot - 1))] =
              Entry{trimmed(assignment.substr(equals + 1)), "--set"};
}

void Config::requireAllKnown() const {
  std::vector<std::string> sections;
  for (const auto& [section, keys] : known_) sections.push_back(section);
  for (const auto& [section, entries] : entries_) {
    const auto known = known_.find(section);
    for (const auto& [key, entry] : entries) {
      if (entry.used) continue;
      if (known == known_.end())
        refuse(entry.where + ": no section [" + section + "]" +
               (sections.empty() ? "" : "; did you mean [" + nearest(section, sections) + "]?"));
      refuse(entry.where + ": no key " + section + "." + key + "; did you mean " + section + "." +
             nearest(key, known->second) + "?");
    }
  }
}

std::unique_ptr<OptionVisitor> Config::makeReader(const char* section) {
  return std::make_unique<Reader>(*this, section);
}

namespace {

class WritingVisitor : public OptionVisitor {
 public:
  explicit WritingVisitor(std::ostringstream& text) : text_(text) {}
  void number(const char* key, double& value, Range range, const char* meaning) override {
    line(key, formatDouble(value), interval(range) + meaning);
  }
  void angle(const char* key, double& value_rad, Range range_deg, const char* meaning) override {
    // Twelve digits: 8 degrees come back as 8, not as the rounding of 8 * pi / 180.
    line(key, formatDouble(degrees(value_rad), 12), interval(range_deg) + meaning);
  }
  void integer(const char* key, int& value, Range range, const char* meaning) override {
    line(key, std::to_string(value), interval(range) + meaning);
  }
  void flag(const char* key, bool& value, const char* meaning) override {
    line(key, value ? "true" : "false", meaning);
  }
  void choice(const char* key, std::string& value, const std::vector<std::string>& allowed,
              const char* meaning) override {
    line(key, value, joined(allowed, " | ") + ": " + meaning);
  }

 private:
  static std::string interval(Range range) {
    return formatDouble(range.low) + " .. " + formatDouble(range.high) + ": ";
  }
  void line(const char* key, const std::string& value, const std::string& comment) {
    text_ << "# " << comment << "\n" << key << " = " << value << "\n";
  }
  std::ostringstream& text_;
};

}  // namespace

std::unique_ptr<OptionVisitor> ConfigWriter::makeVisitor(const char* section) {
  text_ << (text_.tellp() > 0 ? "\n" : "") << "[" << section << "]\n";
  return std::make_unique<WritingVisitor>(text_);
}

}  // namespace colonnade
