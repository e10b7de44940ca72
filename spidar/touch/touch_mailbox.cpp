// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/touch/touch_mailbox.h"

#include <stdexcept>
#include <string>

namespace spidar {

TouchMailbox::TouchMailbox(double width_m, double height_m, size_t slots) {
  if (slots < kLeastSlots) {
    throw std::invalid_argument("TouchMailbox: slots must be at least " +
                                std::to_string(kLeastSlots) + ", but is " + std::to_string(slots));
  }
  frames_.reserve(slots);
  for (size_t i = 0; i < slots; ++i) frames_.emplace_back(width_m, height_m);
}

TouchFrame* TouchMailbox::begin(uint32_t generation) noexcept {
  const size_t tail = tail_.load(std::memory_order_relaxed);
  if (tail - head_.load(std::memory_order_acquire) == frames_.size()) return nullptr;
  TouchFrame& frame = frames_[tail % frames_.size()];
  frame.generation = generation;
  return &frame;
}

void TouchMailbox::publish() noexcept {
  tail_.store(tail_.load(std::memory_order_relaxed) + 1, kRelease);
}

const TouchFrame* TouchMailbox::front(size_t nth) const noexcept {
  const size_t head = head_.load(std::memory_order_relaxed);
  if (tail_.load(std::memory_order_acquire) - head <= nth) return nullptr;
  return &frames_[(head + nth) % frames_.size()];
}

}  // namespace spidar
