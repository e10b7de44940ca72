// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <utility>

#include "core/picture/image_view.h"
#include "core/picture/padded_image.h"
#include "core/picture/repeated_picture.h"

namespace spidar {

/// Reduces each frame once, for all measurements of motion.
class ReducedFrame {
 public:
  /// Reduces `frame` and returns picture(). Skips a frame that repeats the previous picture, so
  /// that the next frame is compared with that picture. With `may_wait`, a frame that differs from
  /// the previous picture only by the noise of coding is skipped, too. Throws as require_usable()
  /// does.
  FrameComparison read(const ImageView& frame, bool may_wait = false) {
    require_usable(frame);
    const bool is_comparable = frame.width == width_ && frame.height == height_;
    width_ = frame.width;
    height_ = frame.height;
    factor_ = halving_factor(width_, height_);
    std::swap(before_, base_);
    reduce_blocks(frame, factor_, base_);
    base_.repeat_border();
    if (!is_comparable) {
      repeated_picture_.reset();
      return picture_ = FrameComparison::kFirst;
    }
    picture_ = repeated_picture_.compare(before_.view(), base_.view());
    if (picture_ == FrameComparison::kAlike && may_wait) picture_ = FrameComparison::kSame;
    if (picture_ == FrameComparison::kSame) std::swap(before_, base_);
    return picture_;
  }

  /// The mean of each factor() × factor() block of the frame, with a repeated border.
  const PaddedImage& base() const { return base_; }
  /// The same for the previous frame, if it is comparable.
  const PaddedImage& before() const { return before_; }
  int factor() const { return factor_; }
  int width() const { return width_; }  ///< of the frame, px
  int height() const { return height_; }
  /// kFirst after a frame of another size; kSame where this frame was skipped. Never kWaiting.
  FrameComparison picture() const { return picture_; }
  /// Which of the latest frames repeated a picture, as far as known.
  RepeatedPicture::Repeats repeats() const { return repeated_picture_.repeats(); }

  /// Call this for the first frame after a cut.
  void cut() { repeated_picture_.cut(); }
  void reset() { width_ = 0; }

 private:
  PaddedImage base_;
  PaddedImage before_;
  int factor_ = 1;
  int width_ = 0;
  int height_ = 0;
  FrameComparison picture_ = FrameComparison::kFirst;
  RepeatedPicture repeated_picture_;
};

}  // namespace spidar
