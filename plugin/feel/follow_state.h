// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The state of an element that joins a bin while the bin runs.
#pragma once

#include <gst/gst.h>

namespace spidar {

/// The state of `element`, or the one that it is changing to.
GstState state_of(GstElement* element);

/// Like gst_element_sync_state_with_parent(), but repeats when the application has changed the
/// state of `bin` meanwhile. Otherwise `element` could return to a state that the bin has left.
void follow_state(GstElement* bin, GstElement* element);

}  // namespace spidar
