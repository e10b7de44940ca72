// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// OpenCV without its threads.
#pragma once

#include <opencv2/core/utility.hpp>

namespace spidar {

/// Runs `work` so that OpenCV functions in it stay on the calling thread.
///
/// The streaming thread shares the machine with a decoder and the 1 kHz loop: at the tracker's
/// small pictures a second thread saves less than a millisecond a frame and takes a core away from
/// them. cv::setNumThreads() is not for a library, it holds for the whole process. But OpenCV does
/// not split a parallel_for_ inside another one, so one stripe around the work is enough. The only
/// trace outside is that parallel loops which other threads start in the meantime are not split
/// either.
template <typename Work>
void run_on_this_thread(Work&& work) {
  cv::parallel_for_(cv::Range(0, 1), [&work](const cv::Range&) { work(); });
}

}  // namespace spidar
