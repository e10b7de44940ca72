// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/history.h"
#include "core/picture/repeated_picture.h"

namespace spidar {

/// Finds the rhythm in which a film shows new pictures. A film can move although its frames repeat
/// pictures: 24 pictures a second in 60 frames, a cartoon drawn on twos, a late frame that was
/// shown twice. The motion is the displacement between two different pictures, divided by the time
/// between them.
///
/// That time is not the one between their first frames when the pictures were taken at even
/// intervals and each is shown when a frame is due: 24 pictures a second in 60 frames are shown for
/// three and two frames in turn. This class learns the right time from the latest intervals. It
/// also decides how long a repeated picture may still belong to a motion, and from when on it is at
/// rest.
class Cadence {
 public:
  /// A picture that has been shown for this long is at rest, unless longer intervals have been
  /// seen. Together with the 15 ms in which the force of a late frame fades in
  /// (WrenchTimeline::kApproach_ns) this is 100 ms.
  static constexpr int64_t kRest_ns = 85'000'000;
  /// Pictures further apart are not compared. This is a cartoon drawn on threes, plus a frame.
  static constexpr int64_t kLongest_ns = 2 * kRest_ns;
  static constexpr size_t kPictures = 24;

  /// How a frame is treated.
  struct Step {
    /// Whether the frame repeats the picture, perhaps not at rest: the previous force continues.
    bool waits = false;
    /// Otherwise, the time in which the motion happened, > 0.
    int64_t interval_ns = 0;
    /// The time between the first frames of the two pictures, > 0.
    int64_t shown_for_ns = 0;
  };

  /// Whether a picture that is repeated at `time_ns` would have to wait.
  bool would_wait(int64_t time_ns) const;

  /// Takes the frame shown at `time_ns`, which must rise; the first frame after reset() goes to
  /// cut(). `picture` is kSame; kAlike for a picture that has waited long enough to be analysed; or
  /// kOther. `repeats` tells which earlier kOther frames turned out to repeat their previous
  /// picture, this frame first.
  Step see(Likeness picture, int64_t time_ns, const RepeatedPicture::Repeats& repeats = {});

  /// When the latest picture was first shown.
  int64_t picture_ns() const { return picture_ns_; }

  /// Takes the first picture after a cut: the motion begins anew, but the rhythm remains.
  void cut(int64_t time_ns);

  void reset() { *this = Cadence(); }

 private:
  /// A picture that was followed by another one.
  struct Shown {
    int64_t interval_ns = 0;  ///< from its first frame to that of the next picture
    int frames = 1;           ///< that have shown it
  };

  void remember(const Shown& shown);
  void join_pieces(const RepeatedPicture::Repeats& repeats);
  bool knows_repeats() const;
  int64_t expected_ns() const;
  int64_t median_ns() const;
  bool is_alike_but_for_one(int64_t interval_ns) const;
  double even_interval_ns(size_t pictures) const;
  int64_t learnt_ns() const;

  History<Shown, kPictures> shown_;
  int64_t picture_ns_ = 0;    ///< when the latest picture was first shown
  int64_t frame_ns_ = 0;      ///< the latest frame
  int frames_ = 0;            ///< frames that have shown the latest picture
  bool has_changed_ = false;  ///< whether there was another picture since the cut
};

}  // namespace spidar
