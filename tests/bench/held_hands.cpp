// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// How much of the force of random films hands lose to the brake: the difference between the
// commanded force and the force of the rates alone, in parts of the latter, in all profiles.
#include "tests/bench/held_hands.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "spidar/limits/released_grip.h"
#include "spidar/limits/wrench_limits.h"
#include "tests/support/random_motion.h"
#include "tests/support/released_grip.h"

namespace spidar::bench {
namespace {

using test::PlayedGrip;
using test::RandomMotion;

constexpr int kFilm_ms = 16'000;  // of 24 profiles and nine kinds of hands: an hour
constexpr double kSwing_m = 0.03;

struct Hands {
  double limit_N, from_N_m, to_N_m;
  double fastest_m_s;  // of the hand's own swing by ±kSwing_m
  double away_m;       // off the centre
};

constexpr double kMost_N = 10.2;
constexpr Hands kHands[] = {
    {3, 300, 600, 0, 0},       {3, 300, 600, 0, 0.03},       {3, 300, 600, 0.3, 0},
    {3, 300, 600, 0.45, 0},    {3, 150, 300, 0, 0},          {3, 150, 300, 0.3, 0},
    {kMost_N, 300, 600, 0, 0}, {kMost_N, 300, 600, 0, 0.03}, {kMost_N, 300, 600, 0.3, 0},
};

/// A part of a film: a constant wrench, one that changes into another, a sine, or a square wave.
struct Piece {
  double end_s, length_s, rate_Hz;
  int form;
  Wrench from, to;

  Wrench at(double time_s) const {
    const double passed_s = time_s - (end_s - length_s), way = passed_s / length_s;
    if (form == 0) return from;
    if (form == 1) return (1 - way) * from + way * to;
    if (form == 2) return std::sin(2 * M_PI * rate_Hz * passed_s) * from;
    return (std::fmod(rate_Hz * passed_s, 1) < 0.5 ? 1.0 : -1.0) * from;
  }
};

test::Film random_film(RandomMotion& random, double most_N) {
  constexpr double kMost_Nm = 0.05;
  const auto wrench = [&](double force_N) {
    return Wrench{force_N * random.direction(), random.uniform(0, kMost_Nm) * random.direction()};
  };
  std::vector<Piece> pieces;
  for (double end_s = 0; end_s < 1e-3 * kFilm_ms + 1;) {
    const double length_s = random.uniform(0.02, 0.6);
    end_s += length_s;
    const double force_N = random.chance(0.4) ? most_N : random.uniform(0, most_N);
    pieces.push_back({end_s, length_s, random.uniform(0.5, 8), static_cast<int>(random.some(4)),
                      wrench(force_N), wrench(random.uniform(0, most_N))});
  }
  return [pieces](double time_s) {
    return std::upper_bound(pieces.begin(), pieces.end(), time_s,
                            [](double at_s, const Piece& piece) { return at_s < piece.end_s; })
        ->at(time_s);
  };
}

void print_lost(const Hands& hands) {
  RandomMotion random(7);
  double given_N = 0, lost_N = 0;
  int rests = 0, ticks = 0;
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    GripModel model = grip_model_of(profile);
    const double stiffness_N_m = random.uniform(hands.from_N_m, hands.to_N_m);
    model.hand_stiffness_Nm_rad *= stiffness_N_m / model.hand_stiffness_N_m;
    model.hand_stiffness_N_m = stiffness_N_m;
    const double mass_kg = random.uniform(0.05, 0.15);
    model.inertia_kg_m2 *= mass_kg / model.mass_kg;
    model.mass_kg = mass_kg;
    SafetyLimits limits;
    limits.max_force_N = std::min(hands.limit_N, released_force_N(profile.drive_lag_s));
    PlayedGrip grip(profile, model, random_film(random, limits.max_force_N), limits);
    WrenchLimits rates;
    const Eigen::Vector3d swing_m = kSwing_m * random.direction();
    const Eigen::Vector3d away_m = hands.away_m * random.direction();
    for (int i = 0; i < kFilm_ms; ++i, ++ticks) {
      const double time_s = 1e-3 * i;
      Pose hand;
      hand.position_m = std::min(1.0, 2 * time_s) * away_m;
      if (hands.fastest_m_s > 0)
        hand.position_m += std::sin(hands.fastest_m_s / kSwing_m * time_s) * swing_m;
      grip.device.set_hand(hand);
      grip.tick();
      const TickRecord last = grip.snapshot().last;
      const Wrench alone = rates.apply(last.wanted, last.found != Found::kNothing, 1e-3, limits);
      given_N += alone.force_N.norm();
      lost_N += (last.commanded.force_N - alone.force_N).norm();
      rests += !last.held;
    }
  }
  std::printf(
      "%4.1f N, %.0f to %.0f N/m, swings at up to %.2f m/s, %2.0f mm off the centre: loses %.2f "
      "%%, "
      "rests for %.2f %% of the time\n",
      hands.limit_N, hands.from_N_m, hands.to_N_m, hands.fastest_m_s, 1e3 * hands.away_m,
      100 * lost_N / given_N, 100.0 * rests / ticks);
  std::fflush(stdout);
}

}  // namespace

void held_hands() {
  for (const Hands& hands : kHands) print_lost(hands);
}

}  // namespace spidar::bench
