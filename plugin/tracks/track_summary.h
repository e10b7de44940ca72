// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Statistics of a track, and how fast it changes: most sound is faster than 30 Hz, no motion is.
#pragma once

#include <array>
#include <cstddef>

#include "core/track/track_format.h"

namespace spidar::tracks {

/// A channel with a larger fraction of its energy above 30 Hz is audible sound.
constexpr double kMaxFast = 0.1;

/// Energies of consecutive samples, `rate_Hz` of them a second.
class Band {
 public:
  explicit Band(double rate_Hz = kTrackRate_Hz);
  void add(const TrackSample& sample);

  /// The sum of the squares of a channel's samples, in fractions of the full scale.
  double energy(size_t channel) const { return energy_[channel]; }
  /// The fraction of the energy above 30 Hz; 0 without energy.
  double above_30_Hz(size_t channel) const;
  /// The first channel that is audible sound, by at least a second of samples that are felt: a
  /// shorter part of a track may be a single step. -1: none.
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
/// The force or torque of a sample of 1.0, in N or N m.
double full_scale(size_t channel);
/// " N" or " N m".
const char* channel_unit(size_t channel);
/// `value` with two significant digits, for reading and not for computing.
std::string rounded(double value);

/// Statistics of one channel, in fractions of the full scale.
struct ChannelSummary {
  double peak = 0;
  double rms = 0;
  double above_30_Hz = 0;  ///< fraction of the energy; no motion in a film is this fast
};

struct Summary {
  size_t samples = 0;
  std::array<ChannelSummary, kTrackChannels> channels;
  double largest_force_N = 0;
  double largest_torque_Nm = 0;
  double steepest_N_s = 0;  ///< largest rate of change of the force
  /// The fraction of the time with at least kFeltForce_N, where torque counts as the force at the
  /// radius of the grip (size_N()).
  double felt = 0;
};

/// Summarises consecutive samples, 1000 a second.
class Summariser {
 public:
  void add(const TrackSample& sample);
  Summary summary() const;

 private:
  Summary so_far_;
  Band band_;
  Wrench before_;
  size_t felt_ = 0;
};

}  // namespace spidar::tracks
