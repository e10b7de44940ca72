// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// In what rhythm a film shows new pictures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/api.h"

namespace spidar {

/// A film whose frames repeat pictures moves all the same: 24 pictures a second in 60 frames, a
/// cartoon drawn on twos, a frame that came too late and was shown once more. Its motion is what
/// happened between two different pictures, over the time between them.
///
/// That time is not the one between showing them, if the pictures were taken at even intervals and
/// are shown when a frame is due: 24 in 60 are shown for three frames and for two in turns. This
/// class learns from the latest intervals which it is. And it says how long a picture that is shown
/// again may still belong to something that moves, and from when on it is rest.
class SPIDAR_API Cadence {
 public:
  /// A picture that was shown for so long rests, where no longer intervals have been seen: with
  /// the 15 ms in which the force of a late frame fades in (WrenchTimeline::kApproach_ns) that is
  /// 100 ms.
  static constexpr int64_t kRest_ns = 85'000'000;
  /// Pictures further apart than this do not make a motion: drawings on threes, and a frame.
  static constexpr int64_t kLongest_ns = 170'000'000;

  /// What a frame shows.
  enum class Picture {
    kSame,   ///< the picture before
    kAlike,  ///< one that noise alone may have made of it, looked at because it waited long enough
    kOther,  ///< another one
  };

  /// What becomes of a frame.
  struct Step {
    /// It shows the picture before again, and nobody can tell yet whether that rests: what was felt
    /// before is to be felt on.
    bool waits = false;
    /// Otherwise: the time in which its motion happened, > 0.
    int64_t interval_ns = 0;
  };

  /// Whether a picture that is shown again at `time_ns` would have to wait.
  bool would_wait(int64_t time_ns) const;

  /// A frame is shown at `time_ns`, later than those before.
  Step see(Picture picture, int64_t time_ns);

  /// By what the speed that was found with the interval of the last Step is to be multiplied. A
  /// frame may have been repeated because the one after it was lost: then the picture has moved on
  /// meanwhile, and the interval is that of showing. Which of the two it was is told by the speed
  /// itself, which is near to the last one. To be called once for each Step that does not wait.
  double correction(double speed_px_s);

  /// When the latest picture was first shown.
  int64_t picture_ns() const { return picture_ns_; }

  /// The next frame is the first picture after a cut: nothing is known of what moves, but the
  /// rhythm is the film's.
  void cut(int64_t time_ns);

  /// Nothing is known.
  void restart() { *this = Cadence(); }

 private:
  static constexpr size_t kPictures = 24;

  /// A picture that was followed by another one.
  struct Shown {
    int64_t interval_ns = 0;
    int frames = 1;
  };

  const Shown& latest(size_t i) const { return shown_[(newest_ + kPictures - i) % kPictures]; }
  void remember(const Shown& shown);
  int64_t median_ns() const;
  int64_t expected_ns() const;
  double even_interval_ns() const;
  double even_interval_ns(size_t pictures) const;

  std::array<Shown, kPictures> shown_{};
  size_t count_ = 0;
  size_t newest_ = 0;

  bool begun_ = false;
  int64_t picture_ns_ = 0;    ///< when the latest picture was first shown
  int64_t frame_ns_ = 0;      ///< the latest frame
  int frames_ = 0;            ///< that have shown the latest picture
  bool has_changed_ = false;  ///< there has been another picture since the cut
  bool rests_ = false;        ///< it was shown for too long to belong to something that moves
  Step step_;                 ///< the last one that did not wait
  int64_t shown_for_ns_ = 0;  ///< of that, between the pictures
  double speed_px_s_ = 0;     ///< found then, corrected
};

}  // namespace spidar
