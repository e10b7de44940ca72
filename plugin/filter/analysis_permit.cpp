// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/analysis_permit.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <unistd.h>
#include <utility>

namespace spidar::filter {
namespace {

/// Longer than any analysis takes. One that has not ended by then may never end, for example
/// because a signal handler called exit() in the thread that holds the permit.
constexpr std::chrono::seconds kLongestWait{1};

struct Permits {
  std::mutex mutex;
  std::condition_variable changed;
  int given = 0;
  uint64_t frames = 0;
  bool is_ending = false;
  const pid_t process = getpid();
};

/// Never destroyed, because a thread may still request a permit while the process exits.
Permits& permits() {
  static auto& all = *new Permits;
  return all;
}

void wait_for_frames() {
  Permits& all = permits();
  // fork() copies the mutex, which may be locked, but not the thread that would unlock it.
  if (getpid() != all.process) return;
  std::unique_lock<std::mutex> lock(all.mutex);
  if (std::exchange(all.is_ending, true)) return;
  all.changed.wait_for(lock, kLongestWait, [&all] { return all.given == 0; });
}

}  // namespace

AnalysisPermit::AnalysisPermit() {
  Permits& all = permits();
  const std::lock_guard<std::mutex> lock(all.mutex);
  is_given_ = !all.is_ending;
  if (!is_given_) return;
  ++all.given;
  // exit() calls the last registered handler first. OpenCV creates its static objects on first use,
  // some only in a later frame, so register again before frames 2, 3, 5, 9, 17 …
  const uint64_t before = all.frames++;
  if ((before & (before - 1)) == 0) std::atexit(wait_for_frames);
}

AnalysisPermit::~AnalysisPermit() {
  if (!is_given_) return;
  Permits& all = permits();
  const std::lock_guard<std::mutex> lock(all.mutex);
  --all.given;
  all.changed.notify_all();
}

}  // namespace spidar::filter
