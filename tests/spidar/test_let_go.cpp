// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A hand holds the grip against a force and lets go: how fast the strings throw it, by the
/// simulation's truth. Short by default; SPIDAR_SWEEP=1 tries all profiles and more hands.
#include "spidar/chain/brake_table.h"
#include "spidar/limits/released_grip.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/string_grip.h"
#include "tests/support/let_go_device.h"
#include "tests/support/random_motion.h"
#include "tests/support/released_grip.h"
#include "tests/support/test.h"

namespace spidar::test::let_go_test {
namespace {

/// A grip of `mass_kg` in a hand of this stiffness and 8 N s/m.
GripModel held(const Profile& profile, double mass_kg, double stiffness_N_m) {
  GripModel model = grip_model_of(profile);
  model.inertia_kg_m2 *= mass_kg / model.mass_kg;
  model.mass_kg = mass_kg;
  model.hand_stiffness_N_m = stiffness_N_m;
  return model;
}

/// What ends the force of a film, and begins it again.
enum class Stop { kNever, kPause, kSeek, kNoFrames, kNoForce, kLessForce, kEnd, kAtFirst };

/// A film of up to `force_N`, which is also the limit, and when the hand lets go.
struct Push {
  double force_N = 0;
  Eigen::Vector3d towards = Eigen::Vector3d::UnitX();
  double rate_Hz = 0;
  int held_ms = 0;
  double times_limit = 1;      ///< what the film wants
  double duty = 0, phase = 0;  ///< of a square wave; 0: a cosine
  Eigen::Vector3d torque_Nm = Eigen::Vector3d::Zero();
  Pose hand{};
  Stop stop = Stop::kNever;
  int stops_ms = 0, stopped_ms = 0;  ///< from the moment at which the hand lets go

  double wave(double time_s) const {
    const double turns = rate_Hz * time_s + phase;
    if (duty > 0) return turns - std::floor(turns) < duty ? 1 : -1;
    return std::cos(2 * M_PI * turns);
  }
};

Push random_push(double force_N, RandomMotion& random) {
  Push push;
  push.force_N = force_N;
  push.towards = random.direction();
  push.rate_Hz = random.chance(0.5) ? 0 : random.uniform(0.2, 3);
  push.held_ms = 300 + random.some(1000);
  return push;
}

/// The largest speed after a hand has let go.
double thrown_m_s(const Profile& profile, const GripModel& hand, const Push& push) {
  constexpr int kReleased_ms = 2200;  // the force rests for a second, and returns within another
  constexpr int64_t kFrame_ns = 4 * kTick_ns;

  LetGoDevice device(profile, hand, released(profile, hand.mass_kg));
  // From the centre, where the loop is opened, within 0.1 s.
  device.move_hand([&](double time_s) {
    const double way = std::min(1.0, 10 * time_s);
    return Pose{way * push.hand.position_m,
                Eigen::Quaterniond::Identity().slerp(way, push.hand.orientation)};
  });
  SafetyLimits limits;
  limits.max_force_N = push.force_N;
  const auto loop =
      std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device), limits);
  loop->open();
  int64_t now_ns = 0, next_ns = 0;
  const auto tick = [&] {
    now_ns += kTick_ns;
    loop->tick(now_ns, now_ns);
  };
  for (int ms = 0; ms < 250; ++ms) tick();
  const int64_t begun_ns = now_ns;
  const auto play = [&](bool plays) {
    loop->set_playback_clock({now_ns, now_ns - begun_ns, 1, plays});
  };
  play(push.stop != Stop::kAtFirst);
  double fastest_m_s = 0;
  bool stopped = false;
  for (int ms = 0; ms < push.held_ms + kReleased_ms; ++ms) {
    const int since_ms = ms - push.held_ms - push.stops_ms;
    const bool stops = push.stop != Stop::kNever && since_ms >= 0 && since_ms < push.stopped_ms;
    if (stops != std::exchange(stopped, stops)) {
      if (push.stop == Stop::kPause || push.stop == Stop::kAtFirst) play(!stops);
      if (push.stop == Stop::kSeek) loop->cancel_scheduled();
      if (push.stop == Stop::kEnd) loop->begin_close();
      const double left = !stops ? 1 : push.stop == Stop::kLessForce ? 0.3 : 0;
      limits.max_force_N = left * push.force_N;
      if (push.stop >= Stop::kNoForce && push.stop <= Stop::kLessForce) loop->set_limits(limits);
    }
    const bool has_frames = !stops || push.stop != Stop::kNoFrames;
    for (; has_frames && next_ns <= now_ns - begun_ns + 20 * kTick_ns; next_ns += kFrame_ns) {
      const double wave = push.times_limit * push.wave(1e-9 * static_cast<double>(next_ns));
      loop->schedule(
          {next_ns, 2 * kFrame_ns, {wave * push.force_N * push.towards, wave * push.torque_Nm}});
    }
    if (ms == push.held_ms) device.let_go();
    tick();
    if (ms >= push.held_ms) fastest_m_s = std::max(fastest_m_s, device.speed_m_s());
  }
  return fastest_m_s;
}

// Unless what throws a grip ends at once, 10 N throw 50 g at 3.5 m/s, and 20 N at 5.9 m/s.
TEST(LetGo, AGripThatAHandLetsGoOfIsNotThrown) {
  const bool all = std::getenv("SPIDAR_SWEEP") != nullptr;
  const std::vector<std::string> names =
      all ? list_profiles()
          : std::vector<std::string>{kDefaultProfile, "spidar-g6o", "spidar-g6x3-v2-r",
                                     "spidar-i05"};
  RandomMotion random(71);
  double most_J = 0;
  std::map<std::pair<double, double>, double> fastest_m_s;  // by force and mass
  for (const std::string& name : names) {
    const Profile profile = load_profile(name);
    SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
    const double most_N = StringGrip(profile, device).abilities().largest_force_N;
    EXPECT_LE(most_N, released_force_N(profile.drive_lag_s)) << name;
    for (const double force_N : {3.0, 0.5 * (3 + most_N), most_N}) {
      for (const double mass_kg : {kLightestGrip_kg, 0.1, kHeaviestGrip_kg}) {
        for (int n = 0; n < (all ? 30 : 4); ++n) {
          const GripModel hand = held(profile, mass_kg, random.uniform(300, 1500));
          const Push push = random_push(force_N, random);
          const double speed_m_s = thrown_m_s(profile, hand, push);
          double& worst_m_s = fastest_m_s[{std::round(force_N), mass_kg}];
          worst_m_s = std::max(worst_m_s, speed_m_s);
          const double energy_J = 0.5 * mass_kg * speed_m_s * speed_m_s;
          most_J = std::max(most_J, energy_J);
          EXPECT_LE(speed_m_s, kReleased_m_s)
              << name << ", " << force_N << " N, " << mass_kg << " kg, hand " << n;
          EXPECT_LE(energy_J, kReleased_J)
              << name << ", " << force_N << " N, " << mass_kg << " kg, hand " << n;
        }
      }
    }
  }
  for (const auto& [of, speed_m_s] : fastest_m_s)
    std::printf("%2.0f N, %3.0f g: %.2f m/s\n", of.first, 1e3 * of.second, speed_m_s);
  std::printf("at most %.1f mJ\n", 1e3 * most_J);
}

// With a damper that acts only while a force is wanted, the strings at rest throw 34 g at 1.51 m/s,
// and at 0.62 while a film plays.
TEST(LetGo, WithoutAForceTheStringsAtRestThrowNoFaster) {
  const Profile profile = load_profile("spidar-g6c");
  for (const double mass_kg : {kLightestGrip_kg, kHeaviestGrip_kg}) {
    for (const Eigen::Vector3d& towards :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0, -1, 1)}) {
      Push push;
      push.held_ms = 1000;
      push.force_N = 3;
      push.times_limit = 0;
      push.hand.position_m = 0.05 * towards.normalized();
      push.stops_ms = -500;
      push.stopped_ms = 10'000;
      const GripModel hand = held(profile, mass_kg, 1500);
      const double plays_m_s = thrown_m_s(profile, hand, push);
      for (const Stop stop : {Stop::kPause, Stop::kSeek, Stop::kNoFrames, Stop::kNoForce,
                              Stop::kLessForce, Stop::kAtFirst}) {
        push.stop = stop;
        // At no force the damper may only take back what the strings at rest give.
        EXPECT_LE(thrown_m_s(profile, hand, push), 1.05 * plays_m_s)
            << 1e3 * mass_kg << " g, towards " << towards.transpose() << ", stop "
            << static_cast<int>(stop) << ", while it plays " << plays_m_s << " m/s";
      }
    }
  }
}

// With 3 N and a lag of 0.1 s, 34 g get 2.3 m/s.
TEST(LetGo, LateDrivesGetLessForce) {
  RandomMotion random(74);
  for (const std::string name : {kDefaultProfile, "spidar-g645"}) {
    Profile profile = load_profile(name);
    for (const double lag_s : {0.01, 0.04, 0.1}) {
      profile.drive_lag_s = lag_s;
      const GripModel hand = held(profile, kLightestGrip_kg, 1500);
      for (int n = 0; n < 4; ++n) {
        const Push push = random_push(3, random);
        EXPECT_LE(thrown_m_s(profile, hand, push), kReleased_m_s) << name << ", " << lag_s << " s";
      }
    }
  }
}

// Unless the brake acts in it, a pause of 20 to 420 ms makes 1.77 m/s of 1.0, and 115 mJ of 50.
TEST(LetGo, NothingThatEndsAForceThrowsAGrip) {
  const bool all = std::getenv("SPIDAR_SWEEP") != nullptr;
  RandomMotion random(73);
  const std::vector<std::string> names = list_profiles();
  double most_J = 0;
  for (int n = 0; n < (all ? 20'000 : 200); ++n) {
    const Profile profile = load_profile(names[static_cast<size_t>(n) % names.size()]);
    const double mass_kg =
        random.chance(0.5) ? kHeaviestGrip_kg : random.uniform(kLightestGrip_kg, kHeaviestGrip_kg);
    const GripModel hand = held(profile, mass_kg, random.uniform(300, 1500));
    Push push = random_push(random.chance(0.5) ? 3 : released_force_N(profile.drive_lag_s), random);
    push.hand = random.pose(0.03, 0.5);
    push.stop = static_cast<Stop>(1 + n % 7);
    push.stops_ms = random.some(600) - 100;
    push.stopped_ms = 20 + random.some(400);
    const double speed_m_s = thrown_m_s(profile, hand, push);
    const double energy_J = 0.5 * mass_kg * speed_m_s * speed_m_s;
    most_J = std::max(most_J, energy_J);
    EXPECT_LE(speed_m_s, kReleased_m_s) << profile.name << ", grip " << n;
    EXPECT_LE(energy_J, kReleased_J) << profile.name << ", grip " << n;
  }
  std::printf("at most %.1f mJ\n", 1e3 * most_J);
}

// The strings at rest take the energy of a heavy grip on its way out. If it does not count, the
// film pushes it on to where no string can brake it, and on the way back it has 57 to 69 mJ.
TEST(LetGo, WhatTheStringsAtRestStoreCounts) {
  const struct {
    const char* profile;
    double mass_kg, stiffness_N_m;
    Push push;
  } grips[] = {
      {"spidar-g6x5-l", 0.23, 351, {8.37, {0.29, 0.70, 0.66}, 0, 1165}},
      {"spidar-g6x5-r", 0.268, 981, {6.29, {0.68, -0.69, -0.25}, 0, 308}},
      {"spidar-g6x5-l", 0.264, 431, {6.83, {-0.15, -0.69, 0.71}, 0, 848}},
      {"spidar-g6x5-r", 0.203, 1017, {8.87, {0.82, -0.47, -0.32}, 0, 483}},
  };
  for (const auto& grip : grips) {
    const Profile profile = load_profile(grip.profile);
    const GripModel hand = held(profile, grip.mass_kg, grip.stiffness_N_m);
    const double speed_m_s = thrown_m_s(profile, hand, grip.push);
    EXPECT_LE(0.5 * grip.mass_kg * speed_m_s * speed_m_s, kReleased_J)
        << grip.profile << ", " << grip.push.force_N << " N, " << grip.mass_kg << " kg";
  }
}

// A film bends a hand, turns round, and the hand lets go as it swings back, with 37 to 48 mJ that
// are its own. The bound is that of docs/strings.md.
TEST(LetGo, AReversedForceAddsLittleToTheSwingOfAHand) {
  constexpr double kBound_J = 0.067;
  const struct {
    const char* profile;
    double mass_kg, stiffness_N_m;
    Push push;
  } grips[] = {
      {"spidar-g645",
       0.272,
       548,
       {9.9, {-0.344, -0.937, 0.064}, 0.84, 200, 1, 0.42, 0.925, {-0.002, -0.079, -0.003}}},
      {"spidar-g6x3-v1-r",
       0.284,
       772,
       {10.2, {-0.588, 0.738, 0.332}, 3.88, 1108, 1, 0.63, 0.863, {-0.013, 0.019, -0.009}}},
  };
  for (const auto& grip : grips) {
    const Profile profile = load_profile(grip.profile);
    const GripModel hand = held(profile, grip.mass_kg, grip.stiffness_N_m);
    double most_J = 0;
    // The moment counts: the worst of a swing.
    for (int ms = -60; ms <= 60; ms += 5) {
      Push push = grip.push;
      push.held_ms += ms;
      const double speed_m_s = thrown_m_s(profile, hand, push);
      most_J = std::max(most_J, 0.5 * grip.mass_kg * speed_m_s * speed_m_s);
    }
    std::printf("%s: %.1f mJ\n", grip.profile, 1e3 * most_J);
    EXPECT_LE(most_J, kBound_J) << grip.profile;
  }
}

// A torque turns it in 0.14 s until its pose is lost. A force that goes on for 20 ms then gives it
// 64 mJ here, and 87 in the worst case that a search has found.
TEST(LetGo, AGripThatIsTurnedAwayGetsNoForce) {
  const Profile profile = load_profile("spidar-igarashi001");
  const GripModel hand = held(profile, 0.293, 906);
  const Push push{9.13,  {-0.888, -0.46, -0.016},   2.381, 944, 1, 0.3515,
                  0.552, {-0.0041, -0.0189, -0.005}};
  const double speed_m_s = thrown_m_s(profile, hand, push);
  std::printf("%.1f mJ\n", 1e3 * 0.5 * 0.293 * speed_m_s * speed_m_s);
  EXPECT_LE(0.5 * 0.293 * speed_m_s * speed_m_s, kReleased_J);
}

// A brake that leaves half of a thousand times the limit has no effect: 5.9 m/s.
TEST(LetGo, AFilmThatWantsMoreThanTheLimitThrowsNoFurther) {
  RandomMotion random(72);
  for (const std::string name : {kDefaultProfile, "spidar-i05"}) {
    const Profile profile = load_profile(name);
    for (const double times_limit : {10.0, 1000.0}) {
      for (int n = 0; n < 8; ++n) {
        const double mass_kg = n % 2 == 0 ? kLightestGrip_kg : kHeaviestGrip_kg;
        const GripModel hand = held(profile, mass_kg, random.uniform(300, 1500));
        Push push = random_push(random.uniform(3, released_force_N(profile.drive_lag_s)), random);
        push.times_limit = times_limit;
        const double speed_m_s = thrown_m_s(profile, hand, push);
        const double energy_J = 0.5 * mass_kg * speed_m_s * speed_m_s;
        EXPECT_LE(speed_m_s, kReleased_m_s) << name << ", times " << times_limit << ", hand " << n;
        EXPECT_LE(energy_J, kReleased_J) << name << ", times " << times_limit << ", hand " << n;
      }
    }
  }
}

}  // namespace
}  // namespace spidar::test::let_go_test
