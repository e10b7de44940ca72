// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The plugin built without GLFW or Dear ImGui.
#include <gtest/gtest.h>

#include "plugin/window/window.h"
#include "tests/support/element_harness.h"
#include "tests/support/video_frames.h"

namespace spidar::test::no_window_test {
namespace {

TEST(NoWindow, IsOneWarningAndTheVideoGoesOn) {
  EXPECT_FALSE(windows_are_built_in());
  ElementHarness h("device=none debug-window=true");
  h.set_caps(make_caps("GRAY8", 64, 48));
  EXPECT_EQ(h.push_moved(0, 0, 0), GST_FLOW_OK);
  EXPECT_EQ(h.motions().size(), 1u);
  ASSERT_EQ(h.warnings().size(), 1u);
  EXPECT_NE(h.warnings()[0].find("no debug window"), std::string::npos) << h.warnings()[0];
  gboolean saved = TRUE;
  g_signal_emit_by_name(h.element(), "save-window", "/tmp/none.png", &saved);
  EXPECT_FALSE(saved);
}

}  // namespace
}  // namespace spidar::test::no_window_test
