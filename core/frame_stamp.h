// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// When a frame is shown, and in which run of its film.
#pragma once

#include <cstdint>

namespace spidar {

struct FrameStamp {
  /// Counts the runs of playback: a frame of another run does not follow the one before. A seek of
  /// any length, another film and another rate begin one; a gap in the film does not.
  uint32_t epoch = 0;
  int64_t stream_ns = -1;   ///< position in the film of what is to be seen of it; −1: not known
  int64_t running_ns = -1;  ///< at which that is shown, its end if backwards; −1: not known
  int64_t length_ns = 0;    ///< of stream time, for which it is shown; 0: not known
  double rate = 1;          ///< of stream time against running time; negative: backwards
};

}  // namespace spidar
