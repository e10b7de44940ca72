// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frames in GPU memory: the shown frames stay there, and a small copy of each is felt.
#pragma once

#include <gst/gst.h>

namespace spidar {

/// The GPU memory from which the installed elements make small copies: of GL, and of VA-API.
/// Floating caps with any size and format, which the caller owns; empty without such elements.
GstCaps* gpu_caps();

/// Whether frames of these caps are outside of the processor's memory.
bool is_in_gpu(const GstCaps* caps);

/// A bin that passes frames of `caps`, which intersect with gpu_caps(), and gives small copies of
/// them to `motion` first. Returns a floating reference, or null when an element is missing.
GstElement* small_copy_bin_new(const GstCaps* caps, GstElement* motion);

}  // namespace spidar
