// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <gst/video/gstvideofilter.h>
#include <gst/video/video.h>

G_BEGIN_DECLS

#define GST_TYPE_SPIDAR_MOTION (gst_spidar_motion_get_type())
G_DECLARE_FINAL_TYPE(GstSpidarMotionFilter, gst_spidar_motion, GST, SPIDAR_MOTION, GstVideoFilter)

GST_ELEMENT_REGISTER_DECLARE(spidarmotion)

G_END_DECLS

namespace spidar::filter {
struct MotionState;
}  // namespace spidar::filter

/// The state of `self`, for tests that step the element.
spidar::filter::MotionState& gst_spidar_motion_state(GstSpidarMotionFilter* self);
