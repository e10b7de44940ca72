// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How fast a track changes: no motion in a film is faster than 30 Hz, and most sound is.
#pragma once

#include <array>
#include <cstddef>

#include "core/track/track_format.h"

namespace spidar::tracks {

/// A channel with a larger fraction of its energy above 30 Hz is sound for ears.
constexpr double kMostFast = 0.1;

/// Energies of samples that come one after the other, `rate_Hz` of them a second.
class Band {
 public:
  explicit Band(double rate_Hz = kTrackRate_Hz);
  void add(const TrackSample& sample);

  /// Sum of the squares of a channel's samples, in fractions of the full scale.
  double energy(size_t channel) const { return energy_[channel]; }
  /// Fraction of it above 30 Hz; 0 while there is none.
  double above_30_Hz(size_t channel) const;
  /// The first channel that is sound for ears, by at least a second of samples that are felt:
  /// a shorter part of a track may be a single step. -1: none.
  int sound_channel() const;

 private:
  /// Second-order Butterworth high-pass filter, by the bilinear transform.
  class HighPass {
   public:
    explicit HighPass(double rate_Hz);
    double next(double x);

   private:
    double b_, a1_, a2_;
    double x1_ = 0, x2_ = 0, y1_ = 0, y2_ = 0;
  };

  double rate_Hz_;
  std::array<HighPass, kTrackChannels> filters_;
  std::array<double, kTrackChannels> energy_{}, fast_{};
  std::array<double, kTrackChannels> felt_s_{};
};

/// "fx", …, "tz".
const char* channel_name(size_t channel);
/// What a sample of 1.0 is, in N or N m.
double full_scale(size_t channel);

}  // namespace spidar::tracks
