// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Searches for the film, the hand and the moment at which a grip that is let go, or loosely held,
// gets the most energy or speed: the figures of docs/safety.md. For each profile and case, the
// cross-entropy method (Rubinstein 1999) draws generations of grips, and moves the distribution of
// their parameters towards the worst tenth. Simulated time, so that the results are the same on
// every machine.
//   spidar-bench released [GRIPS] [SEED] [CASE]     100,000 grips, or those of one case
//   spidar-bench released --prove                   what no film exceeds, see prove_released.cpp
//   spidar-bench released --hands                   what the brake takes from hands, see
//   held_hands.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "spidar/devices/sim/simulated_device.h"
#include "spidar/limits/released_turn.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/string_grip.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/held_hands.h"
#include "tests/bench/prove_released.h"
#include "tests/support/late_ticks.h"
#include "tests/support/let_go_device.h"
#include "tests/support/random_motion.h"
#include "tests/support/released_grip.h"

namespace {

using namespace spidar;
using namespace spidar::test;

/// What is searched for in a case.
struct Case {
  const char* name;
  double limit_N;  // 0: the most that the profile's drives allow
  bool lets_go;    // otherwise a loose hand holds the grip all the time
  bool cuts;       // two strings break at once, in a firm hand
  bool stalls;     // the haptic thread gets no processor for up to 60 ms
  double from_kg, to_kg;
  enum Goal { kEnergy, kSpeed, kForce } goal;
};

constexpr double kLight_kg = kLightestGrip_kg, kHeavy_kg = kHeaviestGrip_kg;
constexpr Case kCases[] = {
    {"let go, 3 N", 3, true, false, false, kLight_kg, kHeavy_kg, Case::kEnergy},
    {"let go, 3 N, 34 g", 3, true, false, false, kLight_kg, kLight_kg, Case::kSpeed},
    {"let go, most force", 0, true, false, false, kLight_kg, kHeavy_kg, Case::kEnergy},
    {"let go, most force, 34 g", 0, true, false, false, kLight_kg, kLight_kg, Case::kSpeed},
    {"let go, most force, 20 g", 0, true, false, false, 0.02, 0.02, Case::kSpeed},
    {"loose hand, 3 N", 3, false, false, false, kLight_kg, kHeavy_kg, Case::kEnergy},
    {"loose hand, most force", 0, false, false, false, kLight_kg, kHeavy_kg, Case::kEnergy},
    {"two strings cut, most force", 0, false, true, false, 0.1, 0.1, Case::kForce},
    {"let go, 3 N, stalls", 3, true, false, true, kLight_kg, kHeavy_kg, Case::kEnergy},
};

/// Parameters, each 0 … 1.
enum Parameter {
  kMass,
  kInertia,
  kStiffness,
  kDamping,
  kForm,
  kRate,
  kPhase,
  kDuty,
  kForce,
  kForceZ,
  kForceAngle,
  kTorque,
  kTorqueZ,
  kTorqueAngle,
  kMoment,
  kLate,
  kAway,
  kAwayZ,
  kAwayAngle,
  kStops,
  kStopped,
  kParameters
};
using Point = std::array<double, kParameters>;

double between(double low, double high, double fraction) {
  return low + fraction * (high - low);
}

/// The same on a logarithmic scale.
double scaled(double low, double high, double fraction) {
  return low * std::pow(high / low, fraction);
}

Eigen::Vector3d towards(double z, double angle) {
  const double up = 2 * z - 1, across = std::sqrt(std::max(0.0, 1 - up * up));
  return {across * std::cos(2 * M_PI * angle), across * std::sin(2 * M_PI * angle), up};
}

/// A sine, a square, a step, a sawtooth or pulses, to 25 Hz.
double wave(const Point& p, double time_s) {
  const double turns = scaled(0.2, 25, p[kRate]) * time_s + p[kPhase];
  const double part = turns - std::floor(turns);
  switch (std::min(4, static_cast<int>(5 * p[kForm]))) {
    case 0:
      return std::sin(2 * M_PI * turns);
    case 1:
      return part < between(0.05, 0.95, p[kDuty]) ? 1 : -1;
    case 2:
      return time_s < p[kDuty] ? 0 : 1;
    case 3:
      return 2 * part - 1;
    default:
      return part < between(0.05, 0.95, p[kDuty]) ? 1 : 0;
  }
}

/// What the truth of the device has reached.
struct Worst {
  double speed_m_s = 0, energy_J = 0, force_N = 0, felt_s = 0;  // the energy with that of the turn

  double of(Case::Goal goal) const {
    return goal == Case::kEnergy ? energy_J : goal == Case::kSpeed ? speed_m_s : force_N;
  }
};

GripModel hand_of(const Profile& profile, const Case& what, const Point& p) {
  GripModel model = released(profile, between(what.from_kg, what.to_kg, p[kMass]));
  // From half of a solid sphere's to nearly all of the mass at the radius.
  model.inertia_kg_m2 *= between(0.5, 2, p[kInertia]);
  const GripModel firm = grip_model_of(profile);
  const bool is_loose = !what.lets_go && !what.cuts;
  model.hand_stiffness_N_m =
      is_loose ? between(5, 60, p[kStiffness]) : between(300, 1500, p[kStiffness]);
  model.hand_damping_N_s_m = is_loose ? between(0.05, 0.5, p[kDamping]) : 8;
  const double softer = model.hand_stiffness_N_m / firm.hand_stiffness_N_m;
  model.hand_stiffness_Nm_rad = firm.hand_stiffness_Nm_rad * softer;
  model.hand_damping_Nm_s_rad =
      firm.hand_damping_Nm_s_rad * model.hand_damping_N_s_m / firm.hand_damping_N_s_m;
  return model;
}

Worst play(const Profile& profile, const Case& what, const Point& p) {
  constexpr int kPlayed_ms = 2500;
  constexpr int64_t kFrame_ns = 4 * kTick_ns;
  const GripModel hand = hand_of(profile, what, p);
  GripModel free = released(profile, hand.mass_kg);
  free.inertia_kg_m2 = hand.inertia_kg_m2;
  LetGoDevice device(profile, hand, free);
  SafetyLimits limits;
  limits.max_force_N = what.limit_N > 0 ? what.limit_N : released_force_N(profile.drive_lag_s);
  if (!(what.limit_N > 0)) {
    limits.max_torque_Nm =
        released_torque_Nm(profile.body(), profile.geometry.grip_radius_m(), profile.drive_lag_s);
  }
  const auto loop =
      std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device), limits);
  const double force_N = limits.max_force_N * std::min(1.0, 1.25 * p[kForce]);
  const Wrench most{force_N * towards(p[kForceZ], p[kForceAngle]),
                    p[kTorque] * limits.max_torque_Nm * towards(p[kTorqueZ], p[kTorqueAngle])};
  const bool is_late = p[kLate] > 0.5;
  LateTicks late(static_cast<uint64_t>(1e6 * p[kLate]), kTick_ns,
                 what.stalls ? LateTicks::kStalls : LateTicks::kATick);
  int64_t now_ns = 0, next_ns = 0;
  device.exchange_at(1);
  loop->open();
  const auto tick = [&] {
    late.advance();
    now_ns = is_late ? late.now_ns() : now_ns + kTick_ns;
    device.exchange_at(now_ns);
    loop->tick(is_late ? late.deadline_ns() : now_ns, now_ns);
  };
  // In half of all cases the hand that lets go is up to 3 cm off the centre, and goes there first.
  const double away = what.lets_go ? std::max(0.0, 2 * p[kAway] - 1) : 0;
  device.move_hand(
      [away_m = Eigen::Vector3d(0.03 * away * towards(p[kAwayZ], p[kAwayAngle]))](double time_s) {
        return Pose{std::min(1.0, 5 * time_s) * away_m, Eigen::Quaterniond::Identity()};
      });
  for (int i = 0; i < 250; ++i) tick();
  const int64_t begun_ns = now_ns;
  // In half of all cases the film pauses at some moment, for up to 0.4 s.
  const int64_t stops_ns = begun_ns + std::llround(between(0.05e9, 1.5e9, p[kStops]));
  const int64_t stopped_ns = std::llround(0.4e9 * std::max(0.0, 2 * p[kStopped] - 1));
  bool plays = true;
  const int64_t moment_ns = begun_ns + std::llround(between(0.05e9, 1.2e9, p[kMoment]));
  loop->set_playback_clock({now_ns, 0, 1, true});
  Worst worst;
  bool has_come = false;
  while (now_ns < begun_ns + kPlayed_ms * kTick_ns) {
    for (; next_ns <= now_ns - begun_ns + 80 * kTick_ns; next_ns += kFrame_ns)
      loop->schedule({next_ns, 2 * kFrame_ns, wave(p, 1e-9 * static_cast<double>(next_ns)) * most});
    if (!has_come && now_ns >= moment_ns) {
      has_come = true;
      if (what.lets_go) device.let_go();
      if (what.cuts) {
        const int first = static_cast<int>(p[kDamping] * profile.geometry.count) % 8;
        device.cut(first);
        device.cut((first + 1 + static_cast<int>(p[kMass] * 6.99)) % profile.geometry.count);
      }
    }
    if (plays != (now_ns < stops_ns || now_ns >= stops_ns + stopped_ns)) {
      plays = !plays;
      loop->set_playback_clock({now_ns, now_ns - begun_ns, 1, plays});
    }
    const int64_t before_ns = now_ns;
    tick();
    if (!has_come && (what.lets_go || what.cuts)) continue;
    const double speed_m_s = device.speed_m_s();
    worst.speed_m_s = std::max(worst.speed_m_s, speed_m_s);
    const double turn_rad_s = device.state().angular_velocity_rad_s.norm();
    worst.energy_J =
        std::max(worst.energy_J, 0.5 * hand.mass_kg * speed_m_s * speed_m_s +
                                     0.5 * hand.inertia_kg_m2 * turn_rad_s * turn_rad_s);
    const double felt_N = device.string_force_N();
    worst.force_N = std::max(worst.force_N, felt_N);
    if (felt_N > limits.max_force_N) worst.felt_s += 1e-9 * static_cast<double>(now_ns - before_ns);
  }
  return worst;
}

struct Searched {
  Worst worst;
  Point at{};
};

/// So many grips of a profile and a case.
Searched search(const Profile& profile, const Case& what, int grips, uint64_t seed) {
  constexpr int kGeneration = 60, kElite = 6;
  constexpr double kKept = 0.5;        // of a generation's distribution, in the next
  constexpr double kNarrowest = 0.03;  // standard deviation
  RandomMotion random(seed);
  Point mean, spread;
  mean.fill(0.5);
  spread.fill(0.6);
  Searched found;
  for (int done = 0; done < grips; done += kGeneration) {
    // After some generations, another beginning may find another worst.
    if (done % (8 * kGeneration) == 0) {
      for (double& m : mean) m = random.uniform(0, 1);
      spread.fill(0.6);
    }
    std::vector<Searched> generation(kGeneration);
    for (Searched& one : generation) {
      for (size_t i = 0; i < kParameters; ++i) {
        // Reflected at the ends; what is an angle or a phase goes round.
        double x = mean[i] + spread[i] * random.uniform(-1.7, 1.7);
        x = std::fabs(std::remainder(x, 2.0));
        one.at[i] = x;
      }
      one.worst = play(profile, what, one.at);
      if (one.worst.of(what.goal) > found.worst.of(what.goal)) found = one;
    }
    std::partial_sort(generation.begin(), generation.begin() + kElite, generation.end(),
                      [&](const Searched& a, const Searched& b) {
                        return a.worst.of(what.goal) > b.worst.of(what.goal);
                      });
    for (size_t i = 0; i < kParameters; ++i) {
      double sum = 0, squares = 0;
      for (int k = 0; k < kElite; ++k) {
        sum += generation[static_cast<size_t>(k)].at[i];
        squares += std::pow(generation[static_cast<size_t>(k)].at[i], 2);
      }
      const double average = sum / kElite;
      const double deviation = std::sqrt(std::max(0.0, squares / kElite - average * average));
      mean[i] += (1 - kKept) * (average - mean[i]);
      spread[i] = std::max(kNarrowest, spread[i] + (1 - kKept) * (deviation - spread[i]));
    }
  }
  return found;
}

}  // namespace

int spidar::bench::released(int argc, char** argv) {
  if (argc > 1 && argv[1] == std::string("--prove")) return prove_released(), 0;
  if (argc > 1 && argv[1] == std::string("--hands")) return held_hands(), 0;
  const int grips = argc > 1 ? std::atoi(argv[1]) : 100'000;
  const uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  if (grips <= 0) throw std::invalid_argument("usage: spidar-bench released [GRIPS] [SEED] [CASE]");
  const auto is_asked = [&](const Case& what) {
    return argc <= 3 || argv[3] == std::string(what.name);
  };
  if (std::none_of(std::begin(kCases), std::end(kCases), is_asked)) {
    std::string cases;
    for (const Case& what : kCases) cases += std::string("\n  \"") + what.name + "\"";
    throw std::invalid_argument("there is no case \"" + std::string(argv[3]) + "\"; there are" +
                                cases);
  }
  const std::vector<std::string> names = list_profiles();
  std::vector<Profile> profiles;
  for (const std::string& name : names) profiles.push_back(load_profile(name));
  const int each = std::max(60, grips / static_cast<int>(profiles.size() * std::size(kCases)));
  std::printf("%zu profiles, %d grips of each in each case, seed %llu\n", profiles.size(), each,
              static_cast<unsigned long long>(seed));
  for (const Case& what : kCases) {
    if (!is_asked(what)) continue;
    const auto threads = std::max<size_t>(1, std::thread::hardware_concurrency());
    std::vector<std::future<std::vector<Searched>>> parts;
    for (size_t part = 0; part < threads; ++part) {
      parts.push_back(std::async(std::launch::async, [&, part] {
        std::vector<Searched> all(profiles.size());
        for (size_t i = part; i < profiles.size(); i += threads)
          all[i] = search(profiles[i], what, each, seed * 1'000'003 + i);
        return all;
      }));
    }
    size_t worst = 0;
    std::vector<Searched> found(profiles.size());
    for (size_t part = 0; part < threads; ++part) {
      const std::vector<Searched> all = parts[part].get();
      for (size_t i = part; i < all.size(); i += threads) found[i] = all[i];
    }
    for (size_t i = 0; i < found.size(); ++i) {
      if (found[i].worst.of(what.goal) > found[worst].worst.of(what.goal)) worst = i;
    }
    const Searched& one = found[worst];
    std::printf("%-28s %5.1f mJ, %.3f m/s, %.2f N, above the limit for %.0f ms (%s:", what.name,
                1e3 * one.worst.energy_J, one.worst.speed_m_s, one.worst.force_N,
                1e3 * one.worst.felt_s, names[worst].c_str());
    for (const double x : one.at) std::printf(" %.3f", x);
    std::printf(")\n");
    std::fflush(stdout);
  }
  return 0;
}
