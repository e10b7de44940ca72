// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Emulated devices that take a force: Falcon, joystick and Inverse3, and the hand in which they
/// are.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include <Eigen/Core>

#include "spidar/emulation/emulated_transport.h"
#include "spidar/protocols/force_feedback.h"
#include "spidar/protocols/inverse3.h"
#include "spidar/protocols/novint_falcon.h"
#include "spidar/protocols/sound.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::emulated {

/// For motors whose digits are the force in millinewtons and whose counts are the position in
/// micrometres: to the right, up, towards the viewer.
inline void put_out_N(Motors& motors, const Eigen::Vector3d& force_N) noexcept {
  std::array<int, kMaxStrings> milli_N{};
  for (size_t i = 0; i < 3; ++i) {
    milli_N[i] = static_cast<int>(std::lround(1e3 * force_N[static_cast<Eigen::Index>(i)]));
  }
  motors.put_out(milli_N);
}
inline Eigen::Vector3d position_m(Motors& motors) noexcept {
  const std::array<int32_t, kMaxStrings> at_um = motors.counts();
  return 1e-6 * Eigen::Vector3d(at_um[0], at_um[1], at_um[2]);
}

/// A hand that holds the grip at the centre, as a spring and a damper, and moves with the force, in
/// the units of put_out_N() and position_m().
class SpringHand final : public Motors {
 public:
  explicit SpringHand(uint16_t inputs = 0) noexcept : inputs_(inputs) {}

  void put_out(const std::array<int, kMaxStrings>& milli_N) noexcept override {
    force_N_ = 1e-3 * Eigen::Vector3d(milli_N[0], milli_N[1], milli_N[2]);
  }
  std::array<int32_t, kMaxStrings> counts() noexcept override {
    advance(std::min<int64_t>(monotonic_now_ns() - now_ns_, kLongest_ns));
    now_ns_ = monotonic_now_ns();
    std::array<int32_t, kMaxStrings> at_um{};
    for (size_t i = 0; i < 3; ++i) {
      at_um[i] = static_cast<int32_t>(std::lround(1e6 * at_m_[static_cast<Eigen::Index>(i)]));
    }
    return at_um;
  }
  uint16_t inputs() noexcept override { return inputs_; }

 private:
  static constexpr double kMass_kg = 0.15, kSpring_N_m = 300, kDamper_Ns_m = 8;
  static constexpr int64_t kStep_ns = 100'000, kLongest_ns = 50'000'000;

  void advance(int64_t time_ns) noexcept {
    for (; time_ns > 0; time_ns -= kStep_ns) {
      const double dt_s = 1e-9 * static_cast<double>(std::min(time_ns, kStep_ns));
      v_m_s_ += dt_s / kMass_kg * (force_N_ - kSpring_N_m * at_m_ - kDamper_Ns_m * v_m_s_);
      at_m_ += dt_s * v_m_s_;
    }
  }

  const uint16_t inputs_;
  int64_t now_ns_ = monotonic_now_ns();
  Eigen::Vector3d force_N_ = Eigen::Vector3d::Zero(), v_m_s_ = Eigen::Vector3d::Zero(),
                  at_m_ = Eigen::Vector3d::Zero();
};

/// Its digits are the force on the hand in millinewtons, right, up and towards the viewer; its
/// counts are the position of the grip in micrometres, and its inputs buttons (bits 0–3) and the
/// encoders whose marks have been passed (bits 4–6). Nothing has friction or weight. Any firmware
/// will do. Each answer comes in three packets: only status bytes, as when the chip's timer is
/// faster than the firmware, and two parts.
class Falcon final : public Board {
 public:
  static constexpr uint16_t kHomed = 0x70;  ///< inputs: every encoder has passed its mark

  using Board::Board;

  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;
  bool control(const VendorRequest& request) noexcept override;
  void remember(Memory& memory) noexcept override { memory_ = &memory; }

 private:
  void hello(uint8_t byte) noexcept;
  void load(uint8_t byte) noexcept;
  void run(uint8_t byte) noexcept;
  void handle(const falcon::Command& command) noexcept;
  void answer(ByteView bytes) noexcept;
  bool feed(uint8_t byte, size_t length) noexcept;

  Memory own_memory_{{true}, {0}};
  Memory* memory_ = &own_memory_;
  Eigen::Vector3d angles_rad_ = Eigen::Vector3d::Constant(falcon::kAngleAtZero_rad);
  bool loader_ = false;  ///< started by toggling DTR, until the line is fast
  bool takes_firmware_ = false;
  falcon::Packet packet_{};  ///< the one that is being received
  size_t taken_ = 0;
  std::array<uint8_t, 256> answer_{};  ///< bytes that have not been read yet
  size_t due_ = 0;
  bool timer_first_ = false;  ///< the next packet has only status bytes
};

/// Its digits are the sum of the playing effects: level to the right, level upwards, and strength
/// of the rumble. Its counts are the position of the stick, of ff::Position::kFull: to the right
/// and upwards.
class ForceFeedback final : public Board {
 public:
  /// A stick with two axes, gain, autocentre and room for sixteen effects.
  static ff::Description stick() noexcept;

  explicit ForceFeedback(std::shared_ptr<Motors> motors,
                         const ff::Description& description = stick()) noexcept
      : Board(std::move(motors)), description_(description) {}

  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;

 private:
  struct Slot {
    ff::Effect effect;
    bool used = false;
    bool plays = false;
  };

  void upload(const ff::Effect& effect) noexcept;
  void put_out() noexcept;
  template <typename Structure>
  void answer(const Structure& structure) noexcept;

  const ff::Description description_;
  std::array<Slot, 16> slots_{};
  std::array<uint8_t, sizeof(ff::Description)> reply_{};
  size_t due_ = 0;
};

/// Its digits are the force in millinewtons, its counts the position in micrometres: to the right,
/// up, towards the viewer. The inputs are the buttons.
class Inverse3 final : public Board {
 public:
  explicit Inverse3(std::shared_ptr<Motors> motors,
                    inverse3::Version version = inverse3::Version::k35)
      : Board(std::move(motors)) {
    state.id = "049D";
    state.version = version;
  }

  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;

  inverse3::State state;  ///< what it reports, except for position and buttons

 private:
  bool due_ = false;
};

/// Its digits are the levels of the channels in thousandths.
class Sound final : public Board {
 public:
  using Board::Board;

  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;

  sound::State state{30'000'000};  ///< what it reports

 private:
  bool due_ = false;
};

}  // namespace spidar::emulated
