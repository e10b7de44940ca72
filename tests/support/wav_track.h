// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <string>

#include "core/track/track_format.h"

namespace spidar::test {

inline TrackSample sample_at(double ms) {
  const auto fraction = static_cast<float>(0.15 * std::sin(0.01 * ms));
  return {fraction, -fraction / 2, fraction / 3, fraction / 100, 0, -fraction / 50};
}

/// A haptic track with known samples: a WAV file (IEEE float), one sample every millisecond.
inline void write_track(const std::string& path, int count,
                        const std::function<TrackSample(double)>& sample_of = sample_at) {
  std::string wav = "RIFF....WAVEfmt ";
  const auto put = [&wav](uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) wav += static_cast<char>(value >> (8 * i) & 0xff);
  };
  put(16, 4);
  put(3, 2);     // floats
  put(6, 2);     // channels
  put(1000, 4);  // samples a second
  put(24000, 4);
  put(24, 2);
  put(32, 2);
  wav += "data";
  put(static_cast<uint32_t>(count) * sizeof(TrackSample), 4);
  for (int i = 0; i < count; ++i) {
    const TrackSample sample = sample_of(i);
    wav.append(reinterpret_cast<const char*>(sample.data()), sizeof sample);
  }
  std::ofstream(path, std::ios::binary) << wav;
}

}  // namespace spidar::test
