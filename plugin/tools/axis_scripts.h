// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Six funscripts for the six channels of a track, as players of several axes read them.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "core/track/track_format.h"

namespace spidar {

struct AxisScript {
  std::string path;
  size_t channel;
};

/// "film.funscript" for the channel `main`, "film.surge.funscript" and so on for the others: those
/// of the names that MultiFunPlayer and others look for (surge forwards, sway sideways, twist about
/// the vertical, roll, pitch). The vertical force has the name of `main`.
std::array<AxisScript, kTrackChannels> axis_scripts(const std::string& path, size_t main);

}  // namespace spidar
