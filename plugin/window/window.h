// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <Eigen/Core>
#include <gst/video/video.h>

#include "plugin/window/view/messages.h"

namespace spidar::window {

/// What a window needs from the player, called on the thread of the Window only. messages.h
/// describes the requests.
class Source {
 public:
  virtual ~Source() = default;

  /// Does nothing when the element is gone.
  virtual void read(ElementState& state) = 0;
  virtual void set(const std::string& setting, double value) = 0;
  virtual void load_preset(const std::string& name) = 0;
  virtual void lead_hand(const std::optional<Eigen::Vector3d>& to_m) = 0;
  virtual void choose(const std::optional<Eigen::Vector2d>& position) = 0;
  /// Saves the choices as rules, which hold from then on.
  virtual ChoicesSaved save(const std::string& film, const std::vector<FeelEdit>& edits) = 0;
  /// Requests that the player plays or pauses, which it may refuse.
  virtual void play(bool plays) = 0;
  /// Does nothing where the player cannot seek, as in live video.
  virtual void seek(int64_t to_ns) = 0;
  /// The window cannot be opened, or has failed: `what` says what happened, `advice` what to do.
  virtual void warn(const std::string& what, const std::string& advice) = 0;
  /// Called when the window was closed, but not by Window::close().
  virtual void closed() = 0;
};

/// One window, which is a process of its own (spidar-window), from the player's side. Opening
/// returns at once; source->warn() reports later errors. Neither a slow nor a crashing window
/// delays the player, whose own use of GL, GLFW or X it does not touch.
class Window {
 public:
  explicit Window(std::shared_ptr<Source> source);
  ~Window() { close(); }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  static constexpr std::chrono::milliseconds kCloseTimeout{1000};

  // --- streaming thread, which waits for nothing here

  /// Whether queue_frame() has a free slot for a picture.
  bool wants_frame() const;
  /// Copies the frame. Returns false when the window is too slow for it or there is no memory.
  bool queue_frame(const GstVideoFrame& frame, DrawnFrame report);

  // --- any thread

  /// Waits until the window is closed; after kCloseTimeout, it is killed. Does not wait when the
  /// window's own thread calls this, nor for ever when that thread waits for the caller.
  void close();
  /// Writes what the window shows, with everything it was given before, to a PNG file. Returns an
  /// empty string, or why that fails.
  std::string take_picture(const std::string& path, std::chrono::milliseconds timeout);
  void input(const UserInput& input);

 private:
  class Session;
  std::shared_ptr<Session> session_;
  std::thread thread_;
};

}  // namespace spidar::window
