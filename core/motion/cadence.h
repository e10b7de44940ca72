// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/history.h"
#include "core/picture/repeated_picture.h"

namespace spidar {

/// Finds the cadence with which a film shows new pictures. A moving film can repeat pictures: 24
/// pictures a second in 60 frames, a cartoon drawn on twos, a late frame that was shown twice. The
/// motion is the displacement between two different pictures, divided by the time between them.
///
/// That time differs from the time between their first frames when pictures taken at even
/// intervals are shown at another frame rate: 24 pictures a second in 60 frames are shown for three
/// and two frames in turn (3:2 pulldown). This class estimates the true interval from the latest
/// ones. It also decides how long a repeated picture still counts as moving, and when the picture
/// counts as at rest.
class Cadence {
 public:
  /// A picture that has been shown for this long is at rest, unless longer intervals have been
  /// seen. Together with the 15 ms in which the force of a late frame fades in
  /// (WrenchTimeline::kApproach_ns) this is 100 ms.
  static constexpr int64_t kRest_ns = 85'000'000;
  /// Pictures further apart than this are not compared: a cartoon drawn on threes, plus one frame.
  static constexpr int64_t kLongest_ns = 2 * kRest_ns;
  static constexpr size_t kPictures = 24;

  /// How a frame is treated.
  struct Step {
    /// Whether the frame repeats a picture that may still be moving: the previous force continues.
    bool waits = false;
    /// If not `waits`: the duration of the motion, > 0.
    int64_t interval_ns = 0;
    /// The time between the first frames of the two pictures, > 0.
    int64_t shown_for_ns = 0;
  };

  /// Whether a picture that is repeated at `time_ns` would have to wait.
  bool would_wait(int64_t time_ns) const;

  /// Adds the frame shown at `time_ns`. The times must increase, and the first frame after reset()
  /// goes to cut() instead. `picture` is kSame, kOther, or kAlike, which here means a repeated
  /// picture that has waited long enough to be analysed. `repeats` marks the kOther frames that
  /// turned out to repeat the previous picture, newest (this frame) first.
  Step update(FrameComparison picture, int64_t time_ns,
              const RepeatedPicture::Repeats& repeats = {});

  /// When the latest picture was first shown.
  int64_t picture_ns() const { return picture_ns_; }

  /// Adds the first picture after a cut: the motion begins anew, but the cadence is kept.
  void cut(int64_t time_ns);

  void reset() { *this = Cadence(); }

 private:
  /// A picture that was followed by another one.
  struct Shown {
    int64_t interval_ns = 0;  ///< from its first frame to that of the next picture
    int frames = 1;           ///< the number of frames that showed the picture
  };

  void add_interval(const Shown& shown);
  void merge_split_intervals(const RepeatedPicture::Repeats& repeats);
  bool has_repeats() const;
  int64_t expected_ns() const;
  int64_t median_ns() const;
  bool is_alike_but_for_one(int64_t interval_ns) const;
  double even_interval_ns(size_t pictures) const;
  int64_t cadence_ns() const;

  History<Shown, kPictures> shown_;
  int64_t picture_ns_ = 0;    ///< when the latest picture was first shown
  int64_t frame_ns_ = 0;      ///< the latest frame
  int frames_ = 0;            ///< frames that have shown the latest picture
  bool has_changed_ = false;  ///< whether there was another picture since the cut
};

}  // namespace spidar
