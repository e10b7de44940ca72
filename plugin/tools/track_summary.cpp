// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/track_summary.h"

#include <algorithm>
#include <cmath>

#include "core/force/motion_rendering.h"

namespace spidar {
namespace {

constexpr double kCorner_Hz = 30;

/// Second-order Butterworth high-pass filter, by the bilinear transform.
class HighPass {
 public:
  HighPass() {
    const double k = std::tan(M_PI * kCorner_Hz / kTrackRate_Hz);
    const double scale = 1 / (1 + std::sqrt(2.0) * k + k * k);
    b_ = scale;
    a1_ = 2 * (k * k - 1) * scale;
    a2_ = (1 - std::sqrt(2.0) * k + k * k) * scale;
  }
  double next(double x) {
    const double y = b_ * (x - 2 * x1_ + x2_) - a1_ * y1_ - a2_ * y2_;
    x2_ = x1_;
    x1_ = x;
    y2_ = y1_;
    y1_ = y;
    return y;
  }

 private:
  double b_, a1_, a2_;
  double x1_ = 0, x2_ = 0, y1_ = 0, y2_ = 0;
};

}  // namespace

const char* channel_name(size_t channel) {
  constexpr std::array<const char*, kTrackChannels> kNames = {"fx", "fy", "fz", "tx", "ty", "tz"};
  return kNames.at(channel);
}

const char* channel_unit(size_t channel) {
  return channel < kTrackChannels / 2 ? " N" : " N m";
}

double full_scale(size_t channel) {
  return channel < kTrackChannels / 2 ? kTrackForceScale_N : kTrackTorqueScale_Nm;
}

TrackSummary summarise(const std::vector<TrackSample>& samples) {
  TrackSummary summary;
  std::array<HighPass, kTrackChannels> filters;
  std::array<double, kTrackChannels> energy{}, fast{};
  Wrench before;
  size_t felt = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    const TrackSample& sample = samples[i];
    for (size_t channel = 0; channel < kTrackChannels; ++channel) {
      const double value = sample[channel];
      summary.channels[channel].peak = std::max(summary.channels[channel].peak, std::fabs(value));
      energy[channel] += value * value;
      const double high = filters[channel].next(value);
      fast[channel] += high * high;
    }
    const Wrench wrench = to_wrench(sample);
    summary.largest_force_N = std::max(summary.largest_force_N, wrench.force_N.norm());
    summary.largest_torque_Nm = std::max(summary.largest_torque_Nm, wrench.torque_Nm.norm());
    if (i > 0) {
      const double change_N_s = (wrench.force_N - before.force_N).norm() * kTrackRate_Hz;
      summary.steepest_N_s = std::max(summary.steepest_N_s, change_N_s);
    }
    felt += wrench.force_N.norm() >= kFeltForce_N ? 1 : 0;
    before = wrench;
  }
  if (!samples.empty()) {
    summary.felt = static_cast<double>(felt) / static_cast<double>(samples.size());
  }
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    if (energy[channel] <= 0) continue;
    summary.channels[channel].rms =
        std::sqrt(energy[channel] / static_cast<double>(samples.size()));
    summary.channels[channel].above_30_Hz = fast[channel] / energy[channel];
  }
  return summary;
}

}  // namespace spidar
