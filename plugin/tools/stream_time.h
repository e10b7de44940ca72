// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Files in which the times are those that a player shows as the position in the film.
#pragma once

#include <gst/gst.h>

namespace spidar {

/// Moves the segments that pass `pad` so that running time is stream time, which the track is found
/// by when it is replayed. They differ where a film does not begin at 0: MPEG-TS, MPEG-PS, FLV.
void follow_stream_time(GstPad* pad);

}  // namespace spidar
