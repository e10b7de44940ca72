// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frames from the streaming thread to a window, of which neither waits for the other.
#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <memory>
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

/// Copies are made only of the next kMost frames after the window has asked, which it does whenever
/// it draws: all that it can show in time even when it draws slowly, and none while it is frozen or
/// gone.
class FrameFeed {
 public:
  static constexpr size_t kMost = 4;

  // --- streaming thread

  bool wanted() const noexcept { return wanted_.load(std::memory_order_acquire) > 0; }
  /// Copies. False when the window is just looking, or there is no memory: the next frame will do.
  bool give(const GstVideoFrame& frame, const FrameFacts& facts);

  // --- window thread

  void want() noexcept { wanted_.store(kMost, std::memory_order_release); }
  /// The oldest of the last kMost. False when there is none.
  bool take(PictureCopy& picture, FrameFacts& facts);

 private:
  struct Entry {
    PictureCopy picture;
    FrameFacts facts;
  };
  std::atomic<size_t> wanted_{0};
  std::unique_ptr<Entry> back_;  // streaming thread
  std::mutex mutex_;
  std::deque<std::unique_ptr<Entry>> ready_;
  std::unique_ptr<Entry> spare_;  // whose memory is used again
};

}  // namespace spidar
