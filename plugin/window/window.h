// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A debug window from outside: opened, looked at, closed.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin/window/model/frame_feed.h"
#include "plugin/window/model/mouse_hand.h"
#include "plugin/window/model/window_source.h"

namespace spidar {

/// RGB, rows from the top, without padding.
struct Screenshot {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
};

/// Empty, or why the file cannot be written.
std::string write_png(const Screenshot& picture, const std::string& path);

/// Whether this build has windows.
bool windows_are_built_in();

/// One window, drawn by the thread that all windows of the process share. Opening returns at once;
/// what goes wrong then is said by source->warn(). Any thread.
class Window {
 public:
  Window(std::shared_ptr<WindowSource> source, std::shared_ptr<FrameFeed> feed);
  /// Closes it. Waits for that, but no longer than kPatience: a window system that hangs holds up
  /// nobody else.
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  static constexpr std::chrono::milliseconds kPatience{1000};

  /// What the window shows once it has drawn all that it was given before this call. Nothing when
  /// there is no window or it does not answer in time.
  std::optional<Screenshot> screenshot(std::chrono::milliseconds timeout);

  /// In pixels of the screen; for tests.
  void resize(int width, int height);
  /// As if the user had pressed a key of GLFW; for tests.
  void press(int key);
  /// As if the mouse was so, until the next call; for tests.
  void set_mouse(const Mouse& mouse);

  struct Entry;

 private:
  std::shared_ptr<Entry> entry_;
};

}  // namespace spidar
