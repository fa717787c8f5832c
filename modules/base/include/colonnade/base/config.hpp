// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "colonnade/base/options.hpp"

namespace colonnade {

/// An INI file in MRPT's manner ([Section], key = value, comments from // ; or #), each value
/// remembering where it stands. All mistakes throw Error with ExitCode::kUsage.
class Config {
 public:
  Config() = default;

  /// Throws when the file is missing, a line is no "key = value", or a key stands twice.
  static Config fromFile(const std::filesystem::path& path);
  static Config fromText(const std::string& text, const std::string& name);

  /// Takes one `Section.key=value` of the command line; it wins over the file.
  void set(const std::string& assignment);

  /// Fills `options` from its section, or throws naming file, line, key and allowed range.
  template <class Options>
  void read(Options& options) {
    const auto reader = makeReader(Options::kSection);
    options.visit(*reader);
  }

  /// Throws for the first entry no options struct asked for, naming the nearest known key.
  void requireAllKnown() const;

 private:
  struct Entry {
    std::string value;
    std::string where;  ///< "file.ini:12" or "--set"
    bool used = false;
  };
  class Reader;
  std::unique_ptr<OptionVisitor> makeReader(const char* section);

  std::map<std::string, std::map<std::string, Entry>> entries_;  ///< section -> key -> entry
  std::map<std::string, std::vector<std::string>> known_;        ///< section -> keys asked for
};

/// Writes options as an INI section with the meaning and range of each key beside it.
class ConfigWriter {
 public:
  template <class Options>
  void add(Options options) {
    const auto visitor = makeVisitor(Options::kSection);
    options.visit(*visitor);
  }
  std::string text() const { return text_.str(); }

 private:
  std::unique_ptr<OptionVisitor> makeVisitor(const char* section);
  std::ostringstream text_;
};

}  // namespace colonnade
