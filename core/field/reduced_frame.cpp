// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/reduced_frame.h"

#include <utility>

namespace spidar {

void ReducedFrame::read(const ImageView& frame, Repeats repeats) {
  require_usable(frame);
  is_comparable_ = frame.width == width_ && frame.height == height_;
  width_ = frame.width;
  height_ = frame.height;
  factor_ = halving_factor(width_, height_);
  std::swap(before_, base_);
  reduce_blocks(frame, factor_, base_);
  base_.repeat_border();
  is_repeated_ = false;
  is_alike_ = false;
  if (!is_comparable_) {
    repeated_picture_.restart();
    return;
  }
  using Kind = RepeatedPicture::Kind;
  const Kind kind = repeated_picture_.look(before_.view(), base_.view());
  is_repeated_ = kind == Kind::kSame || (kind == Kind::kAlike && repeats == Repeats::kAlike);
  is_alike_ = kind == Kind::kAlike && !is_repeated_;
  if (is_repeated_) std::swap(before_, base_);
}

}  // namespace spidar
