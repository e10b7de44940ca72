// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Ways to play a video.
#pragma once

#include <cstdint>
#include <vector>

namespace spidar::bench {

enum class Source {
  kPlaybin,     ///< the clip, as players play it
  kPlaybin3,    ///< the same with the newer one
  kTestSource,  ///< live: videotestsrc
  kCamera,      ///< live: Camera
};

struct Scenario {
  const char* what;  ///< for the table
  Source source = Source::kPlaybin;
  double rate = 1;
  int seeks = 0;             ///< before what is measured
  bool sound = false;        ///< with the clock of a sound card that runs kDrift too fast
  int64_t av_offset_ns = 0;  ///< the player's: > 0: the picture is shown later than the sound
  bool track = false;        ///< spidarsink plays a track beside the film, and nothing is analysed
};

constexpr double kDrift = 300e-6;

inline const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all = {
      {"file, playbin"},
      {"file, playbin3", Source::kPlaybin3},
      {"live, videotestsrc", Source::kTestSource},
      {"live, frames as from a camera", Source::kCamera},
      {"file at rate 0.5", Source::kPlaybin, 0.5},
      {"file at rate 2", Source::kPlaybin, 2},
      {"file after 100 seeks", Source::kPlaybin, 1, 100},
      {"file with sound, clock +300 ppm", Source::kPlaybin, 1, 0, true},
      {"the same after 100 seeks", Source::kPlaybin, 1, 100, true},
      {"track by spidarsink", Source::kPlaybin, 1, 0, false, 0, true},
      {"the same after 100 seeks", Source::kPlaybin, 1, 100, false, 0, true},
      {"the same at rate 0.5", Source::kPlaybin, 0.5, 0, false, 0, true},
      {"the same at rate 2", Source::kPlaybin, 2, 0, false, 0, true},
      {"the same with sound, clock +300 ppm", Source::kPlaybin, 1, 0, true, 0, true},
      {"file with sound, av-offset 100 ms", Source::kPlaybin, 1, 0, true, 100'000'000},
  };
  return all;
}

}  // namespace spidar::bench
