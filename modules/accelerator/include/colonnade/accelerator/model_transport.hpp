// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "colonnade/accelerator/transport.hpp"
#include "colonnade/edges/fixed_stage.hpp"

namespace colonnade {

/// A Verilated model of hdl/rtl that this program holds.
struct AcceleratorModel {
  std::string name;
  cv::Size size;
  int pixels_per_clock = 1;
  FixedShape shape;
};

/// All of them: `run` for the sizes of cameras, `thesis` for the twelve angles at 120x120.
const std::vector<AcceleratorModel>& acceleratorModels();

/// Throws Error when `model` is none of acceleratorModels().
std::unique_ptr<AcceleratorTransport> makeModelTransport(const AcceleratorModel& model);

/// The sizes there is a model for with the shape of `run`.
std::vector<cv::Size> modelSizes();

/// The model for images of a size with the shape of `run`; nullptr if there is none.
std::unique_ptr<AcceleratorTransport> makeModelTransport(const cv::Size& size);

}  // namespace colonnade
