// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gst/video/video.h>

#include "plugin/window/view/messages.h"

namespace spidar::window {

/// Pictures in the memory that a player shares with its window: slots of one size for frames of one
/// format, in a file without a name. acquire() reserves a slot, which is free again when the window
/// has returned it. Thread-safe only where stated.
class PictureSlots {
 public:
  /// As many pictures as a window keeps: the waiting ones, the shown one, and the next one.
  static constexpr uint32_t kSlots = 10;

  /// Makes slots for frames like this one. Without memory for them, is_there() is false.
  PictureSlots(uint32_t id, const GstVideoFrame& frame);
  ~PictureSlots();
  PictureSlots(const PictureSlots&) = delete;
  PictureSlots& operator=(const PictureSlots&) = delete;

  bool is_there() const { return memory_ != nullptr; }
  bool fits(const GstVideoFrame& frame) const;
  const PictureMemory& description() const { return description_; }
  int file() const { return file_; }

  /// Takes a free slot and returns its number; nothing when there is none.
  std::optional<uint32_t> acquire();
  void release(uint32_t slot);
  /// Copies into a taken slot. Returns false when the frame cannot be read. Any thread.
  bool copy(const GstVideoFrame& frame, uint32_t slot) const;

 private:
  GstVideoInfo info_;
  PictureMemory description_;
  int file_ = -1;
  uint8_t* memory_ = nullptr;
  std::vector<bool> taken_;
};

/// The memory on the window's side, which is read-only there.
class MappedPictures {
 public:
  /// Takes over the file. When the file does not match the description, is_there() is false.
  MappedPictures(const PictureMemory& description, int file);
  ~MappedPictures();
  MappedPictures(const MappedPictures&) = delete;
  MappedPictures& operator=(const MappedPictures&) = delete;

  bool is_there() const { return memory_ != nullptr; }
  const PictureMemory& description() const { return description_; }
  const GstVideoInfo& info() const { return info_; }
  const uint8_t* slot(uint32_t number) const { return memory_ + number * description_.slot_bytes; }

 private:
  PictureMemory description_;
  GstVideoInfo info_;
  size_t bytes_ = 0;
  const uint8_t* memory_ = nullptr;
};

/// One picture in the memory, or none. When the last copy ends, `set_free` frees the slot.
class SharedPicture {
 public:
  SharedPicture() = default;
  SharedPicture(std::shared_ptr<const MappedPictures> memory, uint32_t slot,
                const std::function<void()>& set_free)
      : memory_(std::move(memory)),
        slot_(slot),
        held_(nullptr, [set_free](void*) { set_free(); }) {}

  bool is_there() const { return memory_ != nullptr; }
  const GstVideoInfo& info() const { return memory_->info(); }
  const uint8_t* pixels() const { return memory_->slot(slot_); }

 private:
  std::shared_ptr<const MappedPictures> memory_;
  uint32_t slot_ = 0;
  std::shared_ptr<void> held_;
};

}  // namespace spidar::window
