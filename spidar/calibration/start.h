// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Poses and parameters near enough to the right ones for a refinement, from nothing but counts.
#pragma once

#include <vector>

#include "spidar/calibration/bundle_adjustment.h"
#include "spidar/calibration/model.h"

namespace spidar {

/// Plain least squares from several starts on some forty of the samples, spread evenly; the best
/// fit wins, and places the others. Wrong minima show by their residual, which is a hundred times
/// that of the right one; which start leads there cannot be known before. `sure_m`: a residual
/// (root mean square over strings) that only the right minimum has ends the search.
Bundle find_bundle(const CalibrationModel& model, const std::vector<StringVector>& paid_out_m,
                   double sure_m);

}  // namespace spidar
