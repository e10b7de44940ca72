// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidarctl on real boards, on an emulated bus: no motor pulls before somebody has named a profile.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/emulated_bus/bus_state.h"
#include "tests/spidar/guardian_victim.h"
#include "tests/support/shell.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test {
namespace {

class ProfileChoice : public testing::Test {
 protected:
  ProfileChoice() { clear_bus(); }
  ~ProfileChoice() override { clear_bus(); }

  static std::string spidarctl(const std::string& arguments) {
    return "LD_PRELOAD=" EMULATED_BUS_LIBRARY " " SPIDARCTL " " + arguments;
  }

  /// On a machine that is too busy, the guardian takes a program that pulls for a stopped one.
  static bool disturbed(const std::string& text) {
    return text.find("this program stood still") != std::string::npos;
  }
};

TEST_F(ProfileChoice, WithoutOneABoardIsReadAndNoMotorPulls) {
  const UsbPort& port = plug(0, UsbKind::kSimple, "S1");
  for (const std::string command : {"pull usb 0 2 0.1 --yes", "selftest usb --yes",
                                    "calibrate usb --centre", "monitor usb --taut --seconds 0.1"}) {
    const CommandResult outcome = run(spidarctl(command));
    EXPECT_EQ(outcome.status, 1) << command;
    EXPECT_NE(outcome.text.find("the motors get no force: no profile is named"), std::string::npos)
        << command << ": " << outcome.text;
    EXPECT_NE(outcome.text.find(" spidar-g6c, "), std::string::npos) << outcome.text;
  }
  EXPECT_EQ(port.updates, 0u);
  for (const std::string command :
       {"info usb", "info usb --json", "monitor usb --seconds 0.11", "zero usb"}) {
    const CommandResult outcome = run(spidarctl(command));
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    EXPECT_TRUE(port.at_rest()) << command;
  }
  EXPECT_GT(port.updates, 0u);
  EXPECT_NE(run(spidarctl("info usb")).text.find("\n  string     count\n"), std::string::npos);
  EXPECT_NE(run(spidarctl("monitor usb --seconds 0.11")).text.find("  counts\n"),
            std::string::npos);
}

/// The cable is not to blame.
TEST_F(ProfileChoice, WhatStoppedTheMotorsIsNamed) {
  for (const bool stopped : {true, false}) {
    const UsbPort& port = plug(0, UsbKind::kSh4);
    const TemporaryFolder folder;
    const std::filesystem::path log = folder.path / "loss";
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
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!stopped && disturbed(text)) GTEST_SKIP() << text;
    EXPECT_NE(text.find(stopped ? "usb: this program stood still for "
                                : "usb: the guardian (spidar-guardian), without which no motor"),
              std::string::npos)
        << text;
    EXPECT_EQ(text.find("cable"), std::string::npos) << text;
    clear_bus();
  }
}

TEST_F(ProfileChoice, WithoutSupplyNothingThatPullsSucceeds) {
  const UsbPort& port = plug(0, UsbKind::kSh4);
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
        run(spidarctl(c.arguments + std::string(" --yes --profile spidar-g6x3-v2-r")));
    if (disturbed(outcome.text)) GTEST_SKIP() << outcome.text;
    EXPECT_EQ(outcome.status, c.status) << outcome.text;
    for (const char* part : c.says)
      EXPECT_NE(outcome.text.find(part), std::string::npos) << outcome.text;
    EXPECT_TRUE(port.at_rest());
  }
  EXPECT_GT(port.updates, 0u);
}

}  // namespace
}  // namespace spidar::test
