// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Fuzz target of the reader and the writer of profiles; tests/README.md says how to run it under
// libFuzzer. The bytes are read as a file, and once more as a choice of values in such a file. The
// result must be a ProfileError, or a profile of finite numbers, which is the same when it is
// written and read.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "spidar/profiles/profile_file.h"

using namespace spidar;

namespace {

[[noreturn]] void fail(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  std::abort();
}

/// What the strings can do with numbers from anywhere.
void check(const Profile& profile) {
  const int count = profile.geometry.count;
  if (count < 6 || count > kMaxStrings) fail("a number of strings that no device has");
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    const StringDrive& drive = profile.drives[i];
    const bool sound = profile.geometry.exit_m[i].allFinite() &&
                       profile.geometry.grip_m[i].allFinite() && drive.min_tension_N > 0 &&
                       drive.max_tension_N > drive.min_tension_N &&
                       drive.max_tension_N <= drive.newtons_per_volt * profile.dac_max_V * 1.001 &&
                       std::isfinite(drive.home_offset_m) && drive.metres_per_count > 0 &&
                       drive.heating_time_s >= 1 && drive.heating_time_s <= 120 &&
                       std::abs(drive.motor_sign) == 1 && std::abs(drive.encoder_sign) == 1;
    if (!sound) fail("a string that cannot be driven");
  }
  if (!(profile.drive_lag_s >= 0)) fail("a lag that is no time");
  if (profile.dac_bits < 8 || profile.dac_bits > 16) fail("a D/A that no board has");
  if (!(least_reach(structure_matrix(profile.geometry, {}).topRows<3>(), count) > 0))
    fail("strings that cannot hold the grip");
}

void read(const std::string& text) {
  Profile profile;
  try {
    profile = parse_profile(text, "fuzzed.toml", "fuzzed");
  } catch (const ProfileError&) {
    return;
  }
  check(profile);
  const std::string written = profile_text(profile);
  if (profile_text(parse_profile(written, "written.toml", "fuzzed")) != written)
    fail("not the same when it is read again:\n" + written);
}

/// A line of a profile: what goes before its value, a good value, and others.
struct Line {
  const char* begin;
  std::vector<const char*> values;
};

const std::vector<Line> kLines = {
    {"description = ", {"\"d\"", "\"\\\"\\\\ \\u0001\\n\"", "7"}},
    {"board = ", {"\"uart\"", "\"ahs\"", "\"toaster\""}},
    {"dac_bits = ", {"12", "24", "0", "-9223372036854775808", "1e3"}},
    {"dac_max_V = ", {"3.3", "10", "0", "inf", "1e308"}},
    {"drive_lag_s = ", {"0.002", "0", "-1", "nan", "0.1"}},
    {"[geometry]\nframe = ", {"\"left-handed\"", "\"right-handed\"", "\"upside-down\""}},
    {"unit = ", {"\"mm\"", "\"m\"", "\"ft\""}},
    {"exit = ",
     {"[[-60,-61,-62],[-60,-61,62],[60,-61,62],[60,-61,-62],[-60,61,-62],[-60,61,62]]",
      "[[1e3,1,1],[1,1,1],[1,1,1],[1,1,1],[1,1,1],[1,1,1]]", "[[nan,0,0]]", "[]",
      "[[-60,-61],[-60,-61,62],[60,-61,62],[60,-61,-62],[-60,61,-62],[-60,61,62]]"}},
    {"grip = ",
     {"[[0,-20,1],[-20,0,2],[20,0,3],[0,-20,4],[0,20,5],[-20,0,6]]",
      "[[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]]", "{}", "[[0,0,0]]"}},
    {"[strings]\nmin_tension_N = ", {"0.3", "[0.3,0.3,0.3,0.4,0.3,0.3]", "[0.3]", "-0.3", "7"}},
    {"max_tension_N = ", {"6", "1e300", "0.3", "[6,6,6,6,6,nan]"}},
    {"newtons_per_volt = ", {"12.5", "1e-300", "inf"}},
    {"metres_per_count = ", {"2.25e-5", "1", "1e-9"}},
    {"motor_sign = ", {"[1,-1,1,-1,1,-1]", "[1,0,1,1,1,1]", "1"}},
    {"encoder_sign = ", {"[-1,-1,1,1,1,1]", "[2,1,1,1,1,1]"}},
    {"home_offset_m = ", {"[0,0,0.01,0,0,0]", "[-1,0,0,0,0,0]", "[inf,0,0,0,0,0]"}},
    {"continuous_tension_N = ", {"2", "0.1", "100"}},
    {"heating_time_s = ", {"20", "0", "1e9"}},
    {"[calibration]\nsamples = ", {"100", "0", "99999999999"}},
    {"residual_m = ", {"1e-5", "-1", "inf"}},
    {"[[source]]\nfields = ", {"[\"geometry\",\"board\"]", "[\"colour\"]", "[]", "[7]"}},
    {"source = ", {"\"a book\"", "\"\\u00e9\"", "{}"}},
    {"evidence = ", {"\"contradicted\"", "\"hearsay\""}},
};

/// A value of each line: mostly the good one.
std::string chosen(const uint8_t* data, size_t size) {
  std::string text;
  for (size_t i = 0; i < kLines.size(); ++i) {
    const Line& line = kLines[i];
    const size_t byte = size > 0 ? data[i % size] + i / size : 0;
    if (byte % 64 == 63) continue;
    const size_t other = byte / 8 % line.values.size();
    text += line.begin + std::string(line.values[byte % 8 == 7 ? other : 0]) + "\n";
  }
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  read(std::string(reinterpret_cast<const char*>(data), size));
  read(chosen(data, size));
  return 0;
}
