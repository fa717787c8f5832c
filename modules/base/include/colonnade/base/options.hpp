// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace colonnade {

/// The closed interval a number of the configuration must lie in.
struct Range {
  double low;
  double high;
};

/// Walks over the fields of an options struct. Every options struct has
///   static constexpr const char* kSection = "Pillars";
///   void visit(OptionVisitor& v);
/// and names each field once: that one list reads, checks, documents and writes it. Fields hold SI
/// units and radians; `angle` converts from the degrees of the file, its key ends in `_deg`.
class OptionVisitor {
 public:
  virtual ~OptionVisitor() = default;
  virtual void number(const char* key, double& value, Range range, const char* meaning) = 0;
  virtual void angle(const char* key, double& value_rad, Range range_deg, const char* meaning) = 0;
  virtual void integer(const char* key, int& value, Range range, const char* meaning) = 0;
  virtual void flag(const char* key, bool& value, const char* meaning) = 0;
  virtual void choice(const char* key, std::string& value, const std::vector<std::string>& allowed,
                      const char* meaning) = 0;
};

}  // namespace colonnade
