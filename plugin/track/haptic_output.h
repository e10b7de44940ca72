/// A device that follows the playback of an element.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include <gst/gst.h>

#include "plugin/timing/playback_follower.h"
#include "spidar/haptic_session.h"

namespace spidar {

/// Haptic session and playback clock of one element. Thread-safe.
class HapticOutput {
 public:
  /// `refreshed` is called each time after the haptic loop was told where playback is: a hundred
  /// times a second while playing.
  HapticOutput(GstElement* element, std::function<void()> refreshed)
      : element_(element), refreshed_(std::move(refreshed)) {}

  /// Tests only, before open(): `now` stands for CLOCK_MONOTONIC and the loop waits to be ticked.
  void set_manual(PlaybackSync::Now now, void* user);

  /// Opens the device; `profile` is a name or a path for load_profile(). Throws ProfileError,
  /// DeviceError, std::runtime_error. Empty, or why the haptic trace cannot be written: the device
  /// works without it.
  std::string open(const std::string& device, const std::string& profile,
                   const std::string& haptic_trace);
  /// Motors to rest, device closed.
  void close();

  void set_playing(bool playing);
  void set_latency(GstClockTime latency);
  void set_offset(GstClockTimeDiff offset_ns);
  void set_max_force(double max_force_N);
  /// See PlaybackSync::expect_base_time().
  void expect_base_time();
  /// Looks at the pipeline's clock now; a thread does that by itself.
  void refresh_clock();

  /// Null while closed. Opened and closed by state changes only.
  HapticSession* session() const { return session_.get(); }
  /// Adds what describe_session() says, while a device is open.
  void describe(GstStructure* structure) const;

 private:
  GstElement* const element_;
  const std::function<void()> refreshed_;
  PlaybackSync::Now now_ = nullptr;
  void* now_user_ = nullptr;
  mutable std::mutex mutex_;  // state changes against any thread
  std::unique_ptr<HapticSession> session_;
  std::unique_ptr<PlaybackFollower> follower_;
  GstClockTime latency_ = 0;
  GstClockTimeDiff offset_ns_ = 0;
  SafetyLimits limits_;
};

}  // namespace spidar
