// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace colonnade {

/// A line across = offset + slope (s - middle).
struct Straight {
  double middle = 0.0;
  double offset = 0.0;
  double slope = 0.0;
  double across(double s) const { return offset + slope * (s - middle); }
};

/// Some neighbouring ones of the edge pixels beside a line, in the order of s.
struct SampleSpan {
  const double* s = nullptr;       ///< step along
  const double* across = nullptr;  ///< sub-pixel
  const int* t = nullptr;          ///< the pixel across
  std::size_t count = 0;

  std::size_t size() const { return count; }
  bool empty() const { return count == 0; }
  SampleSpan first(std::size_t some) const { return {s, across, t, some}; }
  SampleSpan subspan(std::size_t from) const {
    return {s + from, across + from, t + from, count - from};
  }
};

/// Edge pixels beside a line; one at most in each step, so there is room for all from the start.
class Samples {
 public:
  explicit Samples(int most = 0)
      : s_(static_cast<std::size_t>(most)), across_(s_.size()), t_(s_.size()) {}

  std::size_t size() const { return count_; }
  void clear() { count_ = 0; }
  /// A pixel, not measured yet.
  void add(int s, int t) {
    s_[count_] = s;
    t_[count_++] = t;
  }
  /// Of each, to be set.
  double* across() { return across_.data(); }
  operator SampleSpan() const { return {s_.data(), across_.data(), t_.data(), count_}; }

  /// Takes over those within reach of a line; `some` may be these.
  void assignWithin(SampleSpan some, const Straight& line, double reach);
  void assign(SampleSpan some);

 private:
  std::vector<double> s_, across_;
  std::vector<int> t_;
  std::size_t count_ = 0;
};

/// Least squares, with what they say of a covariance.
struct LineFit {
  Straight line;
  double samples = 0.0;
  double spread = 0.0;  ///< sum of (s - middle) squared
};
/// Nothing for fewer than three samples. The same bits on every machine.
std::optional<LineFit> leastSquares(SampleSpan samples);

double sumOfSquaredResiduals(SampleSpan samples, const Straight& line);

/// How many samples agree with the line; may stop short of that when it cannot exceed `beat`.
int countWithin(SampleSpan samples, const Straight& line, double reach, int beat);

}  // namespace colonnade
