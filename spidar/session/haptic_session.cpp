// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/haptic_session.h"

#include <atomic>
#include <optional>
#include <utility>

#include "spidar/grip/string_grip.h"
#include "spidar/loop/loop_thread.h"
#include "spidar/loop/tick_trace.h"
#include "spidar/realtime/monotonic.h"

namespace spidar {
namespace {

/// When the VibrationBudget of this process's hand is full again, CLOCK_MONOTONIC. A second device
/// counts for the same hand.
std::atomic<int64_t>& vibration_memory_ns() noexcept {
  static std::atomic<int64_t> full_at_ns{INT64_MIN};
  return full_at_ns;
}

void remember(int64_t full_at_ns) noexcept {
  int64_t known_ns = vibration_memory_ns();
  while (known_ns < full_at_ns &&
         !vibration_memory_ns().compare_exchange_weak(known_ns, full_at_ns)) {
  }
}

}  // namespace

// Members are destroyed in reverse order: the thread has brought the motors to zero before the
// trace takes its last row.
struct HapticSession::Impl {
  Impl(std::unique_ptr<Grip> grip, const SessionSettings& settings)
      : loop(std::move(grip), settings.limits) {
    if (!settings.trace_path.empty()) trace.emplace(settings.trace_path, loop, settings.threaded);
    if (settings.threaded) loop.vibration().restore(vibration_memory_ns());
    loop.open();
    opened = loop.grip().description();
    if (settings.threaded) thread.emplace(loop, settings.real_time);
  }
  ~Impl() {
    if (thread) {
      thread.reset();
      remember(loop.vibration().full_at_ns());
    } else {
      ramp_down();
    }
  }

  void ramp_down() noexcept {
    loop.begin_close();
    int64_t now = loop.snapshot().last.monotonic_ns;
    while (!loop.released()) {
      now += kTick_ns;
      loop.tick(now, now);
    }
    loop.close();
  }

  HapticLoop loop;
  std::optional<TraceThread> trace;
  std::string opened;
  Scheduling manual{false, "no thread: the owner calls tick()"};
  LoopTiming no_timing;
  std::optional<LoopThread> thread;
};

HapticSession::HapticSession(std::unique_ptr<Grip> grip, const SessionSettings& settings)
    : impl_(std::make_unique<Impl>(std::move(grip), settings)) {}

HapticSession::HapticSession(const Profile& profile, std::unique_ptr<StringDevice> device,
                             const SessionSettings& settings)
    : HapticSession(std::make_unique<StringGrip>(profile, std::move(device)), settings) {}

HapticSession::~HapticSession() = default;

HapticLoop& HapticSession::loop() noexcept {
  return impl_->loop;
}
const HapticLoop& HapticSession::loop() const noexcept {
  return impl_->loop;
}
const std::string& HapticSession::opened() const noexcept {
  return impl_->opened;
}

const Scheduling& HapticSession::scheduling() const noexcept {
  return impl_->thread ? impl_->thread->scheduling() : impl_->manual;
}

const LoopTiming& HapticSession::timing() const noexcept {
  return impl_->thread ? impl_->thread->timing() : impl_->no_timing;
}

void HapticSession::drain_trace() noexcept {
  if (impl_->trace) impl_->trace->drain();
}

TraceStatus HapticSession::trace_status() const noexcept {
  return impl_->trace ? impl_->trace->status() : TraceStatus();
}

int64_t HapticSession::monotonic_now_ns() noexcept {
  return spidar::monotonic_now_ns();
}

}  // namespace spidar
