// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Force-feedback joysticks, wheels and gamepads of Linux, with up to two force axes and a
/// position.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/boards/stick_effects.h"
#include "spidar/profiles/encoder_scale.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// Replaces the strings of any profile. The force is the pull of the strings on a grip at the
/// position of the stick; only its x and y are felt. A stick that is pushed all the way corresponds
/// to a grip half way from the middle to the points where the strings leave the frame, which is the
/// edge of the picture for pointer=grip. The pull of strings at their minimum tension, away from
/// the middle, is subtracted, so that the stick is at rest anywhere.
class ForceFeedbackBoard final : public Board {
 public:
  static constexpr int kUpdate_ms = StickEffects::kUpdate_ms;
  using Updates = StickEffects::Updates;
  ForceFeedbackBoard(std::string name, const Profile& profile, std::unique_ptr<Transport> transport,
                     Updates updates, const StickEffects::Options& options = {});
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
  void close() noexcept override { effects_->close(reopening_); }
  std::vector<LastWill> last_wills() const override { return effects_->last_wills(); }
  /// Includes one sentence on what the device lacks.
  std::string description() const override;
  FeltParts felt_parts() const noexcept override;
  const std::string& name() const noexcept override { return name_; }

 private:
  Pose stick_pose() const noexcept;
  Eigen::Vector2d force_at(const Pose& pose, const MotorVolts& volts) const noexcept;

  const std::string name_;
  const Profile profile_;
  const StringVector rest_N_;
  const EncoderScale encoders_;
  Eigen::Vector2d reach_m_ = Eigen::Vector2d::Zero();  ///< of the stick, x and y
  const std::shared_ptr<StickEffects> effects_;
  std::atomic<int> felt_axes_{2};  ///< 1: only x; 0: it only rumbles
  bool reopening_ = false;
};

}  // namespace spidar
