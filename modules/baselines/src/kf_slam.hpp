// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "colonnade/baselines/baseline.hpp"

namespace colonnade {

/// mrpt::slam::CRangeBearingKFSLAM2D, the filter of MRPT's kf-slam, on Colonnade's detections and
/// motion. It needs range and bearing of points: pillar edges with range and depth-slope corners;
/// floor edges and bearings without range it cannot use. It knows one noise for all measurements
/// of a step: the mean of their variances.
class KfSlam : public Baseline {
 public:
  explicit KfSlam(const BaselineOptions& options);
  ~KfSlam() override;
  BaselineStep step(const Frame& frame) override;
  LandmarkMap landmarks() const override;
  std::map<std::string, double> figures() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
