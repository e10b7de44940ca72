// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How areas of several blocks move: in a picture out of focus, or of ice, no single block shows
/// it.
#pragma once

#include <vector>

#include "core/field/block_field.h"

namespace spidar {

/// Sets `areas` to those of kCoarser × kCoarser blocks, each of which overlaps its neighbours by
/// half, as measured in the coarse picture. Their lengths are in pixels of the field's picture,
/// their structure is in (grey / px)² of the coarse one. There are none while the field stands
/// still.
void find_areas(const BlockField& field, std::vector<MotionBlock>& areas);

/// The noise of a pixel of the coarse picture is kCoarser times less than that of the field's. What
/// says how much texture a block needs, (grey / px)², is so much less for an area.
constexpr float kOfAreas = 1.0f / (kCoarser * kCoarser);

}  // namespace spidar
