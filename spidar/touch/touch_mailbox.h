// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Queue of reliefs from the streaming thread to the haptic loop.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/touch/contact_force.h"
#include "core/touch/height_field.h"

namespace spidar {

/// The touchable surface of one frame.
struct TouchFrame {
  TouchFrame(double width_m, double height_m)
      : relief(width_m, height_m), texture(width_m, height_m) {}

  int64_t time_ns = 0;       ///< running time at which the frame is shown
  bool has_surface = false;  ///< false: nothing can be touched from that time on
  bool has_texture = false;  ///< false: `texture` is not valid
  /// Whether `displacement_m` is the motion since the previously published frame. False after a
  /// cut, a seek, or a frame that was left out, where the motion in between is unknown.
  bool follows = false;
  Eigen::Vector2d displacement_m = Eigen::Vector2d::Zero();
  ContactSettings contact;  ///< valid
  HeightField relief;
  HeightField texture;
  uint32_t generation = 0;  ///< of the mailbox when begin() was called
};

/// A wait-free single-producer, single-consumer queue that copies no frames. The writer fills a
/// slot in place and the reader keeps the two frames it interpolates between, so at least three
/// slots are needed. More slots allow for frames that pass the element long before they are shown,
/// because GStreamer's queues hold some of them before the sink.
class TouchMailbox {
 public:
  static constexpr size_t kLeastSlots = 3;

  /// The picture measures `width_m` × `height_m` in the device frame. Throws std::invalid_argument
  /// unless both are finite and above 0, and `slots` is at least kLeastSlots. Allocates 300 kB per
  /// slot; no other method allocates.
  TouchMailbox(double width_m, double height_m, size_t slots);
  TouchMailbox(const TouchMailbox&) = delete;
  TouchMailbox& operator=(const TouchMailbox&) = delete;

  size_t slots() const noexcept { return frames_.size(); }

  // --- any thread

  /// Makes the reader discard, at its next tick, every frame published or begun before this call.
  void forget() noexcept { generation_.fetch_add(1, std::memory_order_acq_rel); }
  uint32_t generation() const noexcept { return generation_.load(std::memory_order_acquire); }

  // --- writer

  /// Returns the slot to fill, with its old content, or null when none is free. Pass the generation
  /// that was current when processing of the frame began.
  TouchFrame* begin(uint32_t generation) noexcept;
  /// Publishes the slot that begin() returned.
  void publish() noexcept;

  // --- reader

  /// Returns the oldest frame or the `nth` after it, null if there is none. Valid until dropped.
  const TouchFrame* front(size_t nth = 0) const noexcept;
  /// Releases the slot of front(), which must not be null.
  void drop() noexcept { head_.store(head_.load(std::memory_order_relaxed) + 1, kRelease); }

 private:
  static constexpr std::memory_order kRelease = std::memory_order_release;

  std::vector<TouchFrame> frames_;
  // On separate cache lines, to avoid false sharing between writer and reader.
  alignas(64) std::atomic<size_t> head_{0};  ///< number of frames dropped
  alignas(64) std::atomic<size_t> tail_{0};  ///< number of frames published
  alignas(64) std::atomic<uint32_t> generation_{0};
};

}  // namespace spidar
