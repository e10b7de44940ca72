// What a user sees of spidarctl: exit status, messages, files.

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "spidar/profile.h"

namespace fs = std::filesystem;

namespace {

struct Outcome {
  int status = -1;
  std::string text;  ///< both outputs
};

Outcome run_shell(const std::string& command) {
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return outcome;
  char part[4096];
  while (std::fgets(part, sizeof part, pipe)) outcome.text += part;
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  return outcome;
}

Outcome run(const std::string& arguments) {
  return run_shell(std::string(SPIDARCTL) + " " + arguments + " 2>&1");
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in:\n" << text;
}

class OutputFile {
 public:
  OutputFile()
      : path_((fs::temp_directory_path() / ("spidarctl-" + std::to_string(getpid()) + ".toml"))
                  .string()) {}
  ~OutputFile() { fs::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

TEST(Spidarctl, HelpAndListSucceed) {
  expect_contains(run("--help").text, "usage: spidarctl COMMAND");
  expect_contains(run("calibrate --help").text, "--sim-start");
  const Outcome list = run("list");
  EXPECT_EQ(list.status, 0);
  expect_contains(list.text, "sim ");
  expect_contains(list.text, "spidar-gcc ");
}

TEST(Spidarctl, WrongUsageIsNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "commands are list, calibrate"},
      {"dance", "dance is not a command"},
      {"list me", "me: list takes no arguments"},
      {"calibrate", "no DEVICE given"},
      {"calibrate sim sim", "one DEVICE only"},
      {"calibrate sim --move x", "--move: \"x\" is not a number"},
      {"calibrate sim --move 0.1", "must be from 1 to 600 s"},
      {"calibrate sim --move", "--move needs a value"},
      {"calibrate sim --sway 3", "--sway is not an option"},
      {"calibrate sim --free grip", "known are exits, scale"},
      {"calibrate sim --centre --move 3", "one of them"},
      {"calibrate sim --centre --free scale", "--free needs --move"},
      {"calibrate sim --output mine", "must end in .toml"},
      {"calibrate sim --sim-start 1,2,3", "must be six numbers"},
      {"calibrate usb --sim-start 1,2,3,4,5,6", "is for the device sim"},
  };
  for (const auto& [arguments, message] : cases) {
    SCOPED_TRACE(arguments);
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2);
    expect_contains(outcome.text, message);
  }
}

TEST(Spidarctl, WhatIsNotThereIsNamedBeforeAnythingMoves) {
  const std::pair<const char*, const char*> cases[] = {
      {"calibrate nothing", "unknown device \"nothing\""},
      {"calibrate sim --profile nobody", "unknown profile \"nobody\""},
      {"calibrate sim --output /no/such/folder/a.toml", "cannot be written"},
  };
  for (const auto& [arguments, message] : cases) {
    SCOPED_TRACE(arguments);
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 1);
    expect_contains(outcome.text, message);
    EXPECT_EQ(outcome.text.find("Move and turn"), std::string::npos);
  }
}

// The counters of the simulated device are cleared 20, -30, 10 mm off and turned by 40 degrees.
TEST(Spidarctl, MotionFindsWhereTheCountersWereCleared) {
  const OutputFile file;
  const Outcome outcome =
      run("calibrate sim --move 4 --sim-start 20,-30,10,0,40,0 --output " + file.path());
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  expect_contains(outcome.text, "solved");
  const spidar::Profile profile = spidar::load_profile(file.path());
  spidar::Pose start;
  start.position_m = {0.02, -0.03, 0.01};
  start.orientation = Eigen::AngleAxisd(40 * M_PI / 180, Eigen::Vector3d::UnitY());
  const spidar::StringVector error_m =
      profile.zero_count_length_m() - spidar::string_lengths_m(profile.geometry, start);
  ASSERT_TRUE(profile.calibration);
  // What makes a result usable at all; see kMaxCalibrationSd_m.
  EXPECT_LT(error_m.cwiseAbs().maxCoeff(), 3 * 50e-6);
}

TEST(Spidarctl, JsonIsOneObject) {
  const Outcome outcome =
      run_shell(std::string(SPIDARCTL) + " calibrate sim --centre --json 2>/dev/null");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text.find("Hold"), std::string::npos);
  EXPECT_EQ(outcome.text.front(), '{');
  expect_contains(outcome.text, "\"status\" : \"solved\"");
}

// Interrupted when it has begun, however long that takes.
TEST(Spidarctl, InterruptReleasesTheStrings) {
  const OutputFile log;
  const Outcome outcome =
      run_shell(std::string(SPIDARCTL) + " calibrate sim --move 600 >" + log.path() +
                " 2>&1 & until grep -q Move " + log.path() +
                "; do sleep 0.05; done; kill -INT $!; wait $!; status=$?; cat " + log.path() +
                "; exit $status");
  EXPECT_EQ(outcome.status, 130);
  expect_contains(outcome.text, "the strings are released");
}
