// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The film that is played.
#pragma once

#include <string>

namespace spidar::bench {

/// The first element that is needed to make or to play it and is not installed, or empty.
std::string missing_element();

/// A ball jumps about for `seconds`, with a tone: 1280x720, 29.97 frames/s, VP8 with a key frame
/// every half second, and PCM, in AVI, which counts frames exactly. Throws std::runtime_error.
void make_clip(const std::string& path, int seconds);

/// The haptic track of a clip: 1 N at 1 Hz on every axis, in WAV, for as many seconds. Throws
/// std::runtime_error.
void make_track(const std::string& path, int seconds);
/// Where measure() looks for the track of a clip.
std::string track_of(const std::string& clip);

}  // namespace spidar::bench
