// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frames from the streaming thread to a window, of which neither waits for the other.
#pragma once

#include <atomic>
#include <mutex>

#include <gst/video/video.h>

#include "plugin/window/model/window_model.h"

namespace spidar {

/// A frame's pixels in memory of our own, so that nobody's buffer is held.
class PictureCopy {
 public:
  PictureCopy() = default;
  ~PictureCopy();
  PictureCopy(const PictureCopy&) = delete;
  PictureCopy& operator=(const PictureCopy&) = delete;
  friend void swap(PictureCopy& a, PictureCopy& b) noexcept;

  /// False when there is no memory.
  bool copy(const GstVideoFrame& frame);
  bool empty() const { return buffer_ == nullptr; }
  const GstVideoInfo& info() const { return info_; }
  GstBuffer* buffer() const { return buffer_; }

 private:
  GstVideoInfo info_{};
  GstBuffer* buffer_ = nullptr;
};

/// Copies are made only when the window has asked for one, which it does after it has drawn the one
/// before: never faster than the screen, and not at all while the window is frozen or gone.
class FrameFeed {
 public:
  // --- streaming thread

  bool wanted() const noexcept { return wanted_.load(std::memory_order_acquire); }
  /// Copies. False when the window is just looking, or there is no memory: the next frame will do.
  bool give(const GstVideoFrame& frame, const FrameFacts& facts);

  // --- window thread

  void want() noexcept { wanted_.store(true, std::memory_order_release); }
  /// False when nothing has come since the last call.
  bool take(PictureCopy& picture, FrameFacts& facts);

 private:
  struct Entry {
    PictureCopy picture;
    FrameFacts facts;
  };
  std::atomic<bool> wanted_{false};
  Entry back_;  // streaming thread
  std::mutex mutex_;
  Entry ready_;
  bool fresh_ = false;
};

}  // namespace spidar
