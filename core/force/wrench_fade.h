// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A soft transition from the force of one object to that of another.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/wrench.h"

namespace spidar {

/// When another object is felt than before, or none any more, the last wrench fades out over
/// kFade_s while the new one fades in. An object that begins to move while nothing is felt is felt
/// at once and in full.
class WrenchFade {
 public:
  /// Begins a frame. `object` is what is felt in it: a number that is constant while the same is
  /// felt; 0: nothing, or the whole picture. Returns whether the last wrench begins to fade out.
  bool turn_to(uint64_t object);

  /// The wrench to be felt in this frame, `interval_s` > 0 after the one before, if `wrench` is
  /// that of the object.
  Wrench fade(const Wrench& wrench, double interval_s);

  /// After a cut or a seek, and when the picture rests: nothing fades.
  void reset() { *this = WrenchFade(); }

  /// Two or three frames of a film; shorter than the 0.15 s or so that a hand needs to react.
  static constexpr double kFade_s = 0.1;

 private:
  uint64_t object_ = 0;
  double old_share_ = 0;  ///< of `old_`; 0: nothing fades
  Wrench old_;
  Wrench felt_;  ///< in the last frame
};

inline bool WrenchFade::turn_to(uint64_t object) {
  const bool begins = object != object_ && object_ != 0;
  object_ = object;
  if (!begins) return false;
  old_ = felt_;
  old_share_ = 1;
  return true;
}

inline Wrench WrenchFade::fade(const Wrench& wrench, double interval_s) {
  old_share_ = std::max(0.0, old_share_ - interval_s / kFade_s);
  felt_ = old_share_ > 0 ? interpolate(wrench, old_, old_share_) : wrench;
  return felt_;
}

}  // namespace spidar
