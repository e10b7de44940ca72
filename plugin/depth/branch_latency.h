// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The latency of several branches that meet in one element.
#pragma once

#include <initializer_list>

#include <gst/gst.h>

namespace spidar {

/// Answers the latency query for the branches upstream of these sink pads: live when one of them
/// is; min is the largest of the live ones, max the smallest. A pad that is not linked counts for
/// nothing. FALSE when a branch does not answer.
gboolean query_latency(std::initializer_list<GstPad*> sink_pads, GstQuery* query);

}  // namespace spidar
