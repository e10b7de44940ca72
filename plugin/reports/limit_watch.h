// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Why nothing is felt: reasons of the video, the playback and the device together.
#pragma once

#include <mutex>
#include <optional>

#include <gst/gst.h>

#include "core/analysis/motion_analyzer.h"
#include "core/analysis/no_force_reason.h"
#include "spidar/loop/tick_record.h"

namespace spidar {

/// A reason of the device or of the playback, which holds whatever the video shows; kNone when
/// there is none. A device that is off because nothing was to be felt for minutes is none: it comes
/// back with the force.
NoForceReason limit_of_device(const LoopSnapshot& loop, bool muted);

/// The reason in the contact of the last tick, while `touch` is on and nothing has been felt for a
/// second; kNone before. `can_touch`: see GripAbilities.
NoForceReason limit_of_contact(const LoopSnapshot& loop, bool can_touch);

/// Thread-safe.
class LimitWatch {
 public:
  /// A frame that the sink shows at the running time `shown_ns`, with its wrench, and the reason
  /// for one that is too weak to feel.
  void add(int64_t shown_ns, const Wrench& wrench, NoForceReason limit);
  /// Running time begins anew.
  void forget();
  void set_muted(bool muted);
  /// The picture is touched: from now on the reasons are those of the contact, not of the video.
  void set_touching(bool touching);
  /// Of the device that is open.
  void set_can_touch(bool can_touch);

  /// Of the last second up to the frame added last, or to the picture on the screen when that is
  /// `up_to_screen`. `loop` is nothing while no device is open: then the reasons of the video come
  /// first, for the device is missing by choice. What is touched is that of the last tick.
  NoForceReason limit(const std::optional<LoopSnapshot>& loop, bool up_to_screen) const;

 private:
  mutable std::mutex mutex_;
  NoForceHistory frames_;
  int64_t newest_ns_ = 0;
  bool muted_ = false;
  bool touching_ = false;
  bool can_touch_ = true;
};

/// Adds limit (string, see nick()) and, unless that is "none", limit-reason (string: a sentence).
void describe_limit(NoForceReason limit, GstStructure* structure);

}  // namespace spidar
