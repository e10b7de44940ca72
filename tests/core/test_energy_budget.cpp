// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/energy_budget.h"
#include "tests/support/test.h"

namespace spidar::test::energy_budget_test {
namespace {

constexpr double kTick_s = 1e-3;
const Eigen::Vector3d kUp(0, 0, 1);
const Eigen::Vector3d kStill(0, 0, 0);
const Eigen::Vector3d kNothing(0, 0, 0);

/// A budget that `left_J` are left of, for a grip of this speed, after a steady force.
touch::EnergyBudget budget_of(double left_J, double out_m_s, double force_N,
                              const touch::ForcePath& path) {
  touch::EnergyBudget budget;
  for (int n = 0; n < 100; ++n) {
    budget.update(kStill, out_m_s * kUp, n == 99 ? left_J : 0, left_J);
    budget.command(force_N * kUp, kNothing, path, kTick_s);
  }
  return budget;
}

TEST(EnergyBudget, WhatIsTakenBackFromTheBoundOnDoesTheWorkThatIsLeft) {
  for (const double lag_s : {0.0, 0.002}) {
    for (const double left_J : {1e-5, 1e-4, 1e-3, 5e-3}) {
      for (const double out_m_s : {-0.3, 0.0, 0.1, 0.5}) {
        touch::ForcePath path;
        path.lag_s = lag_s;
        const double before_N = 0.001 * left_J / 1e-5;
        const touch::EnergyBudget budget = budget_of(left_J, out_m_s, before_N, path);
        const double most_N = budget.allowed_force_N(kUp, path, kTick_s);
        if (most_N == 0) continue;
        // The mass feels the force that is still there, and then the bound, which is taken back by
        // a step a tick. The work follows from the impulse alone: p²/2m before and after.
        double impulse_Ns = 0;
        double force_N = before_N;
        double command_N = most_N;
        for (int n = 0; n < 200; ++n) {
          const double fading = lag_s > 0 ? std::exp(-kTick_s / lag_s) : 0;
          impulse_Ns += command_N * kTick_s + (force_N - command_N) * (1 - fading) * lag_s;
          force_N = command_N + (force_N - command_N) * fading;
          command_N = std::max(0.0, command_N - path.max_slew_N_s * kTick_s);
        }
        const auto work_J = [&](double Ns) {
          return out_m_s * Ns + Ns * Ns / (2 * path.least_mass_kg);
        };
        // The tick that is not measured yet has been paid for.
        const double unmeasured_J = before_N * kTick_s * out_m_s;
        EXPECT_LE(work_J(impulse_Ns), left_J - unmeasured_J + 1e-12)
            << lag_s << " " << left_J << " " << out_m_s;
        // In steps it takes at least F²/2S + F T/2, the bound allows F T in place of that.
        EXPECT_GE(work_J(impulse_Ns + 0.5 * most_N * kTick_s), left_J - unmeasured_J - 1e-9);
      }
    }
  }
}

TEST(EnergyBudget, IsWhatTheHandHasDoneAndNoMoreThanTheSpringHolds) {
  touch::ForcePath path;
  path.lag_s = 0;
  path.max_slew_N_s = 1e9;
  touch::EnergyBudget budget;
  budget.command(2 * kUp, kNothing, path, kTick_s);
  budget.command(3 * kUp, kNothing, path, kTick_s);
  // The way of the tick of 2 N.
  budget.update(-0.001 * kUp, kStill, 0, 1);
  EXPECT_NEAR(budget.left_J(), 2e-3, 1e-15);
  budget.command(3 * kUp, kNothing, path, kTick_s);
  budget.update(0.0005 * kUp, kStill, 0, 1);
  EXPECT_NEAR(budget.left_J(), 0.5e-3, 1e-15);
  budget.update(kStill, kStill, 1e-3, 1);
  EXPECT_NEAR(budget.left_J(), 1.5e-3, 1e-15) << "the surface has put some in";
  budget.update(kStill, kStill, 0, 1e-4);
  EXPECT_EQ(budget.left_J(), 1e-4);
  budget.update(kStill, kStill, 0, 0);
  EXPECT_EQ(budget.left_J(), 0) << "nothing is touched";
}

TEST(EnergyBudget, KnowsTheLimitsOfThePath) {
  touch::ForcePath path;
  path.lag_s = 0;
  path.max_force_N = 1;
  touch::EnergyBudget budget;
  // 0.3 N in the first tick, and 1 N at most.
  for (int n = 0; n < 10; ++n) budget.command(50 * kUp, kNothing, path, kTick_s);
  budget.update(-0.001 * kUp, kStill, 0, 1);
  EXPECT_NEAR(budget.left_J(), 1e-3, 1e-15);
  touch::EnergyBudget fresh;
  fresh.command(50 * kUp, kNothing, path, kTick_s);
  fresh.command(50 * kUp, kNothing, path, kTick_s);
  fresh.update(-0.001 * kUp, kStill, 0, 1);
  EXPECT_NEAR(fresh.left_J(), 0.3e-3, 1e-15);
}

TEST(EnergyBudget, CountsWhatTheContactAddsToAForceBesideIt) {
  touch::ForcePath path;
  path.lag_s = 0;
  path.max_slew_N_s = 1e9;
  path.max_force_N = 3;
  // 2 N beside it leave 1 N of the contact's 2.5 N.
  touch::EnergyBudget budget;
  for (int n = 0; n < 3; ++n) budget.command(2.5 * kUp, 2 * kUp, path, kTick_s);
  EXPECT_NEAR(budget.force_N().z(), 1, 1e-12);
  budget.update(-0.001 * kUp, kStill, 0, 1);
  EXPECT_NEAR(budget.left_J(), 1e-3, 1e-15);
  // Against it there is room for all of it.
  touch::EnergyBudget against;
  for (int n = 0; n < 3; ++n) against.command(2.5 * kUp, -2 * kUp, path, kTick_s);
  EXPECT_NEAR(against.force_N().z(), 2.5, 1e-12);
  // Both share the slew limit.
  path.max_slew_N_s = 300;
  touch::EnergyBudget rising;
  rising.command(1 * kUp, 1 * kUp, path, kTick_s);
  EXPECT_NEAR(rising.force_N().z(), 0, 1e-12) << "0.3 N are let through with and without it";
}

TEST(EnergyBudget, CountsWhatTheDeviceGives) {
  touch::ForcePath path;
  path.lag_s = 0;
  path.max_slew_N_s = 1e9;
  const Eigen::Vector3d aside(1, 0, 0);
  touch::EnergyBudget budget;
  const auto tick = [&](const Eigen::Vector3d& beside_N, const Wrench& given,
                        const Eigen::Vector3d& turn_rad = kStill) {
    budget.command(3 * kUp, beside_N, path, kTick_s);
    budget.set_delivered(given, turn_rad);
  };
  // Of 3 N, one, and one to the side.
  for (int n = 0; n < 2; ++n) tick(kNothing, {kUp + aside, kNothing});
  budget.update(-0.001 * kUp, kStill, 0, 1);
  EXPECT_NEAR(budget.left_J(), 1e-3, 1e-15);
  budget.update(0.0005 * aside, kStill, 0, 1);
  EXPECT_NEAR(budget.left_J(), 0.5e-3, 1e-15);
  // A torque that nobody asked for turns the grip in the tick after.
  tick(kNothing, {kNothing, 0.01 * kUp});
  tick(kNothing, {kNothing, kNothing}, 0.02 * kUp);
  EXPECT_NEAR(budget.left_J(), 0.3e-3, 1e-15);
  // What is given for a force beside them is not known.
  tick(2 * kUp, {2.5 * kUp, kNothing});
  EXPECT_NEAR(budget.force_N().z(), 3, 1e-12);
}

/// A force down is allowed to a grip that moves up; not if what is given for it goes up, too.
TEST(EnergyBudget, AllowsNothingThatHelpsTheMotion) {
  const touch::ForcePath path;
  touch::EnergyBudget budget;
  for (int n = 0; n < 100; ++n) {
    budget.update(kStill, 0.1 * kUp, 0, 0);
    budget.command(-kUp, kNothing, path, kTick_s);
    if (n == 50) {
      EXPECT_GT(budget.allowed_force_N(-kUp, path, kTick_s), 1);
    }
    if (n > 50) budget.set_delivered({0.5 * kUp, kNothing}, kStill);
  }
  EXPECT_EQ(budget.allowed_force_N(-kUp, path, kTick_s), 0);
}

TEST(EnergyBudget, AllowsAForceThatPressesOnASpringAtRest) {
  // ½ F²/K are left at rest. The bound is above F as long as √(m/K) exceeds lag + tick + F / 2 S:
  // up to 4.2 N at 500 N/m and up to 2.9 N at 800.
  const touch::ForcePath path;
  for (const auto& [stiffness_N_m, force_N] : {std::pair{500.0, 4.1}, {800.0, 2.9}}) {
    const double stored_J = 0.5 * force_N * force_N / stiffness_N_m;
    const touch::EnergyBudget budget = budget_of(stored_J, 0, force_N, path);
    EXPECT_GE(budget.allowed_force_N(kUp, path, kTick_s), force_N);
  }
}

}  // namespace
}  // namespace spidar::test::energy_budget_test
