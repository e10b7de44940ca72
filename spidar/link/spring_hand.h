// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

#include "spidar/link/emulated_transport.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::emulated {

/// Passes a force to motors whose digits are the force in millinewtons and whose counts are the
/// position in micrometres: right, up, towards the viewer.
inline void set_force_N(Motors& motors, const Eigen::Vector3d& force_N) noexcept {
  std::array<int, kMaxStrings> milli_N{};
  for (size_t i = 0; i < 3; ++i) {
    milli_N[i] = static_cast<int>(std::lround(1e3 * force_N[static_cast<Eigen::Index>(i)]));
  }
  motors.set_outputs(milli_N);
}
inline Eigen::Vector3d position_m(Motors& motors) noexcept {
  const std::array<int32_t, kMaxStrings> at_um = motors.counts();
  return 1e-6 * Eigen::Vector3d(at_um[0], at_um[1], at_um[2]);
}

/// The hand that holds an emulated device whose input is a force. A spring and a damper hold the
/// grip at the centre, and the hand moves with the force, in the units of set_force_N() and
/// position_m().
class SpringHand final : public Motors {
 public:
  explicit SpringHand(uint16_t inputs = 0) noexcept : inputs_(inputs) {}

  void set_outputs(const std::array<int, kMaxStrings>& milli_N) noexcept override {
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

template <uint16_t inputs>
std::shared_ptr<Motors> spring_hand() {
  return std::make_shared<SpringHand>(inputs);
}

}  // namespace spidar::emulated
