// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The speed that no film exceeds, of a free grip along one axis. What is proved is the part of the
// brake that has no memory: a force along the foreseen speed fades within a band, and above its
// lower speed a damper acts. What the brake remembers of a grip lowers the band, and leaves the
// damper out only where the strings have not done the work of that speed, so that a hand moves it.
//
// The state of a grip is its speed, the force that acts on it behind drives of first order, and the
// command on its way; the film is any force within its limit, in each tick. Every map is monotone,
// so that boxes of states go to boxes: what no box reaches from rest, no film reaches. The boxes
// widen the bound; a film that always pushes says by how much at most.
#include "tests/bench/prove_released.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "spidar/chain/brake_table.h"
#include "spidar/limits/released_turn.h"

namespace spidar::bench {
namespace {

constexpr double kTick_s = 1e-3;
constexpr double kFastest_m_s = 2.4;  // of the grid

/// One axis of a grip: of its motion, or of its turn at the surface, where a torque is a force and
/// the moment of inertia a mass.
struct Axis {
  double most_N, mass_kg, lag_s, damping_N_s_m, wrong_m_s;

  double passed() const { return lag_s > 0 ? 1 - std::exp(-kTick_s / lag_s) : 1; }
  /// What the brake leaves of `film_N` at a foreseen speed: falls with the speed, rises with the
  /// film.
  double left_N(double ahead_m_s, double film_N) const {
    constexpr double kWidth_m_s = brake::kFadeTo_m_s - brake::kFadeFrom_m_s;
    const double speed_m_s = std::fabs(ahead_m_s);
    const bool pushes = film_N * ahead_m_s > 0;
    const double left = std::clamp((brake::kFadeTo_m_s - speed_m_s) / kWidth_m_s, 0.0, 1.0);
    const double above_m_s = std::max(0.0, speed_m_s - brake::kFadeFrom_m_s);
    return (pushes ? left * film_N : film_N) - std::copysign(damping_N_s_m * above_m_s, ahead_m_s);
  }
  double ahead_m_s(double speed_m_s, double acting_N) const {
    return speed_m_s + (brake::kLoop_s + lag_s) * acting_N / mass_kg;
  }
};

/// What a film reaches that always pushes, while the brake sees too low a speed.
double pushed_m_s(const Axis& axis) {
  double speed_m_s = 0, acting_N = 0, command_N = 0, fastest_m_s = 0;
  for (int i = 0; i < 2000; ++i) {
    const double ahead_m_s = axis.ahead_m_s(speed_m_s, acting_N) - axis.wrong_m_s;
    acting_N += axis.passed() * (command_N - acting_N);
    speed_m_s += kTick_s / axis.mass_kg * acting_N;
    command_N = axis.left_N(ahead_m_s, axis.most_N);
    fastest_m_s = std::max(fastest_m_s, speed_m_s);
  }
  return fastest_m_s;
}

struct Range {
  double low, high;
};

/// A coordinate of the grid, symmetric about zero.
struct Cells {
  double size;
  int half;

  int at(double x) const {
    return std::clamp(static_cast<int>(std::floor(x / size)) + half, 0, 2 * half - 1);
  }
  Range range(int cell) const { return {(cell - half) * size, (cell - half + 1) * size}; }
};

/// The speed that no film exceeds.
double proved_m_s(const Axis& axis) {
  const double damper_N = axis.damping_N_s_m * (kFastest_m_s - brake::kFadeFrom_m_s);
  const Cells speeds{0.02, static_cast<int>(kFastest_m_s / 0.02)};
  const double step_N = axis.most_N / 30;
  const Cells forces{step_N, static_cast<int>(std::ceil((axis.most_N + damper_N) / step_N))};
  const size_t n = 2 * static_cast<size_t>(forces.half);
  std::vector<uint8_t> seen(2 * static_cast<size_t>(speeds.half) * n * n, 0);
  std::vector<uint32_t> open;
  const auto mark = [&](const Range& speed, const Range& acting, const Range& command) {
    for (int i = speeds.at(speed.low); i <= speeds.at(speed.high); ++i) {
      for (int j = forces.at(acting.low); j <= forces.at(acting.high); ++j) {
        for (int k = forces.at(command.low); k <= forces.at(command.high); ++k) {
          const size_t cell =
              (static_cast<size_t>(i) * n + static_cast<size_t>(j)) * n + static_cast<size_t>(k);
          if (seen[cell]) continue;
          seen[cell] = 1;
          open.push_back(static_cast<uint32_t>(cell));
        }
      }
    }
  };
  mark({0, 0}, {0, 0}, {0, 0});
  double fastest_m_s = 0;
  while (!open.empty()) {
    const size_t cell = open.back();
    open.pop_back();
    const Range command = forces.range(static_cast<int>(cell % n));
    const Range acting = forces.range(static_cast<int>(cell / n % n));
    const Range speed = speeds.range(static_cast<int>(cell / n / n));
    fastest_m_s = std::max({fastest_m_s, speed.high, -speed.low});
    const auto then = [&](double acting_N, double command_N) {
      return acting_N + axis.passed() * (command_N - acting_N);
    };
    const Range next{then(acting.low, command.low), then(acting.high, command.high)};
    const double low_m_s = axis.ahead_m_s(speed.low, acting.low) - axis.wrong_m_s;
    const double high_m_s = axis.ahead_m_s(speed.high, acting.high) + axis.wrong_m_s;
    const double per_N = kTick_s / axis.mass_kg;
    mark({speed.low + per_N * next.low, speed.high + per_N * next.high}, next,
         {axis.left_N(high_m_s, -axis.most_N), axis.left_N(low_m_s, axis.most_N)});
  }
  return fastest_m_s;
}

/// `most` is in `unit`, N or N m.
void print(double most, const char* unit, const Axis& axis) {
  const double pushed = pushed_m_s(axis), proved = proved_m_s(axis);
  const bool is_bound = proved < kFastest_m_s - 0.02;
  std::printf(
      "%2.0f ms, %6.3f %s, %3.0f g, foreseen to %.1f m/s: %s%.2f m/s, %.0f mJ; reached %.2f\n",
      1e3 * axis.lag_s, most, unit, 1e3 * axis.mass_kg, axis.wrong_m_s,
      is_bound ? "at most " : "no bound below ", proved, 500 * axis.mass_kg * proved * proved,
      pushed);
}

}  // namespace

void prove_released() {
  constexpr double kWrong_m_s = brake::kSpeedError_m_s;
  constexpr double kArm_m = GripBody::kBall_m;
  constexpr GripBody kBody = GripBody::inferred(kArm_m);
  const double inertia_kg = kBody.least_kg_m2 / (kArm_m * kArm_m);
  const double turn_N_s_m = brake::turn_damping(kBody) / (kArm_m * kArm_m);
  for (const double lag_s : {0.002, 0.01, 0.02, 0.045}) {
    for (const bool usual : {true, false}) {
      const double most_N = usual ? kDefaultForce_N : released_force_N(lag_s);
      const double most_Nm = usual ? kDefaultTorque_Nm : released_torque_Nm(kBody, kArm_m, lag_s);
      for (const double mass_kg : {kLightestGrip_kg, 0.1}) {
        print(most_N, "N", {most_N, mass_kg, lag_s, brake::kDamping_N_s_m, kWrong_m_s});
      }
      print(most_Nm, "N m", {most_Nm / kArm_m, inertia_kg, lag_s, turn_N_s_m, kWrong_m_s});
    }
  }
}

}  // namespace spidar::bench
