// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/base/csv_table.hpp"

#include <cmath>
#include <limits>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {

CsvTable::CsvTable(const std::filesystem::path& path, const std::vector<std::string>& required,
                   const std::string& what)
    : path_(path), file_(path) {
  if (!file_ || std::filesystem::is_directory(path))
    throw Error(path.string() + ": cannot be read as " + what);
  std::string line;
  if (!nextLine(line)) throw Error(path.string() + ": has no header line; it is not " + what);
  readHeader(line, required, what);
}

void CsvTable::readHeader(const std::string& line, const std::vector<std::string>& required,
                          const std::string& what) {
  const auto names = fields(line, ',');
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!columns_.emplace(names[i], i).second)
      throw Error(where() + ": column " + names[i] + " stands twice");
  for (const std::string& column : required)
    if (!columns_.contains(column))
      throw Error(where() + ": column " + column + " is missing; " + what + " starts with \"" +
                  joined(required, ",") + "\"");
}

bool CsvTable::nextLine(std::string& line) {
  while (std::getline(file_, line)) {
    ++line_number_;
    line = trimmed(line);
    if (!line.empty() && line.front() != '#') return true;
  }
  return false;
}

std::optional<CsvTable::Row> CsvTable::next() {
  std::string line;
  if (!nextLine(line)) return std::nullopt;
  Row row;
  row.columns_ = &columns_;
  row.entries_ = fields(line, ',');
  row.where_ = where();
  if (row.entries_.size() != columns_.size())
    throw Error(row.where_ + ": the header has " + std::to_string(columns_.size()) +
                " columns, this row " + std::to_string(row.entries_.size()));
  return row;
}

const std::string& CsvTable::Row::text(const char* column) const {
  return entries_[columns_->at(column)];
}

double CsvTable::Row::number(const char* column) const {
  const auto value = parseDouble(text(column));
  if (!value || !std::isfinite(*value)) complain(column, "a number");
  return *value;
}

std::int32_t CsvTable::Row::integer(const char* column) const {
  const double value = number(column);
  constexpr double kLimit = std::numeric_limits<std::int32_t>::max();
  if (value != std::floor(value) || std::abs(value) > kLimit) complain(column, "a whole number");
  return static_cast<std::int32_t>(value);
}

void CsvTable::Row::complain(const char* column, const std::string& wanted) const {
  throw Error(where_ + ": column " + column + ": \"" + text(column) + "\" is not " + wanted);
}

}  // namespace colonnade
