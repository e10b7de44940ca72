// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/force/wrench_fade.h"

#include <algorithm>

namespace spidar {

bool WrenchFade::turn_to(uint64_t object) {
  const bool begins = object != object_ && object_ != 0;
  object_ = object;
  if (!begins) return false;
  old_ = felt_;
  old_share_ = 1;
  return true;
}

Wrench WrenchFade::fade(const Wrench& wrench, double interval_s) {
  old_share_ = std::max(0.0, old_share_ - interval_s / kFade_s);
  felt_ = old_share_ > 0 ? interpolate(wrench, old_, old_share_) : wrench;
  return felt_;
}

}  // namespace spidar
