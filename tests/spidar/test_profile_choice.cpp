// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidarctl on real boards, on an emulated bus: no motor pulls before somebody has named a profile.
#include <csignal>
#include <tuple>

#include "spidar/selftest/encoder_signs.h"
#include "spidar/session/profile_choice.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/spidar/bus_test.h"
#include "tests/spidar/guardian_victim.h"
#include "tests/support/shell.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace fs = std::filesystem;

namespace spidar::test {
namespace {

/// What all tests of this program share with the programs that they start.
const TemporaryFolder& settings_folder() {
  static const TemporaryFolder folder;
  return folder;
}

class ProfileChoice : public BusTest {
 protected:
  ProfileChoice() {
    setenv("XDG_CONFIG_HOME", settings_folder().path.c_str(), 1);
    std::filesystem::remove(remembered_profiles_file());
  }

  static std::string command(const std::string& arguments) {
    return "LD_PRELOAD=" EMULATED_BUS_LIBRARY " " SPIDARCTL " " + arguments;
  }
  /// Again where the machine was too busy for it.
  static CommandResult spidarctl(const std::string& arguments) {
    for (;;) {
      const CommandResult outcome = run(command(arguments));
      if (!is_disturbed(outcome.text)) return outcome;
    }
  }

  static int choose(UsbPort& port, const std::string& device, const Profile& real,
                    const std::string& named, std::string& text) {
    int status = 0;
    do {
      status = choose_once(port, device, real, named, text);
    } while (is_disturbed(text));
    return status;
  }

  /// Answers each question of `choose` when the grip is there. Only paid out, as strings are
  /// without motors. Returns the exit status; `text` is what it has printed.
  static int choose_once(UsbPort& port, const std::string& device, const Profile& real,
                         const std::string& named, std::string& text) {
    std::signal(SIGPIPE, SIG_IGN);  // of one that has given up
    const std::string log = (settings_folder().path / "log").string();
    std::filesystem::remove(log);
    FILE* answers = popen(
        (command("choose " + device + " --profile " + named) + " >" + log + " 2>&1").c_str(), "w");
    const EncoderScale scale(real);
    StringVector length_m = string_lengths_m(real.geometry, {});
    const auto read_log = [&] {
      std::ifstream file(log);
      return std::string(std::istreambuf_iterator<char>(file), {});
    };
    for (int stop = 0; stop <= 6; ++stop) {
      const std::string question = stop == 0 ? "at the centre" : std::to_string(stop) + " of 6";
      wait_for([&] {
        text = read_log();
        return text.find(question) != std::string::npos || is_disturbed(text);
      });
      if (is_disturbed(text)) break;
      if (stop > 0) {
        Pose pose;
        pose.position_m = selftest::hand_move_m(real.geometry) *
                          selftest::HandMoves::kSides[static_cast<size_t>(stop) - 1].direction;
        length_m = length_m.cwiseMax(string_lengths_m(real.geometry, pose));
      }
      EncoderScale::Counts counts{};
      scale.to_counts(length_m, counts);
      for (size_t i = 0; i < counts.size(); ++i) port.count[i] = counts[i];
      // Until the next readings have these counts: the board is read once a millisecond.
      const uint64_t before = port.updates;
      wait_for([&] { return port.updates >= before + 10 || is_disturbed(read_log()); });
      std::fputs("\n", answers);
      std::fflush(answers);
    }
    const int status = pclose(answers);
    text = read_log();
    return WEXITSTATUS(status);
  }
};

TEST_F(ProfileChoice, WithoutOneABoardIsReadAndNoMotorPulls) {
  const UsbPort& port = plug(0, "simple", "S1");
  for (const std::string command :
       {"monitor usb --taut --seconds 0.01 --yes", "pull usb 0 2 0.1 --yes", "selftest usb --yes",
        "calibrate usb --centre", "monitor usb --taut --seconds 0.1"}) {
    const CommandResult outcome = spidarctl(command);
    EXPECT_EQ(outcome.status, 1) << command;
    EXPECT_NE(outcome.text.find("the motors get no force: no profile is named"), std::string::npos)
        << command << ": " << outcome.text;
    expect_contains(outcome.text, " spidar-g6c, ");
  }
  const CommandResult chosen = spidarctl("choose usb");
  EXPECT_EQ(chosen.status, 2);
  expect_contains(chosen.text, "choose needs --profile NAME. Profiles that fit it: ");
  EXPECT_EQ(port.updates, 0u);
  for (const std::string command :
       {"info usb", "info usb --json", "monitor usb --seconds 0.11", "zero usb"}) {
    const CommandResult outcome = spidarctl(command);
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    EXPECT_TRUE(port.at_rest()) << command;
  }
  EXPECT_GT(port.updates, 0u);
  expect_contains(spidarctl("info usb").text, "\n  string     count\n");
  expect_contains(spidarctl("monitor usb --seconds 0.11").text, "  counts\n");
}

TEST_F(ProfileChoice, IsConfirmedByMovingTheGripAndRemembered) {
  UsbPort& port = plug(0, "sh4", "S1");
  const Profile real = load_profile("spidar-g645");
  std::string text;
  // The position of its rotary switch.
  EXPECT_EQ(choose(port, "usb:0", real, "spidar-g645", text), 0) << text;
  expect_contains(text, "spidar-g645 is remembered for the serial number S1\n");
  EXPECT_TRUE(port.at_rest());
  EXPECT_EQ(board_info("usb").profile, "spidar-g645");
  EXPECT_EQ(board_info("usb:0").profile, "spidar-g645");
  expect_contains(spidarctl("info usb").text, "profile   spidar-g645: ");
  // What cannot be kept is said before the grip is moved.
  for (const auto& [file, device, said] : {std::tuple("A1 =", "usb", "boards.toml:1: not TOML: "),
                                           std::tuple("", "usb:3", "one of several")}) {
    std::ofstream(remembered_profiles_file()) << file;
    plug(1, "sh4", "S3");
    const std::string name = *file ? "usb:S1" : device;
    const CommandResult refused = spidarctl("choose " + name + " --profile spidar-g645");
    EXPECT_EQ(refused.status, 1);
    expect_contains(refused.text, said);
  }
  unplug(1);
  // Another board is another one.
  plug(0, "sh4", "S2");
  EXPECT_EQ(board_info("usb").profile, "");
}

TEST_F(ProfileChoice, OneWithOtherEncodersIsRefused) {
  UsbPort& port = plug(0, "simple", "S1");
  std::string text;
  EXPECT_EQ(choose(port, "usb", load_profile("spidar-g6c"), "spidar-g6x3-v1-r", text), 1) << text;
  // Strings 6 and 7, which count the other way as well, leave this frame elsewhere.
  for (const int string : {0, 1})
    expect_contains(text, "  " + std::to_string(string) + "       counts the other way\n");
  expect_contains(text, "profiles whose encoders count so: ");
  expect_contains(text, "spidar-g6c");
  EXPECT_EQ(board_info("usb").profile, "");
}

TEST_F(ProfileChoice, ABoardWhoseEncodersAreDeadIsNotTakenForAGoodOne) {
  UsbPort& port = plug(0, "sh4", "S1");
  Profile dead = load_profile("spidar-g645");
  for (StringDrive& drive : dead.drives) drive.metres_per_count = 0;
  std::string text;
  EXPECT_EQ(choose(port, "usb", dead, "spidar-g645", text), 1) << text;
  expect_contains(text, "\nno encoder counted: ");
}

/// The cable is not to blame. On a busy machine, the other one may have stood still before: then
/// all is tried again.
TEST_F(ProfileChoice, WhatStoppedTheMotorsIsNamed) {
  for (const bool stopped : {true, false}) {
    std::string text;
    do {
      const UsbPort& port = plug(0, "sh4");
      const fs::path log = settings_folder().path / "loss";
      ChildProcess taut(
          {"sh", "-c",
           "exec " SPIDARCTL " monitor usb --taut --yes --profile spidar-g645 >/dev/null 2>" +
               log.string()},
          {"LD_PRELOAD=" EMULATED_BUS_LIBRARY});
      wait_for([&] { return !port.at_rest() || !taut.lives(); });
      // No signal to a process that has ended: its number would be -1, which is all of them.
      const bool lives = taut.lives();
      const pid_t guardian = lives ? guardian_process(taut.id()) : 0;
      if (lives && stopped) {
        taut.send(SIGSTOP);
        wait_for([&] { return port.at_rest(); });
        taut.send(SIGCONT);
      } else if (guardian > 0) {
        kill(guardian, SIGKILL);
      }
      wait_for([&] { return !taut.lives(); });
      std::ifstream file(log);
      text.assign(std::istreambuf_iterator<char>(file), {});
      clear_bus();
    } while (stopped ? is_unguarded(text) : was_suspended(text));
    EXPECT_TRUE(stopped ? was_suspended(text) : is_unguarded(text)) << text;
    EXPECT_EQ(text.find("cable"), std::string::npos) << text;
  }
}

TEST_F(ProfileChoice, WithoutSupplyNothingThatPullsSucceeds) {
  const UsbPort& port = plug(0, "sh4");
  struct Case {
    const char* arguments;
    int status;
    std::vector<const char*> says;
  };
  for (const Case& c : {Case{"pull usb 3 2 0.05", 1, {"no string has answered"}},
                        Case{"selftest usb",
                             1,
                             {"7  nothing              still ",
                              "Switch on the supply of the motors", "wiring: no answer"}},
                        Case{"calibrate usb --centre", 3, {"nothing is calibrated"}}}) {
    const CommandResult outcome =
        spidarctl(c.arguments + std::string(" --yes --profile spidar-g6x3-v2-r"));
    EXPECT_EQ(outcome.status, c.status) << outcome.text;
    for (const char* part : c.says) expect_contains(outcome.text, part);
    EXPECT_TRUE(port.at_rest());
  }
  EXPECT_GT(port.updates, 0u);
}

}  // namespace
}  // namespace spidar::test
