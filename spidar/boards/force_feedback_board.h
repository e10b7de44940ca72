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
#include "spidar/profiles/profile.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// A stick that is pushed all the way corresponds to a grip half way from the middle to the points
/// where the strings of the profile leave its frame, which is the edge of the picture for
/// pointer=grip.
class ForceFeedbackBoard final : public ForceBoard {
 public:
  static constexpr int kUpdate_ms = StickEffects::kUpdate_ms;
  using Updates = StickEffects::Updates;
  ForceFeedbackBoard(std::string name, const Profile& profile, std::unique_ptr<Transport> transport,
                     Updates updates, const StickEffects::Options& options = {});
  ~ForceFeedbackBoard() override { close(); }

  void open() override;
  LinkFault cycle(const ForceOutput& output, ForceReading& reading,
                  int64_t deadline_ns) noexcept override;
  /// Done by the thread that makes the updates.
  void recover() noexcept override {}
  /// The centring spring stays off in the next close(), for a hand that still holds the stick.
  void expect_reopening() noexcept override { reopening_ = true; }
  void close() noexcept override { effects_->close(reopening_); }
  std::vector<LastWill> last_wills() const override { return effects_->last_wills(); }
  /// Includes one sentence on what the device lacks.
  std::string description() const override;
  GripAbilities abilities() const noexcept override;
  const std::string& name() const noexcept override { return name_; }

 private:
  const std::string name_;
  const Eigen::Vector2d reach_m_;  ///< of the stick, x and y
  const std::shared_ptr<StickEffects> effects_;
  std::atomic<int> force_axes_{2};     ///< 1: only x; 0: it only rumbles
  std::atomic<int> position_axes_{2};  ///< 1: only x
  std::atomic<int> buttons_{0};
  bool reopening_ = false;
};

}  // namespace spidar
