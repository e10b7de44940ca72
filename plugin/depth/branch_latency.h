// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Combines the latency of several branches that meet in one element.
#pragma once

#include <initializer_list>

#include <gst/gst.h>

namespace spidar {

/// Answers the latency query from the branches upstream of these sink pads. The result is live if
/// any branch is live; its minimum is the largest of the live branches' minima and its maximum the
/// smallest of their maxima. Unlinked pads are ignored. Returns FALSE when a branch does not
/// answer.
gboolean query_latency(std::initializer_list<GstPad*> sink_pads, GstQuery* query);

}  // namespace spidar
