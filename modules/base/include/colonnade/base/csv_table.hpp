// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace colonnade {

/// Reads a table row by row: a header line naming the columns, then one line a row, separated by
/// commas. Columns may stand in any order and there may be further ones; empty lines and lines that
/// begin with # are skipped. All mistakes throw Error naming file, line and column.
class CsvTable {
 public:
  /// `what` the table is, for errors, such as "a landmark file".
  CsvTable(const std::filesystem::path& path, const std::vector<std::string>& required_columns,
           const std::string& what);

  class Row {
   public:
    bool has(const char* column) const { return columns_->contains(column); }
    const std::string& text(const char* column) const;
    bool empty(const char* column) const { return text(column).empty(); }
    double number(const char* column) const;  ///< finite
    std::int32_t integer(const char* column) const;
    [[noreturn]] void complain(const char* column, const std::string& wanted) const;
    const std::string& where() const { return where_; }  ///< file:line

   private:
    friend class CsvTable;
    const std::map<std::string, std::size_t>* columns_ = nullptr;
    std::vector<std::string> entries_;
    std::string where_;
  };
  /// The next row, valid as long as the table; nothing at the end.
  std::optional<Row> next();

 private:
  bool nextLine(std::string& line);
  void readHeader(const std::string& line, const std::vector<std::string>& required,
                  const std::string& what);
  std::string where() const { return path_.string() + ":" + std::to_string(line_number_); }

  std::filesystem::path path_;
  std::ifstream file_;
  int line_number_ = 0;
  std::map<std::string, std::size_t> columns_;
};

}  // namespace colonnade
