// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_summary.h"

#include <algorithm>
#include <cmath>

#include "core/wrench_size.h"
#include "spidar/text.h"

namespace spidar::tracks {
namespace {

constexpr double kCorner_Hz = 30;
/// A single step that is felt for this long has less than kMaxFast of its energy above 30 Hz.
constexpr double kJudged_s = 1;

/// The least value that is felt, in fractions of the full scale.
double least_felt(size_t channel) {
  return kFeltForce_N * (channel < kTrackChannels / 2 ? 1 : kTorqueArm_m) / full_scale(channel);
}

}  // namespace

const char* channel_name(size_t channel) {
  constexpr std::array<const char*, kTrackChannels> kNames = {"fx", "fy", "fz", "tx", "ty", "tz"};
  return kNames.at(channel);
}

double full_scale(size_t channel) {
  return channel < kTrackChannels / 2 ? kTrackForceScale_N : kTrackTorqueScale_Nm;
}

const char* channel_unit(size_t channel) {
  return channel < kTrackChannels / 2 ? " N" : " N m";
}

std::string rounded(double value) {
  if (value == 0) return "0";
  const double step = std::pow(10, std::floor(std::log10(std::fabs(value))) - 1);
  return as_text(std::round(value / step) * step);
}

Band::Band(double rate_Hz)
    : rate_Hz_(rate_Hz), filters_{HighPass(rate_Hz), HighPass(rate_Hz), HighPass(rate_Hz),
                                  HighPass(rate_Hz), HighPass(rate_Hz), HighPass(rate_Hz)} {}

Band::HighPass::HighPass(double rate_Hz) {
  const double k = std::tan(M_PI * kCorner_Hz / rate_Hz);
  const double scale = 1 / (1 + std::sqrt(2.0) * k + k * k);
  b_ = scale;
  a1_ = 2 * (k * k - 1) * scale;
  a2_ = (1 - std::sqrt(2.0) * k + k * k) * scale;
}

double Band::HighPass::next(double x) {
  const double y = b_ * (x - 2 * x1_ + x2_) - a1_ * y1_ - a2_ * y2_;
  x2_ = x1_;
  x1_ = x;
  y2_ = y1_;
  y1_ = y;
  return y;
}

void Band::add(const TrackSample& sample) {
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    const double value = sample[channel];
    energy_[channel] += value * value;
    const double high = filters_[channel].next(value);
    fast_[channel] += high * high;
    if (std::fabs(value) >= least_felt(channel)) felt_s_[channel] += 1 / rate_Hz_;
  }
}

double Band::above_30_Hz(size_t channel) const {
  return energy_[channel] > 0 ? fast_[channel] / energy_[channel] : 0;
}

int Band::sound_channel() const {
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    if (felt_s_[channel] >= kJudged_s && above_30_Hz(channel) > kMaxFast) {
      return static_cast<int>(channel);
    }
  }
  return -1;
}

void Summariser::add(const TrackSample& sample) {
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    const double value = sample[channel];
    double& peak = so_far_.channels[channel].peak;
    peak = std::max(peak, std::fabs(value));
  }
  band_.add(sample);
  const Wrench wrench = to_wrench(sample);
  so_far_.largest_force_N = std::max(so_far_.largest_force_N, wrench.force_N.norm());
  so_far_.largest_torque_Nm = std::max(so_far_.largest_torque_Nm, wrench.torque_Nm.norm());
  if (so_far_.samples > 0) {
    const double change_N_s = (wrench.force_N - before_.force_N).norm() * kTrackRate_Hz;
    so_far_.steepest_N_s = std::max(so_far_.steepest_N_s, change_N_s);
  }
  felt_ += size_N(wrench) >= kFeltForce_N ? 1 : 0;
  before_ = wrench;
  ++so_far_.samples;
}

Summary Summariser::summary() const {
  Summary summary = so_far_;
  if (summary.samples == 0) return summary;
  const auto samples = static_cast<double>(summary.samples);
  summary.felt = static_cast<double>(felt_) / samples;
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    summary.channels[channel].rms = std::sqrt(band_.energy(channel) / samples);
    summary.channels[channel].above_30_Hz = band_.above_30_Hz(channel);
  }
  return summary;
}

}  // namespace spidar::tracks
