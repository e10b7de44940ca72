// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidarctl as a user sees it: exit status, messages, files.
#include <pty.h>
#include <regex>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>

#include "spidar/profiles/profile.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "tests/spidar/spidarctl_command.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace fs = std::filesystem;

namespace spidar::test::spidarctl_test {
namespace {

TEST(Spidarctl, HelpAndListSucceed) {
  expect_contains(run_spidarctl("--help").text, "Usage: spidarctl ");
  expect_contains(run_spidarctl("calibrate --help").text, "--centre");
  const CommandResult list = run_spidarctl("list");
  EXPECT_EQ(list.status, 0);
  for (const char* part : {"sim ", "sim:sh4 ", "; emulated", "spidar-gcc "})
    expect_contains(list.text, part);
  const CommandResult json = run_spidarctl("list --json");
  EXPECT_EQ(json.status, 0);
  expect_contains(json.text, "\"device\": \"sim:uart\"");
  expect_contains(json.text, "\"evidence\": \"emulated\"");
  const bool any_real = std::regex_search(json.text, std::regex("\"device\": \"(?!sim)"));
  EXPECT_EQ(list.text.find("none is plugged in") != std::string::npos, !any_real) << list.text;
}

TEST(Spidarctl, WrongUsageIsNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "A subcommand is required"},
      {"dance",
       "dance is not a command; commands are list, info, monitor, zero, pull, choose, "
       "selftest, calibrate"},
      {"list me", "not expected: me"},
      {"info", "spidarctl: DEVICE is required; see spidarctl info --help"},
      {"info sim sim", "not expected: sim"},
      {"zero sim --json", "not expected: --json"},
      {"monitor sim --seconds 0", "not a number from 0.001 to 86400 s"},
      {"pull sim 1 2", "SECONDS is required"},
      {"pull sim 8 1 1 --yes", "STRING: Value 8 not in range"},
      {"pull sim 1.5 1 1 --yes", "STRING: Value 1.5"},
      {"pull sim 1 5 1 --yes", "NEWTON: 5 N, must be from 0.05 to 4.2 N"},
      {"pull sim 1 1 11 --yes", "not a number from 0.01 to 10 s"},
      {"pull sim 1 4 2 --yes", "pull for 1.25 s at most"},
      // Its motors could do 20 N.
      {"pull sim 1 6 0.1 --yes --profile spidar-g6x", "not a number from 0 to 5 N"},
      {"pull sim 1 0.5 0.1 --yes --profile spidar-g6x", "NEWTON: 0.5 N, must be from 1 to 5 N"},
      {"pull usb 1 1 1 --profile spidar-g6c </dev/null", "no terminal to ask for confirmation"},
      {"monitor usb --taut --profile spidar-g6c </dev/null", "no terminal to ask for confirmation"},
      {"calibrate usb --profile spidar-g6c </dev/null", "no terminal to ask for confirmation"},
      {"selftest sim --newton 5", "not a number from 0.1 to 2 N"},
      {"selftest sim --write-profile mine", "must end in .toml"},
      {"choose sim", "a simulated device has its own profile"},
      {"selftest usb --profile spidar-g6c </dev/null", "no terminal to ask for confirmation"},
      {"calibrate sim --move x", "--move: \"x\" is not a number from 1 to 600 s"},
      {"calibrate sim --free grip", "grip not in {exits,scale,"},
      {"calibrate --free exits sim --centre", "--free needs --move"},
      {"calibrate sim --centre --move 3", "give one of them"},
      {"calibrate sim --output mine", "must end in .toml"},
  };
  for (const auto& [arguments, message] : cases) {
    SCOPED_TRACE(arguments);
    const CommandResult outcome = run_spidarctl(arguments);
    EXPECT_EQ(outcome.status, 2);
    expect_contains(outcome.text, message);
  }
}

/// What a program on a terminal prints until `sentence`, or its end.
std::string read_until(int terminal, const std::string& sentence) {
  std::string text;
  std::array<char, 256> part{};
  while (text.find(sentence) == std::string::npos) {
    const ssize_t length = read(terminal, part.data(), part.size());
    if (length <= 0) break;  // EIO: it has ended
    text.append(part.data(), static_cast<size_t>(length));
  }
  return text;
}

/// A motor starts only by an answer to a question that somebody has seen, and read.
TEST(Spidarctl, WhatWasTypedBeforeAQuestionIsReadIsNoAnswer) {
  int terminal = -1;
  const pid_t process = forkpty(&terminal, nullptr, nullptr, nullptr);
  ASSERT_GE(process, 0);
  if (process == 0) {
    // The shell starts the program when the first line is there.
    execl("/bin/sh", "sh", "-c", "read line; " SPIDARCTL " pull usb 1 1 0.1 --profile spidar-g6c",
          nullptr);
    _exit(127);
  }
  const std::string_view typed = "\ny\nyes\n";
  const int64_t begin_ns = monotonic_now_ns();
  ASSERT_EQ(write(terminal, typed.data(), typed.size()), static_cast<ssize_t>(typed.size()));
  expect_contains(read_until(terminal, "[y/N] "), "Pull string 1 of usb");
  ASSERT_EQ(write(terminal, "y\n", 2), 2);
  const std::string said = read_until(terminal, "[y/N] ");
  // The question has more than ten words, at 300 a minute.
  if (said.find("nobody can read that so fast") == std::string::npos &&
      monotonic_now_ns() - begin_ns > 2'000'000'000) {
    close(terminal);
    GTEST_SKIP() << "this machine was slower than a reader";
  }
  expect_contains(said, "nobody can read that so fast");
  ASSERT_EQ(write(terminal, "n\n", 2), 2);
  expect_contains(read_until(terminal, "nothing was moved"), "nothing was moved");
  read_until(terminal, "its end");
  int status = 0;
  ASSERT_EQ(waitpid(process, &status, 0), process);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1);
  close(terminal);
}

/// A terminal obeys control characters, whoever has printed them.
TEST(Spidarctl, ListsWhatADeviceSaysOfItselfHarmlessly) {
  const TemporaryFolder folder;
  const fs::path configuration = folder.path / "asound.conf";
  std::ofstream(configuration) << "pcm.shaker { type null hint { show on description \"Name "
                                  "\033]0;title\007\033[2J\xff\" } }\n";
  const std::string list = "ALSA_CONFIG_PATH=" + configuration.string() + " " + SPIDARCTL + " list";
  const std::string text = run(list).text;
  if (text.find("sound:shaker") == std::string::npos) GTEST_SKIP() << "without ALSA";
  expect_contains(text, "Name ?]0;title??[2J?");
  EXPECT_EQ(text.find('\033'), std::string::npos) << text;
  EXPECT_EQ(run(list + " --json").status, 0);
}

TEST(Spidarctl, WhatIsNotThereIsNamedBeforeAnythingMoves) {
  const std::pair<const char*, const char*> cases[] = {
      {"calibrate nothing", "unknown device \"nothing\""},
      {"info nothing", "unknown device \"nothing\""},
      {"info auto", "\"auto\" is not a device; known are: sim, sim:BOARD, usb,"},
      {"info none", "\"none\" is not a device; known are: sim, sim:BOARD, usb,"},
      {"info uart", "\"uart\" does not say which one: write uart:PATH"},
      {"info sound", "\"sound\" does not say which one: write sound:CARD"},
      {"info gamepad", "unknown device \"gamepad\": here it is called ff; spidarctl list"},
      {"info spidar", "unknown device \"spidar\": here it is called usb, or uart:PATH"},
      {"monitor sim:mouse", "is for devices with strings"},
      {"calibrate sim:ff", "sim:ff: calibrate is for devices with strings"},
      {"calibrate ff", "ff: calibrate is for devices with strings"},
      {"calibrate mouse", "mouse: calibrate is for devices with strings"},
      {"calibrate uart:/no/such/line --yes --profile spidar-g6x4", "/no/such/line"},
      {"calibrate uart:/no/such/line --centre --yes --profile spidar-g6x4", "/no/such/line"},
      {"monitor sim:sh4 --profile spidar-gcc", "wants negative volts"},
      {"zero uart:/no/such/line", "/no/such/line"},
      {"selftest sim --write-profile /no/such/folder/a.toml", "cannot be written"},
      {"choose usb --profile nobody", "unknown profile \"nobody\""},
      {"choose usbs --profile spidar-g6c", "unknown device \"usbs\"; did you mean usb?"},
      {"choose usb:nowhere --profile spidar-g6c", "is plugged in"},
      {"calibrate sim --profile nobody", "unknown profile \"nobody\""},
      {"calibrate sim --output /no/such/folder/a.toml", "cannot be written"},
  };
  for (const auto& [arguments, message] : cases) {
    SCOPED_TRACE(arguments);
    const CommandResult outcome = run_spidarctl(arguments);
    EXPECT_EQ(outcome.status, 1);
    expect_contains(outcome.text, message);
    EXPECT_EQ(outcome.text.find("Move and turn"), std::string::npos);
    EXPECT_EQ(outcome.text.find("Hold the grip"), std::string::npos);
  }
}

TEST(Spidarctl, MotionFindsWhereTheCountersWereCleared) {
  const OutputFile file;
  std::ofstream(file.path()) << "old\n";
  const CommandResult outcome =
      run_spidarctl("calibrate sim --move 4 --force --output " + file.path());
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  expect_contains(outcome.text, "for 4 s.\n   4 s left\n   3 s left\n");
  expect_contains(outcome.text, "solved");
  const spidar::Profile profile = spidar::load_profile(file.path());
  ASSERT_TRUE(profile.calibration);
  // At the centre: what makes a result usable at all; see kMaxCalibrationSd_m.
  const spidar::StringVector error_m =
      profile.zero_count_length_m() - spidar::string_lengths_m(profile.geometry, {});
  EXPECT_LT(error_m.cwiseAbs().maxCoeff(), 3 * 50e-6);
}

TEST(Spidarctl, WhatExistsIsNotReplacedUnlessForced) {
  const OutputFile file;
  std::ofstream(file.path()) << "mine";
  for (const char* command : {"selftest sim --write-profile ", "calibrate sim --output "}) {
    const CommandResult outcome = run_spidarctl(command + file.path());
    EXPECT_EQ(outcome.status, 1) << command;
    expect_contains(outcome.text, ": exists; name another file, or replace it with --force");
  }
  EXPECT_EQ(fs::file_size(file.path()), 4u);
}

// How well the lag is measured depends on what else this machine does; a busy one may be too busy.
// test_delay has the figures, in simulated time.
TEST(Spidarctl, SelftestWritesHowTheDeviceIsWiredAndLags) {
  const OutputFile file;
  std::ofstream(file.path()) << "old";
  const CommandResult outcome =
      run_shell(std::string(SPIDARCTL) + " selftest sim:sh4 --lag --json --force --write-profile " +
                file.path() + " 2>&1");
  // On standard error, while they are pulled: each gets shorter.
  for (int i = 0; i < 8; ++i) {
    expect_contains(outcome.text, "pulled " + std::to_string(i + 1) + " of 8: motor " +
                                      std::to_string(i) + ", own length -");
  }
  expect_contains(outcome.text, "\"wiring\": \"as in the profile\"");
  const Profile written = load_profile(file.path());
  EXPECT_EQ(written.drives[3].encoder_sign,
            load_profile("spidar-g6x3-v2-r").drives[3].encoder_sign);
  const bool measured = outcome.text.find("\"drive_lag_s\": 0.00") != std::string::npos;
  EXPECT_EQ(written.drive_lag_known, measured);
  if (!measured) expect_contains(outcome.text, "\"drive_lag\": {\n    \"error\": ");
}

TEST(Spidarctl, InfoReadsEachBoard) {
  for (const DeviceInfo& board : list_boards()) {
    if (!is_simulated(board.device)) continue;
    const std::string& device = board.device;
    SCOPED_TRACE(device);
    const CommandResult outcome = run_spidarctl("info " + device);
    EXPECT_EQ(outcome.status, 0);
    expect_contains(outcome.text, "device    " + device + "\n");
    expect_contains(outcome.text,
                    board.has_strings ? "\n  string  N smallest" : "\n  axis     force  position");
  }
  const std::pair<const char*, const char*> found[] = {
      {"sim:ff", "found     emulated stick at 20 % of its strength, force feedback on two axes"},
      {"sim:ff", "force     3 N at most, 200 times a second\n"},
      {"sim:ff", "  right      yes    0.0 mm\n  up         yes    0.0 mm\n"},
      {"sim:ff --json", "\"largest_force_N\": 3.0"},
      {"sim:inverse3", "10 N at most, 1000 times a second\n"},
      {"sim:falcon", "found     Novint Falcon\n"},
      {"sim:falcon", "force     4.4 N at most, 1000 times a second\n"},
      {"sim:falcon", "  forward    yes    0.0 mm\n"},
      {"sim:mouse", "  right      yes  no\n"},
      {"sim:sh4 --json", "\"profile\": \"spidar-g6x3-v2-r\""},
  };
  for (const auto& [device, part] : found)
    expect_contains(run_spidarctl(std::string("info ") + device).text, part);
}

TEST(Spidarctl, SelftestPushesWhatTakesAForce) {
  for (const char* command : {"selftest sim:falcon", "selftest sim:inverse3"}) {
    const CommandResult outcome = run_spidarctl(command);
    EXPECT_EQ(outcome.status, 0) << command;
    for (const char* side : {"right  ", "up     ", "forward"})
      expect_contains(outcome.text, side + std::string("  moves with the force\n"));
  }
  const CommandResult felt = run_spidarctl("selftest sim:sound");
  EXPECT_EQ(felt.status, 0);
  expect_contains(felt.text, "right    a pulse of 0.5 s\nup       a pulse of 0.5 s\n");
  expect_contains(felt.text, "heard after 30 ms\n");
  const CommandResult held = run_spidarctl("selftest sim:ff");
  EXPECT_EQ(held.status, 1);
  expect_contains(held.text,
                  "emulated stick at 20 % of its strength, force feedback on two axes\n");
  expect_contains(held.text, "right    does not move: no force arrives, or ");
  expect_contains(held.text, "with a hand that holds it: nothing is wrong.\n");
}

TEST(Spidarctl, MonitorShowsTheGrip) {
  const CommandResult text = run_spidarctl("monitor sim:uart --taut --seconds 0.15");
  EXPECT_EQ(text.status, 0);
  expect_contains(text.text, "inputs");
  expect_contains(text.text, "   0.1 ");
  expect_contains(text.text, " exchanges answered in ");
  const CommandResult json = run_spidarctl("monitor sim --seconds 0.15 --json");
  EXPECT_EQ(json.status, 0);
  EXPECT_EQ(std::count(json.text.begin(), json.text.end(), '\n'), 2) << json.text;
  // The motors are at zero, so that the simulated hand holds the grip at the centre.
  expect_contains(json.text, "\"position_m\":[0.0,0.0,0.0]");
}

TEST(Spidarctl, ZeroNeedsNoProfile) {
  // A profile that cannot be read does not keep the motors from being set to zero.
  const CommandResult zero = run_spidarctl("zero sim:sh4 --profile nope");
  EXPECT_EQ(zero.status, 0);
  expect_contains(zero.text, "sim:sh4: the motors are at zero");
}

/// The line of docs/first-power-on.md, for the profiles of boards that have a driver.
TEST(Spidarctl, TheFirstPullOfTheGuideSuitsEveryBoard) {
  int tried = 0;
  for (const std::string& name : spidar::list_profiles()) {
    SCOPED_TRACE(name);
    const std::string board = spidar::load_profile(name).board;
    if (board == "ahs") continue;
    ++tried;
    // Of a longer pull only the time is refused: string and force are right, and 2 s.
    expect_contains(run_spidarctl("pull sim 0 2 2.6 --profile " + name).text,
                    "pull for 2.50 s at most");
  }
  EXPECT_GT(tried, 0);
}

// The general default profile, spidar-gcc, wants negative volts, which this board does not have.
TEST(Spidarctl, CalibrateTakesTheProfileOfTheBoardAndPrintsOneObject) {
  const CommandResult outcome =
      run_shell(std::string(SPIDARCTL) + " calibrate sim:sh4 --centre --json 2>/dev/null");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text.front(), '{');
  expect_contains(outcome.text, "\"status\": \"solved\"");
  expect_contains(outcome.text, "\"profile\": \"spidar-g6x3-v2-r\"");
}

TEST(Spidarctl, PullShortensItsString) {
  const CommandResult outcome =
      run_shell(std::string(SPIDARCTL) + " pull sim:sh4 2 1 0.2 --yes --json 2>&1");
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  const std::string key = "\"length_change_m\": [";
  const size_t begin = outcome.text.find(key);
  ASSERT_NE(begin, std::string::npos) << outcome.text;
  std::istringstream numbers(outcome.text.substr(begin + key.size()));
  std::array<double, 3> change_m{};
  char comma = 0;
  for (double& one : change_m) numbers >> one >> comma;
  // 0.7 N more than at rest against the hand's 300 N/m, and a turn that shortens it further.
  EXPECT_LT(change_m[2], -0.7 / 300 / 2);
}

// Interrupted when it has begun, however long that takes.
TEST(Spidarctl, InterruptReleasesTheStrings) {
  const OutputFile log;
  const CommandResult outcome = run_shell(
      std::string(SPIDARCTL) + " calibrate sim >" + log.path() + " 2>&1 & until grep -q Hold " +
      log.path() + "; do sleep 0.05; done; kill -INT $!; wait $!; status=$?; cat " + log.path() +
      "; exit $status");
  EXPECT_EQ(outcome.status, 130);
  expect_contains(outcome.text, "the strings are released");
}

TEST(Spidarctl, WhatCannotBePrintedIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  // The last one would go on for an hour.
  for (const char* arguments : {"--version", "--help", "list", "list --json", "info sim",
                                "monitor sim --seconds 3600", "zero sim"}) {
    SCOPED_TRACE(arguments);
    const CommandResult result =
        run_shell(std::string(SPIDARCTL) + " " + arguments + " 2>&1 >/dev/full");
    EXPECT_EQ(result.status, 1);
    expect_contains(result.text, "spidarctl: what is printed cannot be written");
  }
}

}  // namespace
}  // namespace spidar::test::spidarctl_test
