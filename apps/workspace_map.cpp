// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Computes which part of a wanted force a SPIDAR delivers over its workspace; docs/workspace.md
/// explains the numbers.

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "apps/help.h"
#include "apps/workspace/continuity.h"
#include "apps/workspace/pose_map.h"
#include "apps/workspace/survey.h"

namespace {

constexpr const char* kUsage =
    "usage: workspace_map FOLDER [PROFILE ...]    maps as PNG and CSV into FOLDER\n"
    "       workspace_map --table [PROFILE ...]   shares of poses, delivered force and moment\n"
    "       workspace_map --continuity [PROFILE ...]\n"
    "                                             largest step of a tension beside its bound\n"
    "       workspace_map --smoothing [PROFILE ...]\n"
    "                                             steps against accuracy, by epsilon\n"
    "PROFILE is a name or a file; without one, all that are found.\n";

std::vector<spidar::Profile> load(std::vector<std::string> names) {
  if (names.empty()) names = spidar::list_profiles();
  if (names.empty())
    throw spidar::ProfileError("no profiles found; set SPIDAR_PROFILE_PATH to their folder");
  std::vector<spidar::Profile> profiles;
  for (const std::string& name : names) profiles.push_back(spidar::load_profile(name));
  return profiles;
}

void run(const std::string& what, const std::vector<spidar::Profile>& profiles) {
  if (what == "--table") {
    print_surveys(profiles);
  } else if (what == "--continuity") {
    print_continuity(profiles);
  } else if (what == "--smoothing") {
    for (const spidar::Profile& profile : profiles) {
      std::printf("%s\n\n", profile.name.c_str());
      print_smoothing(profile);
    }
  } else {
    for (const spidar::Profile& profile : profiles) {
      draw_map(profile, what);
      std::printf("drawn: %s/workspace-%s.png\n", what.c_str(), profile.name.c_str());
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (asks_for_help(argc, argv, kUsage)) return 0;
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool option = !arguments.empty() && arguments[0].rfind("-", 0) == 0;
  if (arguments.empty() || (option && arguments[0] != "--table" && arguments[0] != "--continuity" &&
                            arguments[0] != "--smoothing")) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  try {
    run(arguments[0], load({arguments.begin() + 1, arguments.end()}));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
