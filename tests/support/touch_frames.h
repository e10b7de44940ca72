// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frames for a touch::Mailbox, as the streaming thread publishes them.
#pragma once

#include <utility>

#include "spidar/touch/touch_rendering.h"

namespace spidar::test {

/// Whether the frame continues the previously published one.
enum class After { kCut, kFrame };

/// Publishes a frame with the heights z_m(x_m, y_m). Returns false when the mailbox is full.
template <typename Surface>
bool publish_surface(touch::Mailbox& mailbox, int64_t time_ns, After after, Surface&& z_m,
                     const touch::ContactSettings& contact = {}) {
  touch::Surface* const frame = mailbox.begin(mailbox.generation());
  if (frame == nullptr) return false;
  frame->time_ns = time_ns;
  frame->has_surface = true;
  frame->has_texture = false;
  frame->follows = after == After::kFrame;
  frame->displacement_m.setZero();
  frame->contact = contact;
  for (int y = 0; y < touch::HeightField::kRows; ++y) {
    for (int x = 0; x < touch::HeightField::kColumns; ++x) {
      frame->relief.row(y)[x] = static_cast<float>(z_m(frame->relief.x_m(x), frame->relief.y_m(y)));
    }
  }
  mailbox.publish();
  return true;
}

inline bool publish_plane(touch::Mailbox& mailbox, int64_t time_ns, double z_m,
                          After after = After::kCut, const touch::ContactSettings& contact = {}) {
  return publish_surface(
      mailbox, time_ns, after, [z_m](double, double) { return z_m; }, contact);
}

inline bool publish_nothing(touch::Mailbox& mailbox, int64_t time_ns) {
  touch::Surface* const frame = mailbox.begin(mailbox.generation());
  if (frame == nullptr) return false;
  frame->time_ns = time_ns;
  frame->has_surface = false;
  frame->follows = false;
  mailbox.publish();
  return true;
}

}  // namespace spidar::test
