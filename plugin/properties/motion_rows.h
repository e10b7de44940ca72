// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Parts of the table of spidarmotion's properties.
#pragma once

#include <vector>

#include "plugin/properties/motion_properties.h"
#include "plugin/properties/property_table.h"

namespace spidar {

using MotionRow = Property<MotionProperties>;

/// Which motion is felt, and how: from `controller` to `filter-beta`.
std::vector<MotionRow> feel_rows();
/// How motion and force are shown.
std::vector<MotionRow> display_rows();
/// What is touched in the picture.
std::vector<MotionRow> touch_rows();

}  // namespace spidar
