// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Whether a frame shows the picture before once more.
#pragma once

#include <array>
#include <cstddef>

#include "core/image_view.h"

namespace spidar {

/// Compares pictures of one size. The same pixels are the same picture. Coding adds to that: the
/// encoder spends its bits on the picture that is shown again, too. What it changes is little
/// beside what changes from one picture to the next: in 24 pictures a second that were coded as 60
/// frames, by x264, x265, VP9 and MPEG-4 from good to poor quality, the block of 16 × 16 px that
/// changed most changed by 8 grey levels at most where a picture was repeated, and by 28 at least
/// where not. A single block may be an accident of the encoder, so the mean of some of those that
/// changed most is looked at; and not more of them, so that a small object counts.
///
/// In a telecined film the encoder has more to do: what it changes in a repeated field is up to
/// 0.41 of the change before, where different pictures change by 0.6 of it and more. So where the
/// rhythm of the film says that a picture is repeated, less is asked.
class RepeatedPicture {
 public:
  enum class Kind {
    kSame,       ///< the same pixels
    kAlike,      ///< within the noise of coding
    kDifferent,  ///< another picture
  };

  /// Of `now`, with respect to `before`; both of 8 bits. Each frame is to be shown to it, in order.
  Kind look(const ImageView& before, const ImageView& now);

  /// The next pictures have nothing to do with those before.
  void restart() { count_ = 0; }

  /// The noise of coding is at most this share of the change before it and of the one after it.
  static constexpr float kShare = 0.3f;
  /// Among so many frames there must have been kDips changes like that: something that slows down
  /// and turns round is one, too. 24 pictures a second in 30 frames have two in ten.
  static constexpr size_t kFrames = 12;
  static constexpr int kDips = 2;
  /// The noise may be this share where the changes one period and two periods of the rhythm ago, of
  /// two frames or more, were as small beside those around them.
  static constexpr float kShareWhenDue = 0.5f;

 private:
  /// Dips: runs of small changes between two large ones.
  struct Rhythm {
    int dips = 0;
    float large = 0;                     ///< the latest large change
    std::array<bool, kFrames> is_dip{};  ///< whether the change so many frames ago was in a dip
  };
  Rhythm rhythm(float share) const;
  bool is_due(const Rhythm& rhythm) const;
  bool is_small(float change) const;
  float latest(size_t i) const { return changes_[(next_ + 2 * kFrames - 1 - i) % kFrames]; }

  std::array<float, kFrames> changes_{};  ///< see largest_change()
  size_t count_ = 0;
  size_t next_ = 0;
};

/// So many blocks say how much has changed.
constexpr size_t kChangedBlocks = 8;

/// Mean absolute difference of the kChangedBlocks blocks of 16 × 16 px, or less at the right and
/// the bottom, in which it is largest, grey levels; 0 exactly when all pixels are the same.
float largest_change(const ImageView& before, const ImageView& now);

namespace plain {
float largest_change(const ImageView& before, const ImageView& now);
}

}  // namespace spidar
