// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What OpenCV offers for motion between frames, to compare times with.
#pragma once

#include <memory>

#include "core/picture/image_view.h"

namespace spidar::bench {

/// The flow between successive frames of one size.
class Flow {
 public:
  virtual ~Flow() = default;

  /// Compares `frame`, whose picture stays until the next call, with the previous one.
  virtual void find(const ImageView& frame) = 0;
};

/// Flow of every pixel at a width of 480 px.
std::unique_ptr<Flow> make_dis_ultrafast();

}  // namespace spidar::bench
