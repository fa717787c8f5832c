// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/frames/frame.hpp"

namespace mrpt::obs {
class CObservationBearingRange;
}

namespace colonnade {

/// The readings of an MRPT observation: metres and radians, as they are.
RangeBearingScan rangeBearingOf(const mrpt::obs::CObservationBearingRange& observation);

}  // namespace colonnade
