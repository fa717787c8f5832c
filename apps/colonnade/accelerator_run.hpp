// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "colonnade/base/error.hpp"

namespace colonnade {

struct AcceleratorRunArguments {
  std::filesystem::path log;
  double clock_mhz = 100.0;
  std::size_t max_frames = 0;  ///< 0: all
  std::size_t every = 1;
  std::string size;  ///< "320x240": frames are scaled to it; empty: as they are
};

/// Every frame of a log through the model and through `fixed`; kFailed at the first that differs.
ExitCode acceleratorRun(const AcceleratorRunArguments& arguments);

}  // namespace colonnade
