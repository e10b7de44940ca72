// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The one thread of the process that speaks to GLFW and GL.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "plugin/window/debug_window.h"
#include "plugin/window/window.h"

namespace spidar {

/// What the window thread and the owner of a Window share. Guarded by the mutex of WindowThread,
/// but for `window`, which belongs to the thread.
struct Window::Entry {
  std::shared_ptr<WindowSource> source;
  std::shared_ptr<FrameFeed> feed;
  bool closing = false;
  bool gone = false;
  std::vector<std::function<void(DebugWindow&)>> requests;
  /// What callers of screenshot() wait for; null while nobody does. The next drawing takes it out
  /// of here before it begins and fills it, so a drawing that is under way does not answer a call.
  std::shared_ptr<std::optional<Screenshot>> screenshot;
  std::unique_ptr<DebugWindow> window;
};

/// Runs while there is a window. No lock is held while it draws.
class WindowThread {
 public:
  /// Never destroyed: a window system that hangs may keep the thread beyond the end of main().
  static WindowThread& instance();

  std::shared_ptr<Window::Entry> open(std::shared_ptr<WindowSource> source,
                                      std::shared_ptr<FrameFeed> feed);
  void close(const std::shared_ptr<Window::Entry>& entry);
  std::optional<Screenshot> screenshot(const std::shared_ptr<Window::Entry>& entry,
                                       std::chrono::milliseconds timeout);
  /// Done before the window is drawn next.
  void request(const std::shared_ptr<Window::Entry>& entry, std::function<void(DebugWindow&)> what);

 private:
  using Entries = std::vector<std::shared_ptr<Window::Entry>>;

  void start();
  void run();
  void serve();
  bool create(Window::Entry& entry);
  void draw(Window::Entry& entry);
  void finish(Window::Entry& entry);
  void fail_all(const std::string& what, const std::string& advice);

  std::mutex mutex_;
  std::condition_variable wake_;     // the thread, earlier than its next frame
  std::condition_variable changed_;  // whoever waits for it
  Entries entries_;
  bool running_ = false;
  std::thread thread_;
};

}  // namespace spidar
