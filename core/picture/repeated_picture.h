// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Detects frames that repeat the previous picture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/history.h"
#include "core/picture/image_view.h"

namespace spidar {

/// What a frame shows, compared with the picture before.
enum class Likeness : uint8_t {
  kFirst,    ///< there is nothing to compare with: the first one, another size, or a cut
  kWaiting,  ///< the same picture, and the motion may go on
  kSame,     ///< the same picture, which is at rest
  kAlike,    ///< the same picture, apart from the noise of coding
  kOther,    ///< another picture
};

/// Whether the picture before is shown again, be it waiting or at rest.
constexpr bool is_again(Likeness picture) {
  return picture != Likeness::kFirst && picture != Likeness::kOther;
}

/// Compares pictures of the same size. Identical pixels are always a repetition, but a lossy
/// encoder also changes a repeated picture slightly. These changes are small compared with those
/// between different pictures. In 24 pictures per second coded as 60 frames, by x264, x265, VP9 and
/// MPEG-4 from good to poor quality, the 16 × 16 px block with the largest change differed by at
/// most 8 grey levels in repeated pictures, and by at least 28 in others. A single block may be an
/// artefact of the encoder, so the mean over several of the most changed blocks is used. Their
/// number is small so that a small object still counts.
///
/// In a telecined film the encoder changes a repeated field by up to 0.41 of the change before it,
/// while different pictures change by at least 0.6 of it. The limit is therefore higher when the
/// cadence of the film predicts a repetition.
class RepeatedPicture {
 public:
  /// Compares `now` with `before`; both have 8 bits. Call for every frame, in order. kSame: the
  /// same pixels, kAlike or kOther.
  Likeness look(const ImageView& before, const ImageView& now);

  /// Call when the next pictures are unrelated to the previous ones.
  void reset() { changes_.clear(); }

  /// Largest coding noise, as a fraction of the change before and after it.
  static constexpr float kFraction = 0.3f;
  /// At least kLeastDips such dips must have occurred within kFrames frames, in whatever rhythm,
  /// because an object that slows down and reverses also causes one. 24 pictures per second in 30
  /// frames have two in ten.
  static constexpr int kLeastDips = 2;
  static constexpr size_t kFrames = 12;
  /// The limit for the noise if the changes one and two periods ago were as small relative to their
  /// neighbours: between the 0.41 and the 0.6 above. A period has at least two frames.
  static constexpr float kFractionWhenDue = 0.5f;

 private:
  /// Dips: runs of small changes between two large ones.
  struct Rhythm {
    int dips = 0;
    float large = 0;                     ///< latest large change
    std::array<bool, kFrames> is_dip{};  ///< by age in frames: whether the change was in a dip
  };
  Rhythm rhythm(float fraction) const;
  bool is_due(const Rhythm& rhythm) const;
  bool is_small(float change) const;

  History<float, kFrames> changes_;  ///< see largest_change()
};

/// Number of blocks that are averaged.
constexpr size_t kChangedBlocks = 8;

/// Mean absolute difference over the kChangedBlocks blocks with the largest difference, in grey
/// levels; 0 exactly when all pixels are equal. Blocks have 16 × 16 px, or less at the right and
/// bottom.
float largest_change(const ImageView& before, const ImageView& now);

}  // namespace spidar
