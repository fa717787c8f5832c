// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "colonnade/accelerator/transport.hpp"

namespace colonnade {

/// The sizes this program holds a Verilated model for.
std::vector<cv::Size> modelSizes();

/// The Verilated model of hdl/rtl for images of a size, with the shape of `run`; nullptr if there
/// is none.
std::unique_ptr<AcceleratorTransport> makeModelTransport(const cv::Size& size);

}  // namespace colonnade
