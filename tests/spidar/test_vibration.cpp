// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How the vibration of a hand is measured and limited: the budget alone, and films on the
/// simulated device with the true acceleration of its grip.
#include <complex>

#include "spidar/limits/vibration_budget.h"
#include "tests/support/released_grip.h"
#include "tests/support/test.h"

namespace spidar::test::vibration_test {
namespace {

using Budget = VibrationBudget;

constexpr double kForce_N = 3;

Wrench push(double force_N) {
  return {{force_N, 0, 0}, {0, 0, 0}};
}

/// W_h of ISO 5349-1 without its low-pass of 1259 Hz.
double weight(double frequency_Hz) {
  const std::complex<double> s(0, 2 * M_PI * frequency_Hz);
  const double w1 = 2 * M_PI * std::pow(10, 0.8), w3 = 100;
  return std::abs(s * s / (s * s + s * w1 * std::sqrt(2.0) + w1 * w1) * (s / w3 + 1.0) /
                  (s * s / (w3 * w3) + s / (0.64 * w3) + 1.0));
}

/// A budget whose force is lowered by its own fraction, as in the loop.
struct Shaken {
  /// Goes on for some seconds with a force in N at a time in s.
  template <typename Force>
  void run(double seconds, Force force_N) {
    for (int64_t end = tick + std::llround(1e3 * seconds); tick < end; ++tick) {
      const double lowered_N = budget.fraction() * force_N(1e-3 * static_cast<double>(tick));
      budget.update(push(lowered_N), 1e-3, tick * kTick_ns);
      if (budget.fraction() < 1 && begun_s < 0) begun_s = 1e-3 * static_cast<double>(tick);
    }
  }
  /// Vibration since the beginning, m²/s³, if the store has never been full since then.
  double taken_m2_s3() const {
    return Budget::kRefill_m2_s4 * 1e-9 * static_cast<double>(budget.full_at_ns());
  }

  Budget budget{0};
  int64_t tick = 0;
  double begun_s = -1;  // when the fraction first was below 1
};

/// ±3 N, another sign with each of 25 pictures a second.
double strobe_N(double time_s) {
  return std::fmod(12.5 * time_s, 1.0) < 0.5 ? kForce_N : -kForce_N;
}

TEST(VibrationBudget, WeightsAsPublished) {
  // ISO 5349-1:2001, table A.2, by number of the third-octave band, as in JIS B 7761-3.
  const double published[] = {.727, .873,  .951,  .958,  .896,  .782,  .647,   .519,   .411,
                              .324, 0.256, 0.202, 0.160, 0.127, 0.101, 0.0799, 0.0634, 0.0503};
  int band = 8;
  for (const double expected : published) {
    const double frequency_Hz = std::pow(10, 0.1 * band++);
    const auto sine_N = [&](double t) { return 0.1 * std::sin(2 * M_PI * frequency_Hz * t); };
    Shaken hand;
    hand.budget.restore(3600 * 1000 * kTick_ns);  // the store does not become full
    hand.run(2, sine_N);                          // the filter's own oscillation is over
    const double before = hand.taken_m2_s3();
    constexpr double kLong_s = 20;
    hand.run(kLong_s, sine_N);
    const double felt_m_s2 = std::sqrt((hand.taken_m2_s3() - before) / kLong_s);
    const double measured = felt_m_s2 / (0.1 / std::sqrt(2.0) / Budget::kMoved_kg);
    // The bilinear transform has at f the weight of tan(πfT)/(πT), and the weight falls as 1/f. The
    // low-pass of 1259 Hz is left out. The table is rounded to three digits. The mean of the square
    // ends within a period, of which there are 126 or more.
    const double pi_f_t = M_PI * frequency_Hz * Budget::kTick_s;
    const double warped = 1 - pi_f_t / std::tan(pi_f_t);
    const double low_pass = std::hypot(1, std::pow(frequency_Hz / 1259, 2)) - 1;
    const double rounded = 0.5 * (expected < 0.1 ? 1e-4 : 1e-3) / expected;
    const double partial = 1 / (4 * M_PI * frequency_Hz * kLong_s);
    const double tolerance = warped + low_pass + rounded + partial;
    EXPECT_NEAR(measured / expected, 1, tolerance) << frequency_Hz << " Hz";
  }
}

TEST(VibrationBudget, ATorqueCountsAsTheForceAtTheRadiusOfTheGrip) {
  constexpr double kRadius_m = 0.03;
  Budget pushed(kRadius_m), turned(kRadius_m);
  for (int tick = 0; tick < 1000; ++tick) {
    const double force_N = strobe_N(1e-3 * tick);
    pushed.update(push(force_N), 1e-3, tick * kTick_ns);
    turned.update({{0, 0, 0}, {kRadius_m * force_N, 0, 0}}, 1e-3, tick * kTick_ns);
  }
  EXPECT_GT(pushed.full_at_ns(), 1000 * kTick_ns);
  // Each tick is rounded to a nanosecond.
  EXPECT_NEAR(static_cast<double>(turned.full_at_ns() - pushed.full_at_ns()), 0, 1000);
}

TEST(VibrationBudget, AStepTakesItsEnergyOnceAndAConstantForceNothing) {
  Shaken hand;
  hand.budget.restore(200'000 * kTick_ns);  // the store does not become full
  const double before = hand.taken_m2_s3();
  hand.run(10, [](double) { return kForce_N; });
  const double taken = hand.taken_m2_s3() - before;
  hand.run(60, [](double) { return kForce_N; });
  // The resolution is 1 ns of the refill a tick.
  EXPECT_NEAR(hand.taken_m2_s3() - before, taken, 60e3 * Budget::kRefill_m2_s4 * 1e-9);
  EXPECT_EQ(hand.begun_s, -1);
  // Parseval: the energy of a step of height A is A²/π ∫ |W(ω)|²/ω² dω. Ticks of 1 ms have nothing
  // above 500 Hz, where 1 % of the integral is; the sum below has steps of 0.02 Hz.
  double integral = 0;
  for (double f = 0.01; f < 500; f += 0.02)
    integral += std::pow(weight(f) / (2 * M_PI * f), 2) * 2 * M_PI * 0.02;
  const double expected = std::pow(kForce_N / Budget::kMoved_kg, 2) / M_PI * integral;
  EXPECT_NEAR(taken, expected, 0.01 * expected);
}

/// SPIDAR_SWEEP=1 lets the long tests take eight hours of simulated time.
bool sweep() {
  return std::getenv("SPIDAR_SWEEP") != nullptr;
}

TEST(VibrationBudget, LowersAStrobeWhenPredictedAndStaysWithinTheBudget) {
  Shaken hand;
  hand.run(2, strobe_N);
  const double before = hand.taken_m2_s3();
  hand.run(20, strobe_N);
  const double strobe_m2_s4 = (hand.taken_m2_s3() - before) / 20;
  // A square wave: 4/π (sin ω + sin 3ω/3 + …).
  double expected_m2_s4 = 0;
  for (int n = 1; n < 40; n += 2) {
    const double amplitude = 4 / M_PI / n * kForce_N / Budget::kMoved_kg * weight(12.5 * n);
    expected_m2_s4 += 0.5 * amplitude * amplitude;
  }
  EXPECT_NEAR(strobe_m2_s4, expected_m2_s4, 0.01 * expected_m2_s4);

  hand.run(600, strobe_N);
  // The store takes the vibration until 1/kEmptied_s of what is left is less than the vibration's
  // mean. The ripple of this mean over 2 s is 1/(2π · 25 Hz · 2 s) of it, so that it begins a
  // little sooner.
  const double net_m2_s4 = strobe_m2_s4 - Budget::kRefill_m2_s4;
  const double ripple = 1 / (2 * M_PI * 25 * 2);
  const auto begins_s = [&](double above) {
    return (Budget::kStore_m2_s3 - (1 + above) * strobe_m2_s4 * Budget::kEmptied_s) / net_m2_s4;
  };
  EXPECT_LE(hand.begun_s, begins_s(0) + 1);
  EXPECT_GE(hand.begun_s, begins_s(ripple) - 1);
  std::printf("%.1f m/s², lowered from %.1f s on, after 10 minutes to %.3f\n",
              std::sqrt(strobe_m2_s4), hand.begun_s, hand.budget.fraction());

  const double long_s = sweep() ? 8 * 3600 : 3600;
  hand.run(long_s - 622, strobe_N);
  EXPECT_LE(hand.taken_m2_s3(), Budget::kStore_m2_s3 + long_s * Budget::kRefill_m2_s4);
  // What is felt in the end is the refill, within the ripple.
  const double end = hand.taken_m2_s3();
  hand.run(100, strobe_N);
  const double felt = (hand.taken_m2_s3() - end) / 100;
  EXPECT_LE(felt, Budget::kRefill_m2_s4 * 1.001);
  EXPECT_GE(felt, Budget::kRefill_m2_s4 * (1 - 2 * ripple));
}

TEST(VibrationBudget, BurstsDoNotGetMore) {
  Shaken hand;
  hand.budget.restore(24 * 3600 * kTick_ns * 1000);  // the store is empty
  const double before = hand.taken_m2_s3();
  for (const double pause_s : {0.3, 3.0, 30.0, 60.0, 100.0}) {
    const double begin = hand.taken_m2_s3(), begin_s = 1e-3 * static_cast<double>(hand.tick);
    for (int i = 0; i < 20; ++i) {
      hand.run(1, strobe_N);
      hand.run(pause_s, [](double) { return 0; });
    }
    const double mean_m2_s4 =
        (hand.taken_m2_s3() - begin) / (1e-3 * static_cast<double>(hand.tick) - begin_s);
    std::printf("a second of strobe every %.1f s: %.2f of the refill\n", pause_s + 1,
                mean_m2_s4 / Budget::kRefill_m2_s4);
    EXPECT_LT(mean_m2_s4, Budget::kRefill_m2_s4);
  }
  EXPECT_GT(hand.taken_m2_s3(), before);
}

/// A strobe film of 25 pictures/s on the simulated device, whose store begins with so much.
struct StrobeFilm {
  StrobeFilm(const GripModel& hand, double store_m2_s3)
      : grip(load_profile(kDefaultProfile), hand, pulses({kForce_N, 0, 0}, 12.5, true)) {
    const double empty_s = (Budget::kStore_m2_s3 - store_m2_s3) / Budget::kRefill_m2_s4;
    grip.loop->vibration().restore(grip.now_ns + std::llround(1e9 * empty_s));
    truth.restore(grip.now_ns + 48 * 3600 * 1000 * kTick_ns);  // never full
    begin_ns = truth.full_at_ns();
  }
  void run(double seconds) {
    for (int64_t i = 0; i < std::llround(1e3 * seconds); ++i) {
      const Eigen::Vector3d before_m_s = grip.device.felt().velocity_m_s;
      grip.tick();
      const Eigen::Vector3d change_m_s = grip.device.felt().velocity_m_s - before_m_s;
      truth.update({change_m_s / 1e-3 * Budget::kMoved_kg, {0, 0, 0}}, 1e-3, grip.now_ns);
    }
  }
  /// Of the grip as it really moved.
  double taken_m2_s3() const {
    return Budget::kRefill_m2_s4 * 1e-9 * static_cast<double>(truth.full_at_ns() - begin_ns);
  }
  double fraction() const { return grip.snapshot().vibration.fraction; }

  PlayedGrip grip;
  Budget truth{0};
  int64_t begin_ns = 0;
};

// Eight hours from a full store on, or two minutes from one that is nearly empty.
TEST(Vibration, OfAStrobeFilmIsWithinTheBudgetInTheHand) {
  const double store_m2_s3 = sweep() ? Budget::kStore_m2_s3 : 20'000;
  const double long_s = sweep() ? 8 * 3600 : 120;
  for (const bool light : {false, true}) {
    GripModel hand = grip_model_of(load_profile(kDefaultProfile));
    if (light) {
      hand.hand_stiffness_N_m = 100;
      hand.hand_damping_N_s_m = 2;
    }
    StrobeFilm film(hand, store_m2_s3);
    film.run(10);
    const double unlowered_m_s2 = std::sqrt(film.taken_m2_s3() / 10);
    film.run(long_s - 10);
    const double all = film.taken_m2_s3();
    film.run(30);
    const double end_m_s2 = std::sqrt((film.taken_m2_s3() - all) / 30);
    std::printf("%s hand: %.1f m/s², after %.0f s %.2f m/s², fraction %.3f, A(8) %.2f m/s²\n",
                light ? "light" : "firm", unlowered_m_s2, long_s, end_m_s2, film.fraction(),
                std::sqrt(all / (8 * 3600)));
    // A mass m on a spring k with a damper c moves by |1 − (ω₀/ω)² + c/(jωm)|⁻¹ of what it does
    // alone. The strings' own friction is part of the damper.
    const double omega = 2 * M_PI * 12.5;
    const double alone = 1 - hand.hand_stiffness_N_m / (hand.mass_kg * omega * omega);
    const double gain = 1 / std::hypot(alone, hand.hand_damping_N_s_m / (omega * hand.mass_kg));
    const double most = store_m2_s3 + long_s * Budget::kRefill_m2_s4;
    EXPECT_LE(all, std::max(1.0, gain * gain) * most);
    EXPECT_LE(all, Budget::kDay_m2_s3);
    EXPECT_LT(film.fraction(), 0.5);
    EXPECT_TRUE(film.grip.snapshot().vibration.lowered());
  }
}

/// What the loop commands differs in no bit from the safety chain alone.
void expect_untouched(PlayedGrip& grip, int ticks) {
  WrenchLimits safety;
  for (int i = 0; i < ticks; ++i) {
    grip.tick();
    const TickRecord last = grip.snapshot().last;
    const Wrench alone = safety.apply(last.wanted, last.found != Found::kNothing, 1e-3, {});
    ASSERT_EQ(last.commanded.stacked(), alone.stacked()) << "tick " << i;
  }
  EXPECT_EQ(grip.snapshot().vibration.fraction, 1);
}

TEST(Vibration, OfASlowFilmIsNeverTouched) {
  const auto sine = [](double rate_Hz) {
    return [rate_Hz](double t) { return push(kForce_N * std::sin(2 * M_PI * rate_Hz * t)); };
  };
  const Profile profile = load_profile(kDefaultProfile);
  for (const double rate_Hz : {0.3, 0.8}) {
    // Even with an empty store: its whole force is 21 m/s², weighted by 0.016 at 0.8 Hz.
    PlayedGrip grip(profile, grip_model_of(profile), sine(rate_Hz));
    grip.loop->vibration().restore(grip.now_ns + 24 * 3600 * 1000 * kTick_ns);
    expect_untouched(grip, 10'000);
    EXPECT_LT(grip.snapshot().vibration.left, 0.001);
  }
  for (const double rate_Hz : {2.0, 4.0}) {
    PlayedGrip grip(profile, grip_model_of(profile), sine(rate_Hz));
    expect_untouched(grip, 10'000);
  }
}

}  // namespace
}  // namespace spidar::test::vibration_test
