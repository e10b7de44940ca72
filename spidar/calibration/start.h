// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds poses and parameters that are close enough to the right ones for a refinement, from the
/// counts alone.
#pragma once

#include <vector>

#include "spidar/calibration/bundle_adjustment.h"
#include "spidar/calibration/model.h"

namespace spidar {

/// Fits some forty evenly spread samples with plain least squares from several starts. The best fit
/// is used to find the poses of the other samples. Wrong minima are recognised by their residual,
/// which is a hundred times that of the right one; it cannot be predicted which start leads to the
/// right one. The search ends at a residual (root mean square over strings) below `sure_m`, which
/// only the right minimum has.
Bundle find_bundle(const CalibrationModel& model, const std::vector<StringVector>& paid_out_m,
                   double sure_m);

}  // namespace spidar
