// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// device=ff through a real kernel's evdev, on devices made by uinput. Waits for events; times are
/// those of the virtual machine, which counts instructions.
#include <csignal>

#include "spidar/devices/force_feedback/board.h"
#include "spidar/devices/force_feedback/stick_effects.h"
#include "spidar/session/board_list.h"
#include "tests/kernel/uinput_device.h"
#include "tests/support/child_process.h"
#include "tests/support/felt_player.h"
#include "tests/support/test.h"

namespace spidar::test::kernel_evdev_test {
namespace {

constexpr int64_t kMs = kSecond_ns / 1000;

TEST(KernelEvdev, RightIsRightAndUpIsUp) {
  UinputDevice stick(UinputKind::kStick);
  const FeltPlayer player(listed());
  EXPECT_EQ(player.session->grip().description(),
            "uinput device at 20 % of its strength, force feedback on two axes");
  wait_for([&] { return stick.gain == 13107 && stick.autocentre == 0; });
  for (const auto& [x_N, y_N] :
       {std::pair{1.5, 0.0}, {-0.7, 0.0}, {0.0, 2.0}, {0.0, -0.2}, {1.0, -1.2}, {0.0, 0.0}}) {
    player.push(x_N, y_N);
    wait_for([&, x = x_N, y = y_N] {
      const double size_N = std::hypot(x, y);
      return is_level(stick.right(), x, size_N) && is_level(stick.up(), y, size_N);
    });
  }
  stick.move(1000, 500);
  wait_for([&] {
    return (player.now().last.pose.position_m - Eigen::Vector3d(0.0295, -0.016, 0)).norm() < 1e-4;
  });
}

TEST(KernelEvdev, WheelsAndPadsGetTheEffectsThatTheySupport) {
  {
    UinputDevice wheel(UinputKind::kWheel, "uinput wheel");
    const FeltPlayer player(listed("uinput wheel"));
    player.push(-1, 1);
    // It has no gain to set, so the levels are smaller.
    constexpr double kForce_N = boards::StickEffects::kDefaultGain;
    wait_for([&] { return is_level(wheel.right(), -kForce_N, kForce_N) && wheel.up() == 0; });
  }
  UinputDevice pad(UinputKind::kPad, "uinput pad");
  const FeltPlayer player(listed("uinput pad"));
  player.push(-0.9, 1.2);
  // Half of full; 1 % of it.
  wait_for([&] {
    return std::abs(pad.rumble() - 0.5 * ff::kFullStrength) <= 0.005 * ff::kFullStrength;
  });
  EXPECT_EQ(pad.right(), 0);
}

TEST(KernelEvdev, UpdatesAreFewAndAPauseIsAtZeroWithin60Ms) {
  UinputDevice stick(UinputKind::kStick);
  const FeltPlayer player(listed());
  const int before = stick.uploads;
  const int64_t begin_ns = monotonic_now_ns();
  for (int i = 1; i <= 200; ++i) {
    while (!player.loop().schedule(
        lasting({std::sin(0.1 * i), std::cos(0.1 * i), 0}, kSecond_ns + i * 5 * kMs)))
      sleep_until_ns(monotonic_now_ns() + 5 * kMs);
  }
  sleep_until_ns(begin_ns + kSecond_ns);
  const int uploads = stick.uploads - before;
  const double passed_s = 1e-9 * static_cast<double>(monotonic_now_ns() - begin_ns);
  // As many as fit into that time, and the one at its end.
  EXPECT_LE(uploads, passed_s * 1000 / boards::ForceFeedback::kUpdate_ms + 1);
  EXPECT_GT(uploads, 50);
  EXPECT_EQ(stick.unchanged, 0);

  player.push(1, -1);
  wait_for([&] { return is_level(stick.right(), 1, 1) && is_level(stick.up(), -1, 1); });
  const int64_t paused_ns = monotonic_now_ns();
  player.pause();
  wait_for([&] { return stick.at_rest(); });
  const int64_t rest_ns = monotonic_now_ns();
  EXPECT_LE(rest_ns - paused_ns, 60 * kMs);
  std::printf("%d uploads in %.2f s; at zero %.1f ms after the pause\n", uploads, passed_s,
              1e-6 * static_cast<double>(rest_ns - paused_ns));
}

TEST(KernelEvdev, TheKernelErasesTheEffectsOfAKilledProcess) {
  UinputDevice stick(UinputKind::kStick);
  listed();
  for (const int signal : {SIGKILL, SIGSTOP}) {
    ChildProcess host({"/proc/self/exe", "--push", kDefaultProfile});
    wait_for([&] { return !stick.at_rest() || !host.lives(); });
    ASSERT_TRUE(host.lives());
    host.send(signal);
    wait_for([&] { return stick.at_rest(); });
    host.end(SIGKILL);
    wait_for([&] { return !stick.has_effects(); });
  }
}

TEST(KernelEvdev, IsTakenBackWhenItIsPluggedInAgain) {
  auto stick = std::make_unique<UinputDevice>(UinputKind::kStick);
  listed();
  const FeltPlayer player("ff");
  player.push(1, 0);
  wait_for([&] { return is_level(stick->right(), 1, 1); });
  stick.reset();
  wait_for([&] { return player.now().last.device == DeviceState::kLost; });
  stick = std::make_unique<UinputDevice>(UinputKind::kStick);
  wait_for([&] { return is_level(stick->right(), 1, 1); });
}

TEST(KernelEvdev, ASlowDeviceDelaysNothing) {
  UinputDevice stick(UinputKind::kStick);
  const FeltPlayer player(listed());
  stick.upload_ms = 50;
  player.push(1, -1);
  wait_for([&] { return is_level(stick.right(), 1, 1) && is_level(stick.up(), -1, 1); });
  EXPECT_EQ(player.session->grip().health().errors(), 0u);
  EXPECT_EQ(player.now().counters.times_lost, 0u);
}

}  // namespace
}  // namespace spidar::test::kernel_evdev_test
