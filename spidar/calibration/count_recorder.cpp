// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/count_recorder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "spidar/grip/tension_limits.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/tick_time.h"
#include "spidar/profiles/toml_field.h"

namespace spidar {
namespace {

constexpr double kMaxSeconds = 3600;

void check(const RecordingSettings& settings) {
  if (!(settings.seconds > 0 && settings.seconds <= kMaxSeconds))
    throw std::invalid_argument("recording: " + shown(settings.seconds) +
                                " s, must be above 0 and at most " + shown(kMaxSeconds) + " s");
  if (!(settings.sample_period_s >= kTick_s && settings.sample_period_s <= settings.seconds))
    throw std::invalid_argument("recording: a sample every " + shown(settings.sample_period_s) +
                                " s, must be at least " + shown(kTick_s) +
                                " s and at most the whole time");
}

/// Keeps the strings of a device at rest tension, multiplied by a share.
class Strings {
 public:
  Strings(Device& device, const Profile& profile)
      : device_(device), profile_(profile), rest_N_(profile.min_tension_N()) {
    device_.open();
  }
  ~Strings() { device_.close(); }
  Strings(const Strings&) = delete;
  Strings& operator=(const Strings&) = delete;

  /// One exchange. Returns false when it failed. Throws DeviceError when the device is lost.
  bool pull(double change_of_share, DeviceReading& reading) {
    share_ = std::clamp(share_ + change_of_share, 0.0, 1.0);
    const MotorVolts volts = to_volts(share_ * rest_N_, profile_);
    const ExchangeStatus status = device_.exchange(volts, reading);
    errors_in_a_row_ = status == ExchangeStatus::kOk ? 0 : errors_in_a_row_ + 1;
    if (status == ExchangeStatus::kLost || errors_in_a_row_ >= HapticLoop::kMaxErrors)
      throw DeviceError(device_.name() + ": lost while recording; check cable and power");
    return status == ExchangeStatus::kOk;
  }

  bool released() const { return share_ <= 0; }

 private:
  Device& device_;
  const Profile& profile_;
  const StringVector rest_N_;
  double share_ = 0;
  int errors_in_a_row_ = 0;
};

CountSamples to_samples(const std::vector<DeviceReading>& readings, int strings) {
  CountSamples samples(static_cast<Eigen::Index>(readings.size()), strings);
  for (Eigen::Index k = 0; k < samples.rows(); ++k)
    for (Eigen::Index i = 0; i < samples.cols(); ++i)
      samples(k, i) = readings[static_cast<size_t>(k)].count[static_cast<size_t>(i)];
  return samples;
}

}  // namespace

CountSamples record_counts(Device& device, const Profile& profile,
                           const RecordingSettings& settings, const NextTick& next_tick) {
  check(settings);
  Strings strings(device, profile);
  std::vector<DeviceReading> kept;
  DeviceReading reading;
  const auto rise = static_cast<int64_t>(std::lround(HapticLoop::kEnergise_s / kTick_s));
  const auto period = static_cast<int64_t>(std::lround(settings.sample_period_s / kTick_s));
  const auto end = rise + static_cast<int64_t>(std::lround(settings.seconds / kTick_s));
  const auto time_s = [&](int64_t tick) { return static_cast<double>(tick - rise) * kTick_s; };
  int64_t tick = 0;
  for (; tick < end && next_tick(time_s(tick)); ++tick)
    if (strings.pull(kTick_s / HapticLoop::kEnergise_s, reading) && tick >= rise &&
        (tick - rise) % period == 0)
      kept.push_back(reading);
  for (; !strings.released(); ++tick) {
    next_tick(time_s(tick));
    strings.pull(-kTick_s / HapticLoop::kRelease_s, reading);
  }
  return to_samples(kept, profile.geometry.count);
}

}  // namespace spidar
