// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What a debug window shows of a picture that is touched, and what the mouse does there.
#include "core/touch/height_field.h"
#include "spidar/profiles/profile.h"
#include "tests/support/test.h"
#include "tests/window/fake_source.h"
#include "tests/window/window_fixture.h"

namespace spidar::test::window_touched_test {
namespace {

/// A simulated SPIDAR-GCC whose grip presses on the surface in the left upper quarter; the proxy is
/// in the right one.
window::ElementState touching_state() {
  window::ElementState state;
  state.device.emplace();
  DeviceView& device = *state.device;
  device.name = "sim";
  device.has_hand = true;
  device.geometry = load_profile("spidar-gcc").geometry;
  TickRecord& last = device.last;
  last.device = DeviceState::kRunning;
  last.pose.position_m = {-0.0295 / 2, 0.032 / 2, -0.002};
  last.contact.touching = last.contact.has_surface = true;
  last.contact.proxy_m = {0.0295 / 2, 0.032 / 2, 0};
  last.contact.force_N = {0, -3, 3};
  return state;
}

DrawnFrame touched_facts(const StringGeometry& geometry) {
  DrawnFrame report;
  report.touch.on = true;
  report.touch.pointer = GripPointer(geometry);
  return report;
}

/// The shadow is in the left upper quarter of what a viewer sees.
TEST_F(WindowTest, TheReliefIsShadedAsThePictureIsShown) {
  const window::ElementState state = touching_state();
  for (const int quarters : {0, 1}) {
    window::Window window(std::make_shared<FakeSource>(state));
    DrawnFrame report = touched_facts(state.device->geometry);
    report.turn = Orientation(quarters, true);
    report.touch.shading.assign(touch::HeightField::kCells, '\x80');
    for (int y = 0; y < touch::HeightField::kRows / 2; ++y) {
      report.touch.shading.replace(static_cast<size_t>(y) * touch::HeightField::kColumns,
                                   touch::HeightField::kColumns / 2,
                                   touch::HeightField::kColumns / 2, '\0');
    }
    give(window, report, 128);
    const Screenshot shot = look(window);
    const window::PictureMap map = map_of(shot);
    int dark = 0;
    for (const double x : {0.1, 0.9}) {
      for (const double y : {0.1, 0.9}) {
        const Eigen::Vector2d p = map({320 * x, 240 * y});
        const Color color = at(shot, p.x(), p.y());
        EXPECT_TRUE(is_grey(color)) << shown(color);
        const Eigen::Vector2d seen = report.turn.displayed_position({x, y});
        const bool in_shadow = seen.x() < 0.5 && seen.y() < 0.5;
        EXPECT_EQ(color.r < 128 / 2, in_shadow) << quarters << ": " << x << ", " << y;
        EXPECT_EQ(color.r > 128 - 5, !in_shadow) << quarters << ": " << x << ", " << y;
        dark += in_shadow;
      }
    }
    EXPECT_EQ(dark, 1);
  }
}

TEST_F(WindowTest, TheMouseLeadsTheHandOfASimulatedDevice) {
  auto source = std::make_shared<FakeSource>(touching_state());
  window::Mouse mouse;
  {
    window::Window window(source);
    give(window, {});
    const window::Rect picture = map_of(look(window)).shown;
    mouse.at_px = {picture.x + 0.75 * picture.width, picture.y + 0.25 * picture.height};
    mouse.down = true;
    set_mouse(window, mouse);
    FakeSource::Led led = source->wait_for_led(1);
    ASSERT_TRUE(led[0].has_value());
    EXPECT_LT((*led[0] - Eigen::Vector3d(0.0295 / 2, 0.032 / 2, 0)).norm(), 1e-12);
    mouse.down = false;
    set_mouse(window, mouse);
    led = source->wait_for_led(2);
    EXPECT_FALSE(led[1].has_value());
    mouse.down = true;
    set_mouse(window, mouse);
    EXPECT_TRUE(source->wait_for_led(3)[2].has_value());
  }
  const FakeSource::Led led = source->wait_for_led(4);
  EXPECT_FALSE(led[3].has_value()) << "the window was closed";
}

}  // namespace
}  // namespace spidar::test::window_touched_test
