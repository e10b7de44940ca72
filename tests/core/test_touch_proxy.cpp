// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/proxy.h"
#include "tests/support/test.h"
#include "tests/support/touch_surfaces.h"

namespace spidar::test::touch_proxy_test {
namespace {

constexpr double kTick_s = 1e-3;

/// Moves straight to `to_m` in so many ticks.
void go(touch::Proxy& proxy, const touch::MovingRelief& surface, double friction,
        Eigen::Vector3d from_m, const Eigen::Vector3d& to_m, int ticks) {
  for (int n = 1; n <= ticks; ++n) {
    proxy.move(surface, friction, from_m + (to_m - from_m) * n / ticks, kTick_s);
  }
}

TEST(TouchProxy, IsTheNearestPointOfASphere) {
  constexpr double kRadius_m = 0.02;
  const touch::HeightField sphere = sphere_field(0, 0, kRadius_m, 0);
  const Eigen::Vector3d centre_m(0, 0, -kRadius_m);
  for (double degrees = 0; degrees < 360; degrees += 17) {
    const double a = degrees * M_PI / 180;
    const Eigen::Vector3d out =
        Eigen::Vector3d(0.5 * std::cos(a), 0.5 * std::sin(a), std::sqrt(0.75));
    touch::Proxy proxy;
    // From above, 2 mm deep, where it then stays.
    const Eigen::Vector3d end_m = centre_m + (kRadius_m - 0.002) * out;
    go(proxy, {&sphere}, 0, end_m + Eigen::Vector3d(0, 0, 0.006), end_m, 100);
    go(proxy, {&sphere}, 0, end_m, end_m, 50);
    ASSERT_TRUE(proxy.touching());
    const Eigen::Vector3d force = (proxy.position_m() - end_m).normalized();
    EXPECT_LT(std::acos(std::min(1.0, force.dot(out))) * 180 / M_PI, 0.1) << degrees;
  }
}

TEST(TouchProxy, SticksAndSlides) {
  const touch::HeightField plane = plane_field(0);
  constexpr double friction = 0.5;
  constexpr double kDepth_m = 0.002;
  touch::Proxy proxy;
  go(proxy, {&plane}, friction, {0, 0, 0.001}, {0, 0, -kDepth_m}, 100);
  // Still held at 0.49 of the depth, not any more at 0.51; then it stays 0.4 behind.
  go(proxy, {&plane}, friction, {0, 0, -kDepth_m}, {0.49 * kDepth_m, 0, -kDepth_m}, 50);
  EXPECT_NEAR(proxy.position_m().x(), 0, 1e-12);
  EXPECT_FALSE(proxy.sliding());
  go(proxy, {&plane}, friction, {0.49 * kDepth_m, 0, -kDepth_m}, {0.51 * kDepth_m, 0, -kDepth_m},
     2);
  EXPECT_TRUE(proxy.sliding());
  go(proxy, {&plane}, friction, {0.51 * kDepth_m, 0, -kDepth_m}, {0.01, 0, -kDepth_m}, 200);
  // The plane's heights are exact; steps shorter than 1 nm are not taken.
  EXPECT_NEAR(0.01 - proxy.position_m().x(), touch::Proxy::kKineticFriction * friction * kDepth_m,
              1e-9);
  // Turned round: it sticks until the force is the other way.
  const double held_at_m = proxy.position_m().x();
  go(proxy, {&plane}, friction, {0.01, 0, -kDepth_m}, {held_at_m - 0.49 * kDepth_m, 0, -kDepth_m},
     100);
  EXPECT_NEAR(proxy.position_m().x(), held_at_m, 1e-9);
}

TEST(TouchProxy, ItsOwnMoveNeverMakesTheSpringLonger) {
  // On creases: a picture with noise whose slopes are at the limit, and a hand that goes anywhere.
  for (const TouchScene& scene : touch_scenes()) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    touch::Proxy proxy;
    Eigen::Vector3d grip_m(0, 0, 0.003);
    int touched = 0;
    for (int n = 0; n < 20000; ++n) {
      Eigen::Vector3d way_m(uniform(random), uniform(random), uniform(random));
      grip_m += 5e-4 * way_m - 0.02 * (grip_m - Eigen::Vector3d(0, 0, -0.004));
      const bool was_touching = proxy.touching();
      const double before_m = (proxy.position_m() - grip_m).norm();
      proxy.move({&scene.relief}, 0.3, grip_m, kTick_s);
      // The surface stands still and is not shifted: all that moves the proxy is its walk.
      if (was_touching && proxy.touching() && proxy.shift_m() == 0) {
        ++touched;
        // 1e-12: rounding of the height at the same position, carried from the tick before.
        ASSERT_LE((proxy.position_m() - grip_m).norm(), before_m + 1e-12) << scene.name;
      }
    }
    EXPECT_GT(touched, 1000) << scene.name;
  }
}

TEST(TouchProxy, StartingInsideTheSurfaceComesUpSlowly) {
  const touch::HeightField plane = plane_field(0);
  touch::Proxy proxy;
  const Eigen::Vector3d inside_m(0, 0, -0.005);
  proxy.move({&plane}, 0, inside_m, kTick_s);
  ASSERT_TRUE(proxy.touching());
  EXPECT_LE(proxy.position_m().z() - inside_m.z(), touch::Proxy::kFastest_m_s * kTick_s + 1e-12);
  double last_m = proxy.position_m().z();
  int ticks = 0;
  for (; ticks < 1000 && proxy.position_m().z() < -1e-9; ++ticks) {
    proxy.move({&plane}, 0, inside_m, kTick_s);
    ASSERT_LE(proxy.position_m().z() - last_m, touch::Proxy::kRise_m_s * kTick_s + 1e-12);
    last_m = proxy.position_m().z();
  }
  // What is left of 5 mm after the first tick.
  const double left_m = 0.005 - touch::Proxy::kFastest_m_s * kTick_s;
  // Half of the speed on the way there.
  const double late_s = touch::Proxy::kRise_m_s / (2 * touch::Proxy::kRise_m_s2);
  EXPECT_NEAR(ticks, (left_m / touch::Proxy::kRise_m_s + late_s) / kTick_s, 1);
}

TEST(TouchProxy, AGripThatIsPushedInFastIsNotTakenForACut) {
  // 1 m/s onto the steepest flank, sideways too: all of the depth is its own way.
  const touch::HeightField slope = sampled_field([](double x_m, double) { return 1.4 * x_m; });
  touch::Proxy proxy;
  go(proxy, {&slope}, 0, {-0.006, 0, 0.004}, {0.004, 0, -0.004}, 12);
  EXPECT_TRUE(proxy.touching());
  EXPECT_EQ(proxy.shift_m(), 0);
}

TEST(TouchProxy, AGripThatIsNotANumberTouchesNothing) {
  const touch::HeightField plane = plane_field(0);
  touch::Proxy proxy;
  go(proxy, {&plane}, 0, {0, 0, 0.001}, {0, 0, -0.001}, 20);
  ASSERT_TRUE(proxy.touching());
  proxy.move({&plane}, 0, {0, std::numeric_limits<double>::quiet_NaN(), 0}, kTick_s);
  EXPECT_FALSE(proxy.touching());
}

}  // namespace
}  // namespace spidar::test::touch_proxy_test
