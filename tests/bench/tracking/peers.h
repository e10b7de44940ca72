// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Other trackers for comparison, with the interface of Tracker. They use OpenCV directly, with its
/// defaults where it has some. None of them detects cuts; the first frame restarts each.
#pragma once

#include <memory>

#include "core/tracking/tracker.h"

namespace spidar::bench {

/// The obvious wiring: a frame converted from BGR, 200 Shi–Tomasi points of it, Lucas–Kanade with
/// windows of 21×21 px and 3 levels at full size. Ids are of one frame only.
std::unique_ptr<Tracker> make_naive();

/// Flow of every pixel at a width of 480 px, taken at every 16th of them. A grid point has the same
/// id in all frames.
std::unique_ptr<Tracker> make_dis_ultrafast();
std::unique_ptr<Tracker> make_farneback();

/// One displacement for the whole frame, by phase correlation at a width of 480 px.
std::unique_ptr<Tracker> make_phase_correlation();

}  // namespace spidar::bench
