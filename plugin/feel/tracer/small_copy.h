// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frames in GPU memory: the shown frames stay there, and a small copy of each is analysed.
#pragma once

#include <gst/gst.h>

namespace spidar {

/// Returns caps, owned by the caller, with the GPU memory (GL, VA-API) of which installed elements
/// make small copies, and any size and format; empty without such elements.
GstCaps* gpu_caps();

/// Whether frames of these caps are outside of the processor's memory.
bool is_in_gpu(const GstCaps* caps);

/// A bin that passes frames of `caps`, which intersect with gpu_caps(), and gives small copies of
/// them to `motion` first. Returns a floating reference, or null when an element is missing.
GstElement* small_copy_bin_new(const GstCaps* caps, GstElement* motion);

}  // namespace spidar
