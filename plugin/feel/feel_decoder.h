// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Lets players be felt that are built on uridecodebin or decodebin instead of playbin: the filter
/// goes inside the decoder, before its pad, so that the application's own links stay as they are.
/// Each function is called for every element or pad of the process, in any thread, and returns at
/// once for what is not part of such a decoder.
#pragma once

#include <gst/gst.h>

namespace spidar {

/// Call it before `element` goes from PAUSED to PLAYING. Where its video goes to a screen, opens
/// the device and puts the filter in.
void feel_decoder(GstElement* element);

/// Call it after a link was made. The first frame that passes a pad which is linked while the
/// decoder plays does the same.
void feel_linked_pad(GstPad* source, GstPad* sink);

/// Call it after a link from `source` was undone. A decoder that takes the filter from its pad
/// finds the former target free, and can link it again; the next frame then puts the filter back
/// in.
void free_unlinked_target(GstPad* source);

/// Call it after `pad` was removed from `element`. Takes the filter out again.
void forget_removed_pad(GstElement* element, GstPad* pad);

}  // namespace spidar
