// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Drivers of force-feedback devices that fail, hang or report nonsense, and forces that no device
/// can give: on emulated input devices, through the same calls as real ones.
#include <cerrno>

#include "spidar/devices/force_feedback/board.h"
#include "spidar/devices/force_feedback/evdev_transport.h"
#include "spidar/link/force_grip.h"
#include "spidar/session/haptic_session.h"
#include "tests/spidar/bus_test.h"
#include "tests/support/felt_player.h"
#include "tests/support/pushed_grip.h"
#include "tests/support/test.h"

namespace spidar::test::evdev_faults_test {
namespace {

class EvdevFaults : public BusTest {
 protected:
  std::unique_ptr<boards::ForceBoard> board(boards::StickEffects::Updates updates) const {
    return std::make_unique<boards::ForceFeedback>(
        "ff", profile, std::make_unique<EvdevTransport>("ff", ""), updates);
  }

  /// Without any thread: it communicates with the driver once in kUpdate_ms exchanges.
  std::unique_ptr<boards::ForceLink> stepped() const {
    return std::make_unique<boards::ForceLink>(board(boards::StickEffects::Updates::kInCycle),
                                               unguarded());
  }

  const Profile profile = load_profile(kDefaultProfile);
  boards::ForceReading reading;
};

/// Exchanges until every effect could be set once, and returns the worst status.
LinkFault exchange(boards::ForceLink& device, const boards::ForceOutput& output,
                   boards::ForceReading& reading, int updates = 2) {
  LinkFault worst = LinkFault::kNone;
  for (int i = 0; i < updates * boards::ForceFeedback::kUpdate_ms; ++i) {
    const LinkFault status = device.exchange(output, reading);
    if (status != LinkFault::kNone) worst = status;
  }
  return worst;
}

TEST_F(EvdevFaults, EveryErrorIsNamedCountedAndForgotten) {
  struct Case {
    std::atomic<int> EvdevPort::*call;
    int error;
    LinkFault fault = LinkFault::kNone;  // kNone: any but those of the other cases
  };
  constexpr auto kUpload = &EvdevPort::upload_error;
  constexpr auto kQuery = &EvdevPort::query_error;
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  const auto device = stepped();
  device->open();
  const auto faults = [&] {
    return device->health().errors() + device->health().count(LinkFault::kTimeout);
  };
  double right_N = 0;
  for (const Case& c : {Case{kUpload, EIO, LinkFault::kBusError},
                        {kUpload, EINVAL},
                        {kUpload, ENOSPC},
                        {kUpload, ETIMEDOUT, LinkFault::kTimeout},
                        {kUpload, ENODEV, LinkFault::kGone},
                        {kQuery, EIO, LinkFault::kBusError},
                        {kQuery, EINVAL},
                        {kQuery, ETIMEDOUT, LinkFault::kTimeout},
                        {kQuery, ENODEV, LinkFault::kGone}}) {
    SCOPED_TRACE(std::string(c.call == kUpload ? "upload: " : "position: ") +
                 std::strerror(c.error));
    ASSERT_EQ(exchange(*device, pushing(right_N), reading), LinkFault::kNone);
    const EvdevLevels before = evdev_levels(0);
    const uint64_t count = faults();
    const uint64_t uploads = port.uploads;
    right_N += 0.1;  // so that there is something to upload
    port.*c.call = c.error;
    const LinkFault fault = exchange(*device, pushing(right_N), reading, 1);
    EXPECT_EQ(faults(), count + 1);
    EXPECT_EQ(device->health().last_fault, fault);
    if (c.fault != LinkFault::kNone)
      EXPECT_EQ(fault, c.fault);
    else
      EXPECT_TRUE(fault != LinkFault::kBusError && fault != LinkFault::kTimeout &&
                  fault != LinkFault::kGone && fault != LinkFault::kNone)
          << to_string(fault);
    EXPECT_EQ(port.uploads, uploads);
    EXPECT_EQ(evdev_levels(0).right, before.right);
    port.*c.call = 0;
    if (fault == LinkFault::kGone) {
      device->close();
      EXPECT_TRUE(evdev_levels(0).at_rest());
      device->open();
    }
    EXPECT_EQ(exchange(*device, pushing(right_N), reading), LinkFault::kNone);
    EXPECT_GT(evdev_levels(0).right, before.right);
    EXPECT_EQ(faults(), count + 1);
  }
}

TEST_F(EvdevFaults, ForcesBeyondFullLevelAreCutAndKeepTheirDirection) {
  plug_evdev(0, EvdevKind::kStick);
  const auto device = stepped();
  device->open();
  ASSERT_EQ(exchange(*device, pushing(1e9), reading), LinkFault::kNone);
  EXPECT_EQ(evdev_levels(0).right, ff::kFullLevel);
  EXPECT_EQ(evdev_levels(0).up, 0);
  // To the right and less upwards, within the range and far beyond it.
  ASSERT_EQ(exchange(*device, pushing(0.2, 0.1), reading), LinkFault::kNone);
  const EvdevLevels within = evdev_levels(0);
  ASSERT_GT(within.right, within.up);
  ASSERT_GT(within.up, 0);
  ASSERT_LT(within.right, ff::kFullLevel);
  ASSERT_EQ(exchange(*device, pushing(2e8, 1e8), reading), LinkFault::kNone);
  EXPECT_EQ(evdev_levels(0).right, ff::kFullLevel);
  // All three levels are rounded by half a step.
  const double scale = 1.0 * ff::kFullLevel / within.right;
  EXPECT_NEAR(evdev_levels(0).up, scale * within.up, 0.5 + scale);
  ASSERT_EQ(exchange(*device, pushing(-1e9), reading), LinkFault::kNone);
  EXPECT_EQ(evdev_levels(0).right, -ff::kFullLevel);
}

TEST_F(EvdevFaults, APositionBeyondItsAxisIsTheEndOfTheAxis) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  const auto device = stepped();
  device->open();
  const auto position_at = [&](int right, int down) {
    port.axis[0] = right;
    port.axis[1] = down;
    EXPECT_EQ(exchange(*device, {}, reading, 50), LinkFault::kNone);
    return reading.position_m;
  };
  // Each of the 50 updates leaves a sixth of the way.
  const auto is_at = [&](int right, int down, const Eigen::Vector3d& there_m) {
    EXPECT_LT((position_at(right, down) - there_m).norm(), 1e-9) << right << ", " << down;
  };
  const Eigen::Vector3d corner(0.5 * 0.059, 0.5 * 0.064, 0);
  is_at(0, 0, Eigen::Vector3d::Zero());
  is_at(1000, -1000, corner);
  is_at(32767, -32768, corner);
  is_at(1001, std::numeric_limits<int>::min(), corner);
  // An axis whose ends are the same is at rest.
  port.axis_end = 0;
  is_at(1000, -1000, Eigen::Vector3d::Zero());
}

TEST_F(EvdevFaults, AfterItFailedToOpenNothingIsLeftAndItOpensAgain) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  const auto device = stepped();
  const auto refuses = [&](const char* what) {
    EXPECT_EQ(opening(*device).find("ff: \"Emulated Stick\" does not take an effect: "), 0u)
        << what;
    EXPECT_TRUE(evdev_levels(0).at_rest());
    for (const EvdevPort::Effect& effect : port.effect) EXPECT_FALSE(effect.used) << what;
  };
  for (const int error : {EIO, EINVAL, ENOSPC, ENODEV}) {
    port.upload_error = error;
    refuses("upload");
    port.upload_error = 0;
    port.event_error = error;
    refuses("play");
    port.event_error = 0;
  }
  port.cuts_events = true;
  refuses("half of an event");
  port.cuts_events = false;
  device->open();
  EXPECT_EQ(exchange(*device, pushing(1), reading), LinkFault::kNone);
  EXPECT_GT(evdev_levels(0).right, 0);
}

/// A driver that takes no more levels must not keep the last one.
TEST_F(EvdevFaults, ADriverThatFailsComesToRest) {
  for (const auto call : {&EvdevPort::upload_error, &EvdevPort::query_error}) {
    for (const int error : {EIO, ENODEV}) {
      SCOPED_TRACE(std::string(call == &EvdevPort::upload_error ? "upload: " : "position: ") +
                   std::strerror(error));
      EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
      const FeltPlayer player;
      player.push(1, 0);
      wait_for([] { return is_level(evdev_levels(0).right, 1, 1); });
      port.*call = error;
      player.loop().cancel_scheduled();
      ASSERT_TRUE(player.loop().schedule(lasting({0, 1, 0})));
      wait_for([&] { return player.now().last.device == DeviceState::kLost; });
      wait_for([] { return evdev_levels(0).at_rest(); });
      port.*call = 0;
      wait_for([] { return is_level(evdev_levels(0).up, 1, 1) && evdev_levels(0).right == 0; });
    }
  }
}

/// With the board's own thread, as in make_grip(), and ticks by hand: if a tick waited for the
/// driver, it would never end.
TEST_F(EvdevFaults, NoTickWaitsForADriverThatHangs) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  HapticSession session(std::make_unique<boards::ForceGrip>(std::make_unique<boards::ForceLink>(
                            board(boards::StickEffects::Updates::kOwnThread), unguarded())),
                        by_hand());
  int64_t now_ns = 0;
  const auto tick = [&] {
    now_ns += kTick_ns;
    session.loop().tick(now_ns, now_ns);
    return session.loop().snapshot().last;
  };
  session.loop().set_playback_clock({0, 0, 1.0, true});
  while (tick().device != DeviceState::kRunning) {
  }
  port.hangs = true;
  ASSERT_TRUE(session.loop().schedule(lasting({1, 0, 0})));
  while (tick().commanded.force_N.x() != 1) {
  }
  wait_for([&] { return port.hanging == 1; });
  const uint64_t uploads = port.uploads;
  for (int ms = 0; ms < 1000; ++ms) tick();
  EXPECT_EQ(port.hanging, 1);
  EXPECT_EQ(port.uploads, uploads);
  port.hangs = false;
}

}  // namespace
}  // namespace spidar::test::evdev_faults_test
