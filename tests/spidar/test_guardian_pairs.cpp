// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Two faults at once: of the player, its guardian, the board, and the control group of the player.
#include <cerrno>
#include <csignal>
#include <memory>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "spidar/guardian/guardian.h"
#include "spidar/link/link_thread.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/session/device_factory.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/spidar/guardian_victim.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::guardian_pairs_test {
namespace {

void sleep_ms(int ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Sets a variable of the environment, for programs that are started, until the end of the scope.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before, had_ = true;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { had_ ? setenv(name_, before_.c_str(), 1) : unsetenv(name_); }

 private:
  const char* name_;
  std::string before_;
  bool had_ = false;
};

/// A folder with programs that take the place of those of systemd.
struct FakeSystemd {
  TemporaryFolder folder;
  Variable variable{"SPIDAR_SYSTEMD", folder.path.string()};

  void add(const char* name, const std::string& script) const {
    const std::filesystem::path file = folder.path / name;
    std::ofstream(file) << "#!/bin/sh\n" << script << "\n";
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
};

/// Replaces itself by the command after "--", as systemd-run --scope does.
constexpr const char* kRunCommand = R"(while [ "$1" != -- ]; do shift; done; shift; exec "$@")";

UsbPort& pulling_board(Victim& victim) {
  UsbPort& port = bus().port[0];
  victim.lives_until([&] { return port.digit[7] != 0; });
  return port;
}

TEST(GuardianPairs, ABoardThatStallsWhileItsPlayerIsKilled) {
  for (const LinkFault fault : {LinkFault::kStall, LinkFault::kBusError}) {
    plug(0, "sh4");
    Victim victim("usb", kUsbProfile);
    UsbPort& port = pulling_board(victim);
    port.fault = fault;
    victim.end(SIGKILL);
    sleep_ms(2000);
    EXPECT_FALSE(port.at_rest());
    port.fault = LinkFault::kNone;
    wait_for([&] { return port.at_rest(); });
    clear_bus();
  }
}

/// A player that continues while its board still fails must find its guardian at work.
TEST(GuardianPairs, ABoardThatStallsWhileItsPlayerIsStoppedAndThenKilled) {
  plug(0, "sh4");
  Victim victim("usb", kUsbProfile);
  UsbPort& port = pulling_board(victim);
  port.fault = LinkFault::kStall;
  victim.send(SIGSTOP);
  sleep_ms(300);
  victim.send(SIGCONT);
  sleep_ms(300);
  victim.end(SIGKILL);
  port.fault = LinkFault::kNone;
  wait_for([&] { return port.at_rest(); });
  clear_bus();
}

/// Nobody is left who could do anything, but effects end by themselves.
TEST(GuardianPairs, AStickWhosePlayerAndGuardianAreStoppedTogether) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  port.expires = true;
  Victim victim("ff", kUsbProfile);
  wait_for([] { return !evdev_levels(0).at_rest(); });
  const pid_t guardian = guardian_process(victim.id());
  kill(guardian, SIGSTOP);
  victim.send(SIGSTOP);
  wait_for([] { return evdev_levels(0).at_rest(); });
  kill(guardian, SIGKILL);
  victim.end(SIGKILL);
  clear_bus();
}

/// The time until a player has noticed that its guardian is stopped, and has set the motors to
/// zero. Nothing if the player, which exchanges without a pause, or this process paused meanwhile.
/// Returns when the player has another guardian.
std::optional<int64_t> noticed_ns(const Victim& victim) {
  constexpr int64_t kPause_ns = 4'000'000;
  const UsbPort& port = bus().port[0];
  const pid_t first = guardian_process(victim.id());
  uint64_t exchanges = port.updates;
  const int64_t begin_ns = monotonic_now_ns();
  int64_t last_ns = begin_ns;
  bool paused = false;
  kill(first, SIGSTOP);
  wait_for([&] {
    const int64_t now_ns = monotonic_now_ns();
    paused = paused || now_ns - last_ns > kPause_ns;
    const uint64_t newest = port.updates;
    if (newest != std::exchange(exchanges, newest)) last_ns = now_ns;
    return port.at_rest();
  });
  const int64_t passed_ns = monotonic_now_ns() - begin_ns;
  wait_for([&] {
    const pid_t now = guardian_process(victim.id());
    return now != 0 && now != first;
  });
  return paused ? std::nullopt : std::optional(passed_ns);
}

/// A beat, the time for an answer, and an exchange.
TEST(GuardianPairs, AStoppedGuardianIsNoticedWithin100Ms) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "under a sanitizer, the guardian has ten times as long to answer";
#else
  static_assert(kBeat_ms + kAnswer_ms + boards::StringLink::kTransfer_ns / 1'000'000 <= 100);
#endif
  plug(0, "sh4");
  Victim victim("usb", kUsbProfile);
  int seen = 0;
  for (int i = 0; i < 5; ++i) {
    pulling_board(victim);
    if (const auto passed_ns = noticed_ns(victim)) {
      ++seen;
      EXPECT_LE(*passed_ns, kSecond_ns / 10);
    }
  }
  victim.end(SIGKILL);
  clear_bus();
  if (seen == 0) GTEST_SKIP() << "this machine was busy";
}

/// A guardian without a board.
struct Watched {
  Watched() {
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    LastWill will;
    will.wire = LastWill::Wire::kSocket;
    will.file = ends[0];
    guardian = std::make_unique<Guardian>("pair", will);
    process = guardian_process();
  }
  ~Watched() {
    kill(process, SIGCONT);
    guardian.reset();
    for (const int end : ends) ::close(end);
  }
  std::array<int, 2> ends{};
  std::unique_ptr<Guardian> guardian;
  pid_t process = 0;
};

/// What stops a player, as a virtual machine that gets no processor, may have stopped its guardian
/// as well: at rest, a pause of the player, however long, is one beat of the guardian's silence.
TEST(GuardianPairs, APlayerThatPausedAtRestGivesItsGuardianTime) {
  const Watched watched;
  kill(watched.process, SIGSTOP);
  int calls = 1;
  for (; watched.guardian->watch(false); ++calls) sleep_ms(2 * kBeat_ms);
  EXPECT_GE(calls, kAnswer_ms / kBeat_ms);
  EXPECT_LE(calls, kAnswer_ms / kBeat_ms + 2);
  EXPECT_FALSE(watched.guardian->was_suspended());
}

/// However seldom the player gets a processor: the time that it did not run counts.
TEST(GuardianPairs, AStoppedGuardianIsNoticedInRealTimeWhileMotorsPull) {
  for (const int pause_ms : {1, 20, 30, kSilence_ms - 5}) {
    const Watched watched;
    ASSERT_TRUE(watched.guardian->watch(true));
    kill(watched.process, SIGSTOP);
    const int64_t stopped_ns = monotonic_now_ns();
    int64_t called_ns = stopped_ns, before_ns = 0;
    do {
      sleep_ms(pause_ms);
      before_ns = std::exchange(called_ns, monotonic_now_ns());
    } while (watched.guardian->watch(true));
    // Any call after that time notices, however late this test was.
    EXPECT_LE(before_ns - stopped_ns, kAnswer_ms * kSecond_ns / 1000) << pause_ms;
  }
}

/// Its guardian would have zeroed the motors: nobody asks whether it has.
TEST(GuardianPairs, APlayerThatStoodStillWhileMotorsPulledRests) {
  const Watched watched;
  ASSERT_TRUE(watched.guardian->watch(true));
  kill(watched.process, SIGSTOP);
  sleep_ms(kSilence_ms + 1);
  EXPECT_FALSE(watched.guardian->watch(true));
  EXPECT_TRUE(watched.guardian->was_suspended());
}

/// A control group of version 2, if this process may make one; it ends with its processes.
class ControlGroup {
 public:
  explicit ControlGroup(const std::string& name) {
    for (const char* root : {"/sys/fs/cgroup", "/sys/fs/cgroup/unified"}) {
      const std::filesystem::path path =
          std::filesystem::path(root) / (name + std::to_string(getpid()));
      std::error_code error;
      if (!std::filesystem::exists(std::filesystem::path(root) / "cgroup.procs")) continue;
      if (!std::filesystem::create_directory(path, error)) continue;
      if (std::filesystem::exists(path / "cgroup.kill"))
        path_ = path;
      else
        std::filesystem::remove(path, error);
    }
  }
  ~ControlGroup() {
    if (path_.empty()) return;
    write("cgroup.freeze", "0");
    write("cgroup.kill", "1");
    wait_for([&] { return text_of(path_ / "cgroup.procs").empty(); });
    std::error_code error;
    std::filesystem::remove(path_, error);
  }
  ControlGroup(const ControlGroup&) = delete;
  ControlGroup& operator=(const ControlGroup&) = delete;

  bool write(const char* file, const std::string& text) const {
    std::ofstream stream(path_ / file);
    return !path_.empty() && static_cast<bool>(stream << text << std::flush);
  }
  bool add(pid_t process) const { return write("cgroup.procs", std::to_string(process)); }
  std::filesystem::path procs() const { return path_ / "cgroup.procs"; }

 private:
  std::filesystem::path path_;
};

/// As systemd-oomd does, or docker kill and docker pause.
TEST(GuardianPairs, AControlGroupThatIsKilledOrFrozen) {
  for (const char* how : {"cgroup.kill", "cgroup.freeze"}) {
    const ControlGroup players("spidar-players-"), guardians("spidar-guardians-");
    const FakeSystemd systemd;
    // The scope of its own.
    systemd.add("systemd-run", "echo $$ > " + guardians.procs().string() + "\n" + kRunCommand);
    Victim victim("usb", kUsbProfile, "--pull-when-plugged");
    if (!players.add(victim.id())) GTEST_SKIP() << "no control group of version 2 can be made";
    plug(0, "sh4");
    UsbPort& port = pulling_board(victim);
    ASSERT_TRUE(players.write(how, "1"));
    wait_for([&] { return port.at_rest(); });
    clear_bus();
  }
}

TEST(GuardianPairs, AScopeIsUsedWhereSystemdRuns) {
  const FakeSystemd systemd;
  const std::string seen = (systemd.folder.path / "seen").string();
  systemd.add("systemd-run", "echo \"$@\" > " + seen + "\n" + kRunCommand);
  plug(0, "sh4");
  const auto device = make_device("usb", load_profile(kUsbProfile));
  device->open();
  EXPECT_NE(guardian_process(), 0);
  const std::string options = text_of(seen);
  expect_contains(options, "--scope --quiet --collect");
  EXPECT_EQ(options.find("--user") == std::string::npos, geteuid() == 0) << options;
  device->close();
  EXPECT_EQ(guardian_process(), 0);
  clear_bus();
}

TEST(GuardianPairs, WithoutAScopeThereIsAGuardianNevertheless) {
  for (const char* script : {"exit 1", "kill -9 $$", "exec sleep 100"}) {
    const FakeSystemd systemd;
    systemd.add("systemd-run", script);
    plug(0, "sh4");
    Victim victim("usb", kUsbProfile);
    UsbPort& port = pulling_board(victim);
    victim.end(SIGKILL);
    wait_for([&] { return port.at_rest(); });
    clear_bus();
  }
}

/// Until the lock's command, which reads from the guardian, has ended.
TEST(GuardianPairs, SleepIsInhibitedWhileTheMotorsPull) {
  const FakeSystemd systemd;
  const std::string held = (systemd.folder.path / "held").string();
  systemd.add("systemd-run", kRunCommand);
  systemd.add("systemd-inhibit", "echo \"$@\" > " + held + "; cat; rm " + held);
  const auto is_held = [&] { return std::filesystem::exists(held); };
  UsbPort& port = plug(0, "sh4");
  const auto device = make_device("usb", load_profile(kUsbProfile));
  device->open();
  DeviceReading reading;
  wait_for([&] { return device->exchange({}, reading) == LinkFault::kNone; });
  EXPECT_FALSE(is_held());
  exchange_until(*device, one_volt(), [&] { return !port.at_rest() && !text_of(held).empty(); });
  expect_contains(text_of(held), "--what=sleep:handle-lid-switch --mode=block");
  exchange_until(*device, {}, [&] { return port.at_rest() && !is_held(); });
  exchange_until(*device, one_volt(), is_held);
  device->close();
  wait_for([&] { return !is_held(); });
  {
    Victim victim("usb", kUsbProfile);
    wait_for(is_held);
    victim.end(SIGKILL);
    wait_for([&] { return !is_held(); });
  }
  clear_bus();
}

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() < sizeof address.sun_path)
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  else
    ADD_FAILURE() << path;
  return address;
}

/// The socket of a service for which `queue` + 1 connections wait until it accepts them.
int listen_at(const std::string& path, int queue) {
  const sockaddr_un address = address_of(path);
  const int listening = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  EXPECT_EQ(bind(listening, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(listen(listening, queue), 0);
  return listening;
}

// connect() would wait for ever for a place in the queue.
TEST(GuardianPairs, AServiceThatAcceptsNobodyIsGivenUp) {
  const TemporaryFolder folder;
  const std::string path = (folder.path / "guardian").string();
  const int listening = listen_at(path, 0);
  const sockaddr_un address = address_of(path);
  const int first = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  ASSERT_EQ(connect(first, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  const Variable variable("SPIDAR_GUARDIAN", path);
  plug(0, "sh4");
  expect_contains(opening(*make_device("usb", load_profile(kUsbProfile))), path);
  close(first);
  close(listening);
  clear_bus();
}

/// As systemd does with Accept=yes and StandardInput=socket.
TEST(GuardianPairs, AServiceBehindASocketCanBeTheGuardian) {
  const TemporaryFolder folder;
  const std::string path = (folder.path / "guardian").string();
  const std::string program = std::getenv("SPIDAR_GUARDIAN");
  const int listening = listen_at(path, 4);
  pid_t service = -1;
  const Variable variable("SPIDAR_GUARDIAN", path);
  std::thread accepting([&] {
    const int connection = accept(listening, nullptr, nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, connection, STDIN_FILENO);
    std::array<char*, 2> arguments{const_cast<char*>(program.c_str()), nullptr};
    posix_spawn(&service, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(connection);
  });
  plug(0, "sh4");
  Victim victim("usb", kUsbProfile);
  accepting.join();
  UsbPort& port = pulling_board(victim);
  EXPECT_EQ(guardian_process(victim.id()), 0);
  victim.end(SIGKILL);
  wait_for([&] { return port.at_rest(); });
  EXPECT_EQ(waitpid(service, nullptr, 0), service);
  close(listening);
  clear_bus();
}

/// To end is what makes the kernel erase the effects, so nothing is gained by trying for ever. The
/// gain, which would make them stronger, is left alone.
TEST(GuardianPairs, OfAStickThatTakesNoEventEnds) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick, "hid-generic");
  Victim victim("ff", "spidar-g6x3-v2-r");
  victim.lives_until([&] { return !evdev_levels(0).at_rest(); });
  const pid_t guardian = guardian_process(victim.id());
  ASSERT_NE(guardian, 0);
  const int gain = port.gain;
  ASSERT_NE(gain, 0xFFFF);
  port.event_error = EIO;
  victim.end(SIGKILL);
  wait_for([&] { return has_ended(guardian); });
  EXPECT_EQ(port.gain, gain);
  wait_for([&] { return evdev_levels(0).at_rest() && !port.effect[0].used; });
  clear_bus();
}

/// A guardian that can never reach its board ends: here, the board is on a bus that the guardian
/// does not see, and answers as no device does.
TEST(GuardianPairs, EndsWithItsPlayerWhenItsFileIsNoDevice) {
  ChildProcess victim({"/proc/self/exe", "--pull", "usb", kUsbProfile},
                      {"SPIDAR_EMULATED_BUS=sh4"});
  pid_t guardian = 0;
  wait_for([&] { return (guardian = guardian_process(victim.id())) != 0 || !victim.lives(); });
  ASSERT_TRUE(victim.lives());
  victim.end(SIGKILL);
  wait_for([&] { return has_ended(guardian); });
}

}  // namespace
}  // namespace spidar::test::guardian_pairs_test
