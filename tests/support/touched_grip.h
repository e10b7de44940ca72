// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "core/touch/contact_force.h"

namespace spidar::test {

/// Spring and damper of the hand on the grip.
struct Hand {
  const char* name;
  double stiffness_N_m;
  double damping_N_s_m;
};

constexpr Hand kFirmHand{"firm", 300, 8};
constexpr Hand kLightHand{"light", 100, 2};

/// A grip that a hand moves and a commanded force pushes: a mass with the figures of the simulated
/// SPIDAR-GCC (spidar/devices/sim/grip_model.h, its profile, SafetyLimits), but without strings.
/// The force commanded in a tick follows from the position in the exchange before, is held for the
/// tick, and lags behind in the drive.
class TouchedGrip {
 public:
  static constexpr double kTick_s = 1e-3;
  static constexpr double kMass_kg = 0.1;
  static constexpr double kDriveLag_s = 0.002;
  static constexpr double kEncoderStep_m = 1.5e-5;
  static constexpr double kForceStep_N = 0.005;
  static constexpr double kMaxSlew_N_s = 300;
  static constexpr int kSubsteps = 20;

  explicit TouchedGrip(const Hand& hand, const Eigen::Vector3d& at_m = Eigen::Vector3d::Zero())
      : hand_(hand), position_m_(at_m) {}

  /// The position in the last exchange, in steps of the encoder, as the host knows it.
  Eigen::Vector3d measured_m() const { return measured_m_; }
  const Eigen::Vector3d& position_m() const { return position_m_; }
  const Eigen::Vector3d& velocity_m_s() const { return velocity_m_s_; }
  /// The true force on the grip.
  const Eigen::Vector3d& force_N() const { return force_N_; }
  /// The work of the grip against that force.
  double given_J() const { return given_J_; }

  /// Performs the exchange of a tick, and the time to the next one. The hand pulls towards
  /// `hand_m`.
  void exchange(const Eigen::Vector3d& wanted_N, const Eigen::Vector3d& hand_m) {
    measured_m_ = kEncoderStep_m * (position_m_ / kEncoderStep_m).array().round().matrix();
    Eigen::Vector3d change_N = wanted_N - limited_N_;
    const double most_N = kMaxSlew_N_s * kTick_s;
    if (change_N.norm() > most_N) change_N *= most_N / change_N.norm();
    limited_N_ += change_N;
    const Eigen::Vector3d command_N =
        kForceStep_N * (limited_N_ / kForceStep_N).array().round().matrix();
    constexpr double kStep_s = kTick_s / kSubsteps;
    const double lag = 1 - std::exp(-kStep_s / kDriveLag_s);
    for (int n = 0; n < kSubsteps; ++n) {
      force_N_ += lag * (command_N - force_N_);
      const Eigen::Vector3d hand_N = hand_.stiffness_N_m * (hand_m - position_m_);
      // The damper is implicit.
      velocity_m_s_ = (velocity_m_s_ + kStep_s / kMass_kg * (force_N_ + hand_N)) /
                      (1 + kStep_s / kMass_kg * hand_.damping_N_s_m);
      const Eigen::Vector3d way_m = kStep_s * velocity_m_s_;
      given_J_ -= force_N_.dot(way_m);
      position_m_ += way_m;
    }
  }

 private:
  Hand hand_;
  Eigen::Vector3d position_m_;
  Eigen::Vector3d measured_m_ = position_m_;
  Eigen::Vector3d velocity_m_s_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d limited_N_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_N_ = Eigen::Vector3d::Zero();
  double given_J_ = 0;
};

/// The target of a hand that explores at random: six sines on each axis, from 0.15 to 3 Hz, slow
/// ones with large amplitude.
class RandomHand {
 public:
  explicit RandomHand(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int axis = 0; axis < 3; ++axis) {
      for (Sine& s : sines_[axis]) {
        s.rad_s = 2 * M_PI * 0.15 * std::pow(20.0, uniform(random));
        s.phase_rad = 2 * M_PI * uniform(random);
        s.amplitude_m = (axis == 2 ? 0.007 : 0.012) * uniform(random) / std::sqrt(s.rad_s);
      }
    }
  }

  Eigen::Vector3d at_m(double time_s) const {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      for (const Sine& s : sines_[axis]) {
        p[axis] += s.amplitude_m * std::sin(s.rad_s * time_s + s.phase_rad);
      }
    }
    return p;
  }

 private:
  struct Sine {
    double rad_s, phase_rad, amplitude_m;
  };
  Sine sines_[3][6];
};

/// The energy that a still surface gave out, by contacts.
struct ContactEnergy {
  int contacts = 0;
  int generating = 0;             ///< contacts that gave out more than they absorbed
  double worst_J = 0;             ///< given out by one of them, ≥ 0
  double stiffness_fraction = 1;  ///< the rest at the end, see touch::ShakeWatch

  void add(double out_J) {
    ++contacts;
    if (out_J > 0) ++generating;
    worst_J = std::max(worst_J, out_J);
  }
};

}  // namespace spidar::test
