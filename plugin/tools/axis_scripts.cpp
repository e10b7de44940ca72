// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/axis_scripts.h"

#include <filesystem>

#include "plugin/tools/track_samples.h"

namespace spidar {

std::array<AxisScript, kTrackChannels> axis_scripts(const std::string& path, size_t main) {
  // By channel: fx, fy, fz, tx, ty, tz. The first axis of a player is the vertical one.
  constexpr const char* kNames[kTrackChannels] = {".sway",  "",       ".surge",
                                                  ".pitch", ".twist", ".roll"};
  const std::filesystem::path whole = path;
  std::array<AxisScript, kTrackChannels> scripts;
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    const size_t place = channel == main ? kUsualAxis : channel == kUsualAxis ? main : channel;
    const std::string name = whole.stem().string() + kNames[place] + whole.extension().string();
    scripts[channel] = {(whole.parent_path() / name).string(), channel};
  }
  return scripts;
}

}  // namespace spidar
