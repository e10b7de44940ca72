// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/haptic_session.h"

#include <optional>
#include <utility>

#include "spidar/limits/vibration_memory.h"
#include "spidar/loop/loop_thread.h"
#include "spidar/loop/string_grip.h"
#include "spidar/realtime/monotonic.h"

namespace spidar {

// Members are destroyed in reverse order: the thread sets the motors to zero before the trace takes
// its last row and the memory its last vibration.
struct HapticSession::Impl {
  Impl(std::unique_ptr<Grip> grip, const SessionSettings& settings)
      : loop(std::move(grip), settings.limits) {
    loop.open();
    opened = loop.grip().description();
    if (!settings.threaded) return;
    keeper.emplace(loop.vibration(), VibrationMemory::of_user());
    thread.emplace(loop, settings.real_time);
  }
  ~Impl() {
    if (!thread) ramp_down();
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
  std::optional<VibrationKeeper> keeper;
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

void HapticSession::begin_trace(const std::string& path) {
  impl_->trace.emplace(path, impl_->loop, impl_->thread.has_value());
}

void HapticSession::drain_trace() noexcept {
  if (impl_->trace) impl_->trace->drain();
}

LineWriter::Status HapticSession::trace_status() const noexcept {
  return impl_->trace ? impl_->trace->status() : LineWriter::Status();
}

std::string HapticSession::vibration_error() const {
  return impl_->keeper ? VibrationMemory::of_user().error() : "";
}

int64_t HapticSession::monotonic_now_ns() noexcept {
  return spidar::monotonic_now_ns();
}

}  // namespace spidar
