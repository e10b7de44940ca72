// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Memory for pictures that a player shares with its window.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <gst/video/video.h>

#include "plugin/window/view/messages.h"

namespace spidar {

/// Slots of one size for frames of one format, in a file without a name. A slot is taken by
/// copy(), and is free again when the window has said so. Thread-safe only where it says so.
class PictureSlots {
 public:
  /// As many as a window keeps: those that wait until they are on the screen, the one that is
  /// shown, and the one that comes.
  static constexpr uint32_t kSlots = 10;

  /// For frames like this one. When the system has no memory for it, is_there() is false.
  PictureSlots(uint32_t id, const GstVideoFrame& frame);
  ~PictureSlots();
  PictureSlots(const PictureSlots&) = delete;
  PictureSlots& operator=(const PictureSlots&) = delete;

  bool is_there() const { return memory_ != nullptr; }
  bool fits(const GstVideoFrame& frame) const;
  const PictureMemory& description() const { return description_; }
  int file() const { return file_; }

  /// The number of a free slot, which is taken from now on. Nothing when there is none.
  std::optional<uint32_t> take();
  void give_back(uint32_t slot);
  /// Copies into a slot that was taken. False when the frame cannot be read. May run beside every
  /// other function.
  bool copy(const GstVideoFrame& frame, uint32_t slot) const;

 private:
  GstVideoInfo info_;
  PictureMemory description_;
  int file_ = -1;
  uint8_t* memory_ = nullptr;
  std::vector<bool> taken_;
};

}  // namespace spidar
