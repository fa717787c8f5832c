// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>

#include "colonnade/base/landmark.hpp"

namespace colonnade {

/// How well what is measured agrees with what the filter expects, over a whole run.
class InnovationHealth {
 public:
  /// distance2 = nu^T S^-1 nu of one measurement before the update; its mean should be
  /// `degrees_of_freedom` (NIS).
  void accept(LandmarkKind kind, double distance2, int degrees_of_freedom);
  void refuse(const std::string& reason) { ++refused_[reason]; }

  /// Normalised innovation squared per degree of freedom, 1 for an honest filter; 0 without any.
  double meanNis(LandmarkKind kind) const;
  /// Sum of the degrees of freedom of the accepted measurements: the dof of their summed NIS.
  std::size_t degreesOfFreedom(LandmarkKind kind) const {
    return sums_[index(kind)].degrees_of_freedom;
  }
  std::size_t accepted(LandmarkKind kind) const { return sums_[index(kind)].count; }
  const std::map<std::string, std::size_t>& refused() const { return refused_; }

 private:
  struct Sum {
    double distance2 = 0.0;
    std::size_t degrees_of_freedom = 0;
    std::size_t count = 0;
  };
  static std::size_t index(LandmarkKind kind) { return static_cast<std::size_t>(kind); }
  std::array<Sum, kLandmarkKinds> sums_{};
  std::map<std::string, std::size_t> refused_;
};

}  // namespace colonnade
