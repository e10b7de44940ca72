// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frames that have passed the element and are not on the screen yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "plugin/window/program/model/shared_picture.h"
#include "plugin/window/view/window_view.h"

namespace spidar {

struct WindowFrame {
  SharedPicture picture;
  FrameFacts facts;
};

/// The element sees a frame before the sink shows it, and the grip feels it when the sink does:
/// what a window draws beside the grip waits here until then.
class FrameQueue {
 public:
  /// With more of them, as between the element and a sink with a long queue, the oldest is shown
  /// although it is not on the screen yet.
  static constexpr size_t kMost = 8;

  /// An earlier running time than before is another stream, or a seek: all that waits is forgotten.
  void add(WindowFrame frame);
  /// The newest frame that is on the screen at this running time; without one, while nothing is
  /// felt, the newest of all. Nothing when there is no other than before.
  std::optional<WindowFrame> show(std::optional<int64_t> running_ns);

 private:
  std::deque<WindowFrame> waiting_;
};

}  // namespace spidar
