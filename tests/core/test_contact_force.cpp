// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/contact_force.h"
#include "tests/support/test.h"
#include "tests/support/touch_surfaces.h"

namespace spidar::test::contact_force_test {
namespace {

constexpr double kTick_s = 1e-3;

touch::ContactSettings settings_of(double stiffness_N_m, double friction = 0) {
  touch::ContactSettings settings;
  settings.stiffness_N_m = stiffness_N_m;
  settings.friction = friction;
  return settings;
}

/// Moves straight to `to_m`; the last force.
Eigen::Vector3d go(touch::ContactForce& force, const touch::MovingRelief& surface,
                   const touch::ContactSettings& settings, const Eigen::Vector3d& from_m,
                   const Eigen::Vector3d& to_m, int ticks) {
  Eigen::Vector3d last_N = Eigen::Vector3d::Zero();
  for (int n = 1; n <= ticks; ++n) {
    last_N = force.tick(surface, nullptr, settings, from_m + (to_m - from_m) * n / ticks, kTick_s);
  }
  return last_N;
}

TEST(ContactForce, NeverPullsInAndIsNoneBelowTheSurfaceOnly) {
  // Pushes of 1 m/s, a surface that moves to another one every 33 ticks, now and then without a
  // pose.
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::vector<TouchScene> scenes = touch_scenes();
  touch::ContactForce force;
  const touch::ContactSettings settings = settings_of(800, 0.4);
  Eigen::Vector3d grip_m(0, 0, 0.003);
  Eigen::Vector3d velocity_m_s(0, 0, 0);
  touch::MovingRelief surface{&scenes[0].relief};
  int pushed = 0;
  for (int n = 0; n < 100000; ++n) {
    if (n % 33 == 0) {
      surface.before = surface.after != nullptr ? surface.after : surface.before;
      surface.after = &scenes[random() % scenes.size()].relief;
      surface.displacement_m = 0.002 * Eigen::Vector2d(uniform(random), uniform(random));
    }
    surface.fraction = n % 33 / 33.0;
    if (n % 50 == 0) velocity_m_s = {uniform(random), uniform(random), uniform(random)};
    grip_m += kTick_s * velocity_m_s;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(grip_m[axis]) > 0.012) velocity_m_s[axis] = -std::copysign(1, grip_m[axis]);
    }
    if (n % 977 == 0) force.reset();
    const Eigen::Vector3d wanted_N = force.tick(surface, nullptr, settings, grip_m, kTick_s);
    ASSERT_TRUE(wanted_N.allFinite());
    const touch::Proxy& proxy = force.proxy();
    if (!proxy.touching()) {
      ASSERT_EQ(wanted_N.norm(), 0) << n;
      ASSERT_GE(grip_m.z(), surface.at(grip_m.head<2>()).z_m + proxy.shift_m()) << n;
    }
    // Rounding of forces of some newtons.
    ASSERT_GE(wanted_N.dot(proxy.normal()), -1e-12) << n;
    pushed += wanted_N.norm() > 0.1;
  }
  EXPECT_GT(pushed, 10000);
}

TEST(ContactForce, OfAMovingPlaneChangesAsFastAsItMoves) {
  // ±4 mm at 0.5 Hz, 30 frames a second, the grip still at −5 mm.
  constexpr int kFrame_ticks = 33;
  std::vector<touch::HeightField> frames;
  for (int f = 0; f < 62; ++f) {
    frames.push_back(plane_field(0.004 * std::sin(M_PI * f * kFrame_ticks * kTick_s)));
  }
  touch::ContactForce force;
  const touch::ContactSettings settings = settings_of(500);
  double last_N = 0;
  double fastest_N_s = 0;
  for (int n = 0; n < 2000; ++n) {
    const auto f = static_cast<size_t>(n / kFrame_ticks);
    const touch::MovingRelief moving{&frames[f], &frames[f + 1],
                                     static_cast<double>(n % kFrame_ticks) / kFrame_ticks};
    const double now_N = force.tick(moving, nullptr, settings, {0, 0, -0.005}, kTick_s).z();
    // Half a second to come up from the grip, where it starts.
    if (n > 500) fastest_N_s = std::max(fastest_N_s, std::abs(now_N - last_N) / kTick_s);
    last_N = now_N;
  }
  const double expected_N_s = 500 * 0.004 * M_PI;  // K v
  EXPECT_LE(fastest_N_s, 2 * expected_N_s);
  EXPECT_GT(fastest_N_s, 0.9 * expected_N_s) << "it is felt at all";
}

TEST(ContactForce, OfTextureIsItsSlopeTimesWhatPresses) {
  constexpr double kWave_m = 0.004;
  constexpr double kSlope = 0.1;
  const touch::HeightField plane = plane_field(0);
  const touch::HeightField stripes = sampled_field([](double x_m, double) {
    return kSlope * kWave_m / (2 * M_PI) * std::sin(2 * M_PI * x_m / kWave_m);
  });
  for (const double x_m : {0.0, 0.0005, 0.0017, 0.0031}) {
    touch::ContactForce force;
    const touch::ContactSettings settings = settings_of(500);
    const Eigen::Vector3d inside_m(x_m, 0, -0.001);
    go(force, {&plane}, settings, {x_m, 0, 0.001}, inside_m, 100);
    Eigen::Vector3d at_rest_N;
    for (int n = 0; n < 100; ++n)
      at_rest_N = force.tick({&plane}, &stripes, settings, inside_m, kTick_s);
    // A spline takes (cell · 2π / wave)² / 6 = 2 % off waves of 17 cells.
    const double slope = kSlope * std::cos(2 * M_PI * x_m / kWave_m);
    EXPECT_NEAR(at_rest_N.x(), -0.5 * slope, 0.5 * kSlope * 0.025) << x_m;
  }
}

TEST(ContactForce, OfTextureIsBounded) {
  const touch::HeightField plane = plane_field(0);
  const touch::HeightField steep = sampled_field([](double x_m, double) { return 3 * x_m; });
  touch::ContactForce force;
  const touch::ContactSettings settings = settings_of(500);
  Eigen::Vector3d last_N;
  for (int n = 0; n < 300; ++n) {
    last_N =
        force.tick({&plane}, &steep, settings, {0, 0, std::max(-0.004, 0.001 - 1e-4 * n)}, kTick_s);
  }
  EXPECT_NEAR(last_N.x(),
              -touch::ContactForce::kMaxTextureSlope * touch::ContactForce::kMaxTexture_N, 1e-6);
  EXPECT_NEAR(last_N.z(), 2, 1e-6) << "what presses stays";
}

TEST(ContactForce, SaysWhichSettingIsWrong) {
  EXPECT_NO_THROW(validate(touch::ContactSettings()));
  const auto message = [](auto&& change) {
    touch::ContactSettings settings;
    change(settings);
    try {
      validate(settings);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message([](auto& s) { s.stiffness_N_m = 900; }).find("stiffness_N_m"),
            std::string::npos);
  EXPECT_NE(message([](auto& s) { s.stiffness_N_m = std::nan(""); }).find("stiffness_N_m"),
            std::string::npos);
  EXPECT_NE(message([](auto& s) { s.delay_s = -1; }).find("delay_s"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.damping = 0.9; }).find("damping"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.lateral_damping = 0.4; }).find("lateral_damping"),
            std::string::npos);
  EXPECT_NE(message([](auto& s) { s.friction = -1; }).find("friction"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.texture = -1; }).find("texture"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.max_force_N = 0; }).find("max_force_N"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.max_slew_N_s = 0; }).find("max_slew_N_s"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.least_mass_kg = 0; }).find("least_mass_kg"), std::string::npos);
}

}  // namespace
}  // namespace spidar::test::contact_force_test
