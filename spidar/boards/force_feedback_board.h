// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Force-feedback joysticks, wheels and gamepads of Linux, with up to two force axes and a
/// position.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/api.h"
#include "spidar/boards/board.h"
#include "spidar/boards/stick_place.h"
#include "spidar/boards/update_watch.h"
#include "spidar/profiles/encoder_scale.h"
#include "spidar/protocols/force_feedback.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// Replaces the strings of any profile. The force is the pull of the strings on a grip at the
/// position of the stick; only its x and y are felt. A stick that is pushed all the way corresponds
/// to a grip half way from the middle to the points where the strings leave the frame, which is the
/// edge of the picture for pointer=grip. The pull of strings at their minimum tension, away from
/// the middle, is subtracted, so that the stick is at rest anywhere.
///
/// Drivers may need a long time for an update, or lose updates that come too fast. One effect for
/// each axis therefore plays all the time. Its level is set at most every kUpdate_ms, for one
/// effect at a time, and only if it has changed. A call of a driver that hangs cannot be ended:
/// the kernel lets no other call to the device pass until it returns, not even the guardian's.
/// cycle() then reports a time-out, see UpdateWatch.
///
/// A device that is only opened and read keeps its gain and its autocentre.
class SPIDAR_API ForceFeedbackBoard final : public Board {
 public:
  static constexpr int kUpdate_ms = 5;

  enum class Updates {
    kOwnThread,  ///< cycle() never waits for the driver
    kInCycle,    ///< every kUpdate_ms-th cycle(), for emulations
  };

  ForceFeedbackBoard(std::string name, const Profile& profile, std::unique_ptr<Transport> transport,
                     Updates updates);
  ~ForceFeedbackBoard() override { close(); }

  void open() override;
  LinkFault cycle(const MotorVolts& volts, DeviceReading& reading,
                  int64_t deadline_ns) noexcept override;
  /// Done by the thread that makes the updates.
  void recover() noexcept override {}
  /// Does nothing: the position has its own zero.
  void zero_counts() noexcept override {}
  /// The centring spring stays off in the next close(), for a hand that still holds the stick.
  void expect_reopening() noexcept override { reopening_ = true; }
  void close() noexcept override;
  std::vector<LastWill> last_wills() const override;
  /// Includes one sentence on what the device lacks.
  std::string description() const override;
  FeltParts felt_parts() const noexcept override;
  const std::string& name() const noexcept override { return name_; }

 private:
  struct Effect {
    int16_t number = ff::kNewEffect;
    int level = 0;       ///< that is set; for a rumble effect its strength
    bool known = false;  ///< the level is known to be set
  };

  void begin_effects();
  void start_updates();
  Transfer upload(size_t effect, int level) noexcept;
  Transfer send(ByteView event) noexcept;
  /// Once the strings pull: sets gain to full and autocentre to off, which earlier programs or the
  /// driver may have left otherwise, and which would scale the force or add to it.
  /// Until both have been accepted, no level is set.
  LinkFault take_settings() noexcept;
  /// Turns autocentre on again, by a ramp, if the driver had turned it on.
  void return_settings() noexcept;
  int wanted_level(size_t effect) const noexcept;
  /// Reads the position, sets one level, and notes how it ended.
  void update() noexcept;
  LinkFault read_and_set() noexcept;
  /// Of cycles in emulations, which need not take a millisecond.
  int64_t now_ns() const noexcept;
  void run() noexcept;
  Pose stick_pose() const noexcept;
  Eigen::Vector2d force_at(const Pose& pose, const MotorVolts& volts) const noexcept;

  const std::string name_;
  const Profile profile_;
  const StringVector rest_N_;
  const EncoderScale encoders_;
  Eigen::Vector2d reach_m_ = Eigen::Vector2d::Zero();  ///< of the stick, x and y
  const std::unique_ptr<Transport> transport_;
  const Updates updates_;

  ff::Description description_;
  std::array<Effect, 2> effects_{};  ///< right and up; a rumble effect uses the first
  size_t effect_count_ = 0;
  size_t turn_ = 0;  ///< the effect that is checked first
  int64_t cycle_ = 0;
  std::thread thread_;
  std::atomic<int> felt_axes_{2};  ///< 1: only x; 0: it only rumbles
  std::atomic<bool> stop_{false};
  std::atomic<bool> pulled_{false};  ///< since it was opened
  bool has_settings_ = false;        ///< take_settings() has succeeded
  bool centring_off_ = false;        ///< autocentre may be off
  bool reopening_ = false;
  UpdateWatch updated_;
  std::array<std::atomic<double>, 2> force_N_{};
  StickPlace place_;
};

}  // namespace spidar
