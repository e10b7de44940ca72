// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <Eigen/Core>

#include "spidar/device.h"
#include "spidar/devices/force_feedback/packets.h"
#include "spidar/devices/force_feedback/slow_updates.h"
#include "spidar/guardian/guardian.h"
#include "spidar/transports/transport.h"

namespace spidar::boards {

/// The effects of a force-feedback device, set by a thread that may wait for the driver. Drivers
/// may need a long time for an update, or lose updates that follow too closely. Each axis has one
/// effect. The thread sets at most one effect every kUpdate_ms, and only if it has changed. An
/// effect lasts kEffect_ms and is restarted every kRefresh_ms as long as forces arrive, so that it
/// ends by itself when this process hangs or is stopped.
///
/// No one can end a call of a driver that hangs: until the call returns, the kernel lets no other
/// call to the device pass, not even the guardian's. report() then returns a timeout, see
/// UpdateWatch. close() detaches the thread, which shares the ownership of this object and releases
/// the device when the driver returns.
///
/// A device that is only opened and read keeps its gain and its autocentre.
class StickEffects : public std::enable_shared_from_this<StickEffects> {
 public:
  static constexpr int kUpdate_ms = 5;
  static constexpr int kRefresh_ms = 50;
  /// How long close() waits for a hanging driver, beyond the time of the centring spring.
  static constexpr int kHang_ms = 300;

  struct Options {
    /// The fraction of the device's strength that is used, at most 1. 0 means kDefaultGain, or 1
    /// for a device that only rumbles.
    double gain = 0;
    std::array<bool, 2> flipped{};  ///< whether the driver reverses the force, to the right and up
  };

  enum class Updates {
    kOwnThread,  ///< cycle() never waits for the driver
    kInCycle,    ///< every kUpdate_ms-th cycle(), for emulations
  };

  /// Linux does not report how strong a device is. A wheel may exert 20 N m, so a device with a
  /// directional force uses a fifth of its strength unless the user asks for more.
  static constexpr double kDefaultGain = 0.2;

  StickEffects(std::string name, std::unique_ptr<Transport> transport, Updates updates,
               const Options& options);

  /// Throws DeviceError.
  void open();
  /// When `reopening`, the centring spring stays off for the hand that still holds the stick. The
  /// next closing restores the spring, even if the device is not opened any more.
  void close(bool reopening) noexcept;
  /// Sets the force in newtons, right and up, and whether forces are switched on. Returns the
  /// result of the exchange. Does not wait.
  LinkFault cycle(const Eigen::Vector2d& force_N, bool pulls) noexcept;
  /// Returns the position of the stick, −1 … 1, as of the last cycle().
  const Eigen::Vector2d& position() const noexcept { return position_.fraction(); }
  uint32_t buttons() const noexcept { return position_.buttons(); }

  std::vector<LastWill> last_wills() const;
  const ff::Description& description() const noexcept { return description_; }
  size_t effects() const noexcept { return effect_count_; }
  double gain() const noexcept {
    return options_.gain > 0 ? options_.gain : description_.constant ? kDefaultGain : 1;
  }

 private:
  struct Effect {
    int16_t number = ff::kNewEffect;
    int level = 0;       ///< the level in the device; the strength of a rumble effect
    bool known = false;  ///< whether `level` is known to be in the device
    int64_t played_ns = 0;
  };

  void begin_effects();
  void start_updates();
  Transfer upload(size_t effect, int level) noexcept;
  Transfer play(size_t effect) noexcept;
  Transfer send(ByteView event) noexcept;
  /// Sets gain to the fraction that is used and autocentre to off, once forces are switched on:
  /// earlier programs or the driver may have left settings that scale the force or add to it. No
  /// level is set until the device has accepted both.
  LinkFault apply_settings() noexcept;
  /// Returns the events that restore the settings: gain to full and, if the driver had turned it
  /// on, autocentre by a ramp. They must be sent kUpdate_ms apart.
  std::vector<ff::EventBytes> former_settings() const;
  void restore_settings() noexcept;
  /// Restores the settings of a device that was closed for reopening, but not reopened.
  void return_settings_later() noexcept;
  bool thread_runs() const;
  int wanted_level(size_t effect) const noexcept;
  /// Reads the position, sets one level, restarts effects, and stores the result.
  void update() noexcept;
  LinkFault read_and_set() noexcept;
  LinkFault set_one_level() noexcept;
  LinkFault refresh() noexcept;
  void end_effects() noexcept;
  /// Returns the time; in emulations that of the cycles, which need not take a millisecond each.
  int64_t now_ns() const noexcept;
  void run() noexcept;

  const std::string name_;
  const std::unique_ptr<Transport> transport_;
  const Updates updates_;
  const Options options_;

  ff::Description description_;
  std::array<Effect, 2> effects_{};  ///< right and up; a rumble effect uses the first
  size_t effect_count_ = 0;
  size_t turn_ = 0;  ///< index of the effect that the next update checks first
  int64_t cycle_ = 0;
  std::thread thread_;
  std::future<void> ended_;  ///< ready when the thread has ended; invalid before the first thread
  std::atomic<bool> stop_{false};
  std::atomic<bool> reopening_{false};
  std::atomic<bool> pulled_{false};    ///< whether forces were on since open()
  std::atomic<int64_t> cycled_ns_{0};  ///< time of the latest cycle()
  bool has_settings_ = false;          ///< apply_settings() has succeeded
  bool settings_changed_ = false;  ///< not restored yet; since then, other openings may have been
  std::vector<ff::EventBytes> former_settings_;  ///< settings to restore on the open device
  UpdateWatch updated_;
  std::array<std::atomic<double>, 2> force_N_{};
  StickPosition position_;
};

}  // namespace spidar::boards
