// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidarctl conformance.
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "spidar/profiles/profile.h"
#include "tests/spidar/spidarctl_command.h"

namespace fs = std::filesystem;

namespace spidar::test::spidarctl_conformance_test {
namespace {

TEST(Spidarctl, ConformanceWritesAReportToSendIn) {
  const OutputFile file;
  const CommandResult outcome =
      run_spidarctl("conformance sim:sh4 --seconds 0.1 --no-shake --report " + file.path());
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  expect_contains(outcome.text, "conforms; written: " + file.path());
  std::stringstream report;
  report << std::ifstream(file.path()).rdbuf();
  for (const char* line :
       {"opened as   CyVerse USB 2.0 SH4, rotary switch 0\n", "faults      none\n",
        "inputs      0x0000, changed 0x0000\n", "wiring: as in the profile\n",
        "link        conforms\n", "counters    8 of 8 moved\n", "motors      conform\n",
        "lag         not tried\n"})
    expect_contains(report.str(), line);
}

// How well depends on what else this machine does; a busy one may be too busy. test_delay has the
// figures, in simulated time.
TEST(Spidarctl, ConformanceMeasuresTheLagOfTheDrives) {
  const CommandResult outcome =
      run_spidarctl("conformance sim:sh4 --seconds 0.1 --shake-seconds 6");
  expect_contains(outcome.text, "\ndrive lag   ");
  if (outcome.text.find("not measured: ") != std::string::npos) {
    expect_contains(outcome.text, "lag         not measured\n");
    GTEST_SKIP() << outcome.text.substr(outcome.text.find("drive lag"));
  }
  for (const char* line : {"\ndelay       t_d = ", "\nprofile     drive_lag_s = 0.00",
                           "it has 0.002, ", "\nstiffness   ", " with a damping of 1.5 K t_d"})
    expect_contains(outcome.text, line);
}

TEST(Spidarctl, ConformanceReportsThatNothingIsPluggedIn) {
  // Whether this machine has no USB or only no board: nothing is plugged in.
  const CommandResult gone = run_spidarctl("conformance usb:no-such-board --no-pull");
  EXPECT_EQ(gone.status, 1);
  expect_contains(gone.text, "ended by    usb");
  expect_contains(gone.text, "link        does not conform\n");
}

// The motors stay at zero, and nobody moves the grip.
TEST(Spidarctl, ConformanceThatMovesNothingShowsNothing) {
  const CommandResult outcome = run_spidarctl("conformance sim:simple --no-pull --seconds 0.1");
  EXPECT_EQ(outcome.status, 1) << outcome.text;
  expect_contains(outcome.text, "counters    0 of 8 moved; nothing was shown of the rest\n");
  expect_contains(outcome.text, "verdict     no counter moved, so nothing was shown but that ");
  EXPECT_EQ(run_spidarctl("conformance sim:mouse --seconds 0.1").status, 0);
  EXPECT_EQ(run_spidarctl("conformance sim:falcon --no-pull --seconds 0.1").status, 0);
}

}  // namespace
}  // namespace spidar::test::spidarctl_conformance_test
