// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Subtitles as Matroska stores them.
#pragma once

#include <gst/gst.h>

namespace spidar {

/// matroskademux gives SubRip subtitles as Pango markup, which matroskamux does not accept. For
/// such caps: adds an element to `pipeline` that gives them back as they were in the file, and
/// returns it; nullptr for all others. Owned by the pipeline.
GstElement* add_plain_subtitles(GstElement* pipeline, const GstCaps* caps);

}  // namespace spidar
