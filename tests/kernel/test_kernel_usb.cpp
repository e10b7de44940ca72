// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The driver and an emulated board, connected through a real kernel's USB. Waits for events, never
/// for a fixed time.
#include <csignal>
#include <unistd.h>

#include "spidar/chain/tension_command.h"
#include "spidar/devices/cyverse/board.h"
#include "spidar/guardian/guardian.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "tests/kernel/usbip_board.h"
#include "tests/support/child_process.h"
#include "tests/support/recorded_motors.h"
#include "tests/support/test.h"

namespace spidar::test::kernel_usb_test {
namespace {

constexpr const char* kProfile = "spidar-g6x3-v2-r";
constexpr int kExchanges = 5000;

/// Waits without a limit; the test has one.
void wait_for(const std::function<bool()>& happened) {
  while (!happened()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

bool listed() {
  for (const DeviceInfo& board : list_boards())
    if (board.serial == "EMULATED") return true;
  return false;
}

/// A board in the machine's USB.
class KernelUsb : public testing::Test {
 protected:
  void SetUp() override {
    bench.inputs = 3 << 4;  // rotary switch
    plug();
  }
  void TearDown() override {
    board.unplug();
    wait_for([] { return !listed(); });
  }
  void plug() {
    board.plug();
    wait_for(listed);
  }

  MotorBench bench;
  UsbipBoard board{std::make_shared<RecordedMotors>(bench), "EMULATED"};
  const Profile profile = load_profile(kProfile);
};

TEST_F(KernelUsb, BoardIsFoundByWhatTheKernelReadsFromIt) {
  const auto device = make_device("usb:EMULATED", profile);
  device->open();
  EXPECT_NE(device->description().find("SH4, rotary switch 3"), std::string::npos)
      << device->description();
  device->close();
  EXPECT_NO_THROW(make_device("usb:3", profile)->open());
  EXPECT_THROW(make_device("usb:4", profile)->open(), DeviceError);
}

TEST_F(KernelUsb, ThousandsOfExchangesCarryVoltsAndCounts) {
  boards::Settings settings;
  settings.threaded = false;
  const auto device = make_device("usb", profile, settings);
  device->open();
  const boards::DacScale dac = boards::Sh4::kTraits.dac(profile);
  MotorVolts volts;
  DeviceReading reading;
  for (int done = 0; done < kExchanges; ++done) {
    const auto string = static_cast<size_t>(done) % kMaxStrings;
    volts.volt[string] = 0.001 * (done % 1000);
    bench.count[string] += 7;
    ASSERT_EQ(device->exchange(volts, reading), LinkFault::kNone) << "exchange " << done;
    for (size_t i = 0; i < kMaxStrings; ++i) {
      ASSERT_EQ(bench.digit[i], dac.digit(volts.volt[i])) << "exchange " << done;
      ASSERT_EQ(reading.count[i], bench.count[i]) << "exchange " << done;
    }
  }
  const LinkHealth health = device->health();
  EXPECT_EQ(health.errors() + health.count(LinkFault::kTimeout), 0u);
  device->close();
  EXPECT_TRUE(bench.all_zero());
}

/// Its FTDI chip takes requests on the control pipe, and answers come in several packets.
TEST(KernelFalcon, TakesItsFirmwareAndExchanges) {
  const std::string firmware = "/tmp/firmware.bin";
  std::ofstream(firmware) << std::string(8492, 'x');
  setenv("SPIDAR_FALCON_FIRMWARE", firmware.c_str(), 1);
  MotorBench bench;
  bench.inputs = 0x70;  // homed
  UsbipBoard board{std::make_shared<RecordedMotors>(bench), "EMULATED", "falcon"};
  board.plug();
  wait_for(listed);
  boards::Settings settings;
  settings.threaded = false;
  const auto grip = make_grip("falcon:EMULATED", load_profile(kDefaultProfile), settings);
  grip->open();
  GripCommand command;
  command.power = 1;
  command.wrench.force_N.x() = 1;
  for (int done = 0; done < 1000; ++done) {
    bench.count[1] = 20 * done;
    ASSERT_EQ(grip->exchange(command), LinkFault::kNone) << "exchange " << done;
    // Half a count of each encoder, at some 60 mm/rad.
    ASSERT_NEAR(grip->reading().pose.position_m.y(), 2e-5 * done, 5e-5) << "exchange " << done;
  }
  EXPECT_FALSE(bench.all_zero());
  grip->close();
  EXPECT_TRUE(bench.all_zero());
  board.unplug();
  wait_for([] { return !listed(); });
}

/// A session that plays the constant force of a film.
class KernelSession : public KernelUsb {
 protected:
  /// From now on, for ever.
  void play(HapticSession& session, double force_x_N) {
    PlaybackClock clock;
    clock.monotonic_ns = HapticSession::monotonic_now_ns();
    clock.playing = true;
    session.loop().cancel_scheduled();
    session.loop().set_playback_clock(clock);
    TimedWrench wrench;
    wrench.hold_ns = INT64_MAX / 4;
    wrench.wrench.force_N.x() = force_x_N;
    ASSERT_TRUE(session.loop().schedule(wrench));
  }

  /// The force is commanded, and the board puts out the tensions that make it.
  bool pulls(const HapticSession& session, double force_x_N) const {
    const TickRecord last = session.loop().snapshot().last;
    if (last.device != DeviceState::kRunning ||
        std::abs(last.commanded.force_N.x() - force_x_N) > 1e-9)
      return false;
    const MotorVolts volts = to_volts(last.tension_N, profile);
    const boards::DacScale dac = boards::Sh4::kTraits.dac(profile);
    for (size_t i = 0; i < kMaxStrings; ++i)
      if (bench.digit[i] != dac.digit(volts.volt[i])) return false;
    // The grip is in the middle, where every force below the limit can be made; a solver's
    // rounding. It is added to that of the least tensions, which are those of rest.
    const Eigen::Matrix<double, 6, 1> rest =
        structure_matrix(profile.geometry, {}) * profile.min_tension_N();
    return std::abs(last.delivered.force_N.x() - rest[0] - force_x_N) < 0.01;
  }
};

TEST_F(KernelSession, ForcesOfAFilmReachTheMotors) {
  {
    HapticSession session(profile, make_device("usb", profile));
    for (const double force_N : {1.0, -1.0, 0.5}) {
      play(session, force_N);
      wait_for([&] { return pulls(session, force_N); });
    }
  }
  EXPECT_TRUE(bench.all_zero());
}

TEST_F(KernelSession, BoardPulledOutInMidTransferIsTakenBack) {
  HapticSession session(profile, make_device("usb", profile));
  play(session, 1);
  wait_for([&] { return pulls(session, 1); });
  for (int times = 1; times <= 3; ++times) {
    board.unplug_in_transfer();
    wait_for([&] { return session.loop().snapshot().last.device == DeviceState::kLost; });
    board.unplug();
    EXPECT_EQ(board.abandoned(), 1u);
    const LinkHealth health = session.grip().health();
    EXPECT_GE(health.count(LinkFault::kGone) + health.count(LinkFault::kBusError),
              static_cast<uint64_t>(times));
    plug();
    wait_for([&] { return pulls(session, 1); });
    EXPECT_GE(session.loop().snapshot().counters.times_lost, static_cast<uint64_t>(times));
  }
}

/// All guardians, of which there is one.
void signal_guardian(int signal) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::string name;
    if (std::ifstream(entry.path() / "comm") >> name && name == "spidar-guardian")
      kill(std::stoi(entry.path().filename()), signal);
  }
}

/// A process that pulls, to which something happens.
class KernelGuardian : public KernelUsb {
 protected:
  /// Three times: the motors are at zero in time after `happens` was applied to a victim.
  void expect_zeros_after(const char* what, const std::string& how,
                          const std::function<void(ChildProcess&)>& happens) {
    // Of the machine's own time, which is counted in instructions: kSilence_ms, and as much again
    // for the processes to be scheduled.
    constexpr int64_t kLongest_ms = 2 * kSilence_ms;
    for (int times = 0; times < 3; ++times) {
      ChildProcess victim({"/init", how, kProfile});
      wait_for([&] { return bench.digit[7] != 0 || !victim.lives(); });
      ASSERT_TRUE(victim.lives());
      const int64_t begin_ns = monotonic_now_ns();
      happens(victim);
      wait_for([&] { return bench.all_zero(); });
      const int64_t taken_ms = (monotonic_now_ns() - begin_ns) / 1'000'000;
      std::printf("%s: motors at zero after %d ms\n", what, static_cast<int>(taken_ms));
      EXPECT_LE(taken_ms, kLongest_ms) << what;
      // A new board: what a child has claimed is of the old one.
      board.unplug();
      wait_for([] { return !listed(); });
      plug();
    }
  }
};

TEST_F(KernelGuardian, ZeroesTheMotorsWhenTheHostIsKilled) {
  expect_zeros_after("host killed", "--pull", [](ChildProcess& host) { host.send(SIGKILL); });
}

TEST_F(KernelGuardian, ZeroesTheMotorsWhenTheHostIsStopped) {
  expect_zeros_after("host stopped", "--pull", [](ChildProcess& host) { host.send(SIGSTOP); });
}

TEST_F(KernelGuardian, ZeroesTheMotorsWhenAChildHasTheFilesOfTheHostThatIsKilled) {
  expect_zeros_after("host killed, files kept by its child", "--pull-and-fork",
                     [](ChildProcess& host) { host.send(SIGKILL); });
}

TEST_F(KernelGuardian, ItsEndIsNoticedByTheHost) {
  expect_zeros_after("guardian killed", "--pull", [](ChildProcess&) { signal_guardian(SIGKILL); });
}

TEST_F(KernelUsb, FilmOfAPipelinePullsAlsoAfterItsBoardWasPulledOut) {
  if (access("/gst-launch-1.0", X_OK) != 0) GTEST_SKIP() << "the plugin is not built";
  // At rest, and on the way there, all strings have the same tension.
  const auto pulls_to_a_side = [this] {
    const auto [least, most] = std::minmax_element(bench.digit.begin(), bench.digit.end());
    return *most - *least > 10;
  };
  ChildProcess launch({"/gst-launch-1.0", "-q", "--no-position", "videotestsrc", "pattern=ball",
                       "!", "video/x-raw,width=160,height=120,framerate=30/1", "!", "spidarmotion",
                       "device=usb", std::string("profile=") + kProfile, "!", "fakesink",
                       "sync=true"});
  wait_for([&] { return pulls_to_a_side() || !launch.lives(); });
  ASSERT_TRUE(launch.lives());
  board.unplug_in_transfer();
  wait_for([] { return !listed(); });
  for (auto& digit : bench.digit) digit = 0;
  plug();
  wait_for([&] { return pulls_to_a_side() || !launch.lives(); });
  ASSERT_TRUE(launch.lives());
  launch.end(SIGINT);
  EXPECT_TRUE(bench.all_zero());
}

TEST_F(KernelUsb, SpidarctlReadsTheBoard) {
  ChildProcess spidarctl({"/spidarctl", "monitor", "usb:EMULATED", "--seconds", "2"});
  EXPECT_EQ(spidarctl.wait(), 0);
}

}  // namespace
}  // namespace spidar::test::kernel_usb_test
