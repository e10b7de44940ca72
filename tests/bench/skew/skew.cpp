// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/skew/skew.h"

#include <cmath>

void Skew::shown(int64_t frame_ns, int64_t monotonic_ns) {
  const auto felt = felt_.find(frame_ns);
  if (felt == felt_.end()) return keep(shown_, frame_ns, monotonic_ns);
  join(felt->second, monotonic_ns);
  felt_.erase(felt);
}

void Skew::felt(int64_t frame_ns, int64_t monotonic_ns) {
  if (frame_ns == last_felt_ns_) return;
  last_felt_ns_ = frame_ns;
  const auto shown = shown_.find(frame_ns);
  if (shown == shown_.end()) return keep(felt_, frame_ns, monotonic_ns);
  join(monotonic_ns, shown->second);
  shown_.erase(shown);
}

void Skew::join(int64_t force_ns, int64_t picture_ns) {
  const double skew_ms = 1e-6 * static_cast<double>(force_ns - picture_ns);
  signed_ms_.add(skew_ms);
  size_ms_.add(std::abs(skew_ms));
}

void Skew::keep(Times& times, int64_t frame_ns, int64_t monotonic_ns) {
  times[frame_ns] = monotonic_ns;
  if (times.size() > kMaxWaiting) times.erase(times.begin());
}
