// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/edges/edge_line_backend.hpp"

#include "colonnade/base/error.hpp"
#include "opencv_backend.hpp"

namespace colonnade {

std::unique_ptr<EdgeLineBackend> makeEdgeLineBackend(const std::string& name,
                                                     const EdgeOptions& options) {
  if (name == "opencv") return std::make_unique<OpencvBackend>(options);
  throw Error("no edge backend \"" + name + "\" in this program; available: opencv",
              ExitCode::kUsage);
}

}  // namespace colonnade
