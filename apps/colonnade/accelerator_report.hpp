// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "accelerator_times.hpp"

namespace colonnade {

/// The figures of the thesis (2015, figures 53, 61, 67, 72, 73) beside ours: resources and clock
/// rates as hdl/measure.py has measured them for the RTL of this program, times as measured now.
nlohmann::ordered_json acceleratorFigures(const std::vector<SoftwareTimes>& software,
                                          const std::vector<HardwareTimes>& hardware,
                                          const std::string& picture);

/// The same as Markdown tables.
std::string acceleratorTables(const nlohmann::ordered_json& figures);

}  // namespace colonnade
