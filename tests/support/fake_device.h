// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar::test {

/// The counts of a grip at `pose` that was at the centre when the device was opened.
inline std::array<int32_t, kMaxStrings> counts_at(const Profile& profile, const Pose& pose) {
  const StringVector change_m =
      string_lengths_m(profile.geometry, pose) - string_lengths_m(profile.geometry, {});
  std::array<int32_t, kMaxStrings> counts{};
  for (int i = 0; i < profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile.drives[k];
    counts[k] = drive.encoder_sign *
                static_cast<int32_t>(std::lround(change_m[i] / drive.metres_per_count));
  }
  return counts;
}

/// Record of what happened to a FakeDevice; must outlive it. Atomics may be used while a loop's
/// thread runs, other members before and after.
struct FakeDeviceLog {
  /// Whether the device is present, so that open() works.
  std::atomic<bool> present{true};
  /// The answer of every exchange; kGone also closes.
  std::atomic<LinkFault> answer{LinkFault::kNone};
  std::array<int32_t, kMaxStrings> count{};  ///< counts of the encoders

  std::atomic<bool> is_open{false};
  std::atomic<int> opened{0};
  std::atomic<int> closed{0};
  /// All exchanges up to kMemory, preallocated.
  std::vector<MotorVolts> volts;
  MotorVolts last_volts;

  static constexpr size_t kMemory = 20'000;
};

class FakeDevice final : public StringDevice {
 public:
  explicit FakeDevice(std::shared_ptr<FakeDeviceLog> log = std::make_shared<FakeDeviceLog>())
      : StringDevice("fake"), log_(std::move(log)) {
    log_->volts.reserve(FakeDeviceLog::kMemory);
  }

  void open() override {
    if (!log_->present) throw DeviceError("fake: not there");
    log_->is_open = true;
    ++log_->opened;
  }

  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    if (!log_->is_open) return LinkFault::kGone;
    const LinkFault answer = log_->answer;
    if (answer == LinkFault::kGone) log_->is_open = false;
    log_->last_volts = volts;
    if (log_->volts.size() < FakeDeviceLog::kMemory) log_->volts.push_back(volts);
    if (answer == LinkFault::kNone) reading.count = log_->count;
    return answer;
  }

  void close() noexcept override {
    log_->is_open = false;
    ++log_->closed;
  }

  FakeDeviceLog& log() noexcept { return *log_; }

 private:
  std::shared_ptr<FakeDeviceLog> log_;
};

}  // namespace spidar::test
