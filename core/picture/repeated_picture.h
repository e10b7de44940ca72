// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/history.h"
#include "core/picture/image_view.h"

namespace spidar {

/// What a frame shows, compared with the previous picture.
enum class FrameComparison : uint8_t {
  kFirst,    ///< there is nothing to compare with: the first frame, another size, or a cut
  kWaiting,  ///< the same picture, and the motion may continue
  kSame,     ///< the same picture, which is at rest
  kAlike,    ///< the same picture, apart from the noise of coding
  kOther,    ///< another picture
};

/// Whether the frame repeats the previous picture, waiting or at rest.
constexpr bool is_again(FrameComparison picture) {
  return picture != FrameComparison::kFirst && picture != FrameComparison::kOther;
}

/// Detects frames that repeat the previous picture, by comparing pictures of the same size.
/// Identical pixels are always a repetition, but a lossy encoder also changes a repeated picture
/// slightly. These changes are small compared with those between different pictures. In 24 pictures
/// per second coded as 60 frames, by x264, x265, VP9 and MPEG-4 from good to poor quality, the 16 ×
/// 16 px block with the largest change differed by at most 8 grey levels in repeated pictures, and
/// by at least 28 in others. A single block may be an artefact of the encoder, so the mean over
/// several of the most changed blocks is used. Their number is small so that a small object still
/// counts.
///
/// Good encoders hardly change a repeated picture at all, see kFractionAtOnce: such a repetition is
/// recognised without a rhythm.
///
/// In a telecined film the encoder changes a repeated field by up to 0.41 of the change before it,
/// while different pictures change by at least 0.6 of it. The limit is therefore higher when the
/// cadence of the film predicts a repetition.
class RepeatedPicture {
 public:
  /// Compares `now` with `before`; both have 8 bits. Call this for every frame, in order. kSame:
  /// the same pixels, kAlike or kOther.
  FrameComparison compare(const ImageView& before, const ImageView& now);

  /// Call this when the next pictures are unrelated to the previous ones.
  void reset() {
    changes_.clear();
    had_rhythm_ = false;
  }

  /// Tells that the latest picture was the first one after a cut: its change says nothing about a
  /// motion. A film that has repeated pictures will probably continue to do so.
  void cut();

  static constexpr size_t kFrames = 12;
  /// Which of the latest frames, the newest first, repeated the previous picture, as far as known;
  /// compare() may not have known it yet. More than kMaxAtOnce in a row do not count as
  /// repetitions: when several titles appear, all motion after each of them is small in comparison.
  using Repeats = std::array<bool, kFrames>;
  Repeats repeats() const;

  /// The largest coding noise, as a fraction of the change before and after it.
  static constexpr float kFraction = 0.3f;
  /// At least kMinDips such dips must have occurred within kFrames frames, in any rhythm, because
  /// an object that slows down and reverses also causes one. 24 pictures per second in 30 frames
  /// have two in ten.
  static constexpr int kMinDips = 2;
  /// The limit for the noise if the changes one and two periods ago were as small relative to their
  /// neighbours: between the 0.41 and the 0.6 above. A period has at least two frames.
  static constexpr float kFractionWhenDue = 0.5f;
  /// The limit for the noise without any dip, as a fraction of both large changes before it:
  /// compared with the change when a title appears, all motion is small. In real films, x264 at crf
  /// 20 leaves 0.01 to 0.03 of the change before it in a repeated picture. A swing that turns
  /// between two pictures may change as little, and is then held for a frame: at this limit, and
  /// where a picture changes in proportion to its displacement, one turn in 16.
  static constexpr float kFractionAtOnce = 0.03f;
  /// The number of frames after a large change in which that limit holds: a picture of 24 in 60
  /// frames, or one drawn on threes, is repeated twice. With more frames, a picture that comes to
  /// rest all at once would wait in vain.
  static constexpr size_t kMaxAtOnce = 2;

 private:
  /// Dips: runs of small changes between two large ones.
  struct Rhythm {
    int dips = 0;
    float large = 0;         ///< the latest large change
    float large_before = 0;  ///< the one before it
    size_t large_age = 0;    ///< how many frames ago the latest one was
    Repeats is_dip{};        ///< whether the change was in a dip
  };
  Rhythm rhythm(float fraction) const;
  bool is_due(const Rhythm& rhythm) const;
  bool is_small(float change) const;

  History<float, kFrames> changes_;  ///< see largest_change()
  bool had_rhythm_ = false;          ///< whether there was a rhythm before the cut
};

constexpr size_t kChangedBlocks = 8;

/// Mean absolute difference over the kChangedBlocks blocks with the largest difference, in grey
/// levels; 0 exactly when all pixels are equal. Blocks have 16 × 16 px or less.
float largest_change(const ImageView& before, const ImageView& now);

}  // namespace spidar
