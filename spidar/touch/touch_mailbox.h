// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reliefs on their way from the streaming thread to the haptic loop.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/api.h"
#include "core/touch/contact_force.h"
#include "core/touch/height_field.h"

namespace spidar {

/// What can be touched of one frame.
struct TouchFrame {
  TouchFrame(double width_m, double height_m)
      : relief(width_m, height_m), texture(width_m, height_m) {}

  int64_t time_ns = 0;       ///< running time at which the frame is shown
  bool has_surface = false;  ///< false: from that time on there is nothing to be touched
  bool has_texture = false;  ///< false: `texture` says nothing
  /// `displacement_m` leads here from the frame that was published before this one. False after a
  /// cut, a seek, or a frame that was left out: nothing is known between the two.
  bool follows = false;
  Eigen::Vector2d displacement_m = Eigen::Vector2d::Zero();
  ContactSettings contact;  ///< valid
  HeightField relief;
  HeightField texture;
  uint32_t generation = 0;  ///< of the mailbox when this frame was begun
};

/// A queue of frames between one thread that writes and one that reads. Wait-free: neither waits
/// for the other, and none is copied. The writer fills a slot in place; the reader keeps the two
/// frames that it is between, so that three slots are the least. More are for frames that pass the
/// element long before they are shown: GStreamer's queues hold some of them before the sink.
class SPIDAR_API TouchMailbox {
 public:
  static constexpr size_t kLeastSlots = 3;

  /// The picture is `width_m` × `height_m` in the hand's space. Throws std::invalid_argument unless
  /// both are finite and above 0, and `slots` at least kLeastSlots. Takes 300 kB a slot; nothing
  /// else here allocates.
  TouchMailbox(double width_m, double height_m, size_t slots);
  TouchMailbox(const TouchMailbox&) = delete;
  TouchMailbox& operator=(const TouchMailbox&) = delete;

  size_t slots() const noexcept { return frames_.size(); }

  // --- any thread

  /// Every frame that is published or was begun before is forgotten by the reader's next look.
  void forget() noexcept { generation_.fetch_add(1, std::memory_order_acq_rel); }
  uint32_t generation() const noexcept { return generation_.load(std::memory_order_acquire); }

  // --- writer

  /// The slot to fill, with what was left in it; null when there is none free. A frame that is
  /// looked at since `generation` was the current one is of that generation.
  TouchFrame* begin(uint32_t generation) noexcept;
  /// Hands over what begin() returned.
  void publish() noexcept;

  // --- reader

  /// The oldest frame, or the `nth` after it; null when there is none. Valid until it is dropped.
  const TouchFrame* front(size_t nth = 0) const noexcept;
  /// Gives back front(), which must not be null.
  void drop() noexcept { head_.store(head_.load(std::memory_order_relaxed) + 1, kRelease); }

 private:
  static constexpr std::memory_order kRelease = std::memory_order_release;

  std::vector<TouchFrame> frames_;
  // Apart, so that writer and reader do not take each other's cache lines.
  alignas(64) std::atomic<size_t> head_{0};  ///< frames dropped
  alignas(64) std::atomic<size_t> tail_{0};  ///< frames published
  alignas(64) std::atomic<uint32_t> generation_{0};
};

}  // namespace spidar
