// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/picture/reduced_frame.h"

#include <utility>

namespace spidar {

PictureKind ReducedFrame::read(const ImageView& frame, bool may_wait) {
  require_usable(frame);
  const bool is_comparable = frame.width == width_ && frame.height == height_;
  width_ = frame.width;
  height_ = frame.height;
  factor_ = halving_factor(width_, height_);
  std::swap(before_, base_);
  reduce_blocks(frame, factor_, base_);
  base_.repeat_border();
  if (!is_comparable) {
    repeated_picture_.restart();
    return picture_ = PictureKind::kFirst;
  }
  picture_ = repeated_picture_.look(before_.view(), base_.view());
  if (picture_ == PictureKind::kAlike && may_wait) picture_ = PictureKind::kSame;
  if (picture_ == PictureKind::kSame) std::swap(before_, base_);
  return picture_;
}

}  // namespace spidar
