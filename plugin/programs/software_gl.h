// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>
#include <unistd.h>

#include <glib.h>

namespace spidar {

/// Keeps players from choosing glimagesink when there is no graphics card: OpenGL then draws on the
/// processor, and the film stalls, because a picture of 1080 lines takes 2.8 times as long as with
/// ximagesink (user time of 40 pictures on Xvfb). Call this before gst_init(). Returns a text for
/// the user; empty when nothing was changed, for example because the user has set the ranks of the
/// sinks.
inline std::string avoid_software_gl() {
  constexpr const char* kRanks = "GST_PLUGIN_FEATURE_RANK";
  const auto is_there = [](const char* path) { return access(path, F_OK) == 0; };
  // The nodes for drawing of the first card, and of NVIDIA's own driver.
  if (is_there("/dev/dri/renderD128") || is_there("/dev/nvidiactl") || g_getenv(kRanks)) return {};
  g_setenv(kRanks, "glimagesink:NONE", TRUE);
  return "there is no graphics card, so the film is shown without OpenGL";
}

}  // namespace spidar
