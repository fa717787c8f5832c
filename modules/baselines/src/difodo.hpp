// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "colonnade/baselines/baseline.hpp"

namespace colonnade {

/// mrpt::vision::CDifodo: visual odometry from depth alone (Jaimez and Gonzalez-Jimenez, T-RO
/// 31(4), 2015), with its slow pyramid (the fast one fails an assertion in MRPT 2.5.8). It assumes
/// an ideal camera of 320x240 with square pixels and a centred principal point; depth is resampled
/// to one, nearest neighbour. It uses neither colour nor odometry nor a flat floor.
class Difodo : public Baseline {
 public:
  Difodo(const DifodoOptions& options, const MotionOptions& motion);
  ~Difodo() override;
  BaselineStep step(const Frame& frame) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
