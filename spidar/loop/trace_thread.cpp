// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/trace_thread.h"

#include <chrono>

#include "spidar/realtime/thread_setup.h"

namespace spidar {

TraceThread::TraceThread(const std::string& path, HapticLoop& loop, bool threaded)
    : loop_(loop), trace_(path) {
  if (!threaded) return;
  thread_ = start_thread("spidar-trace", [this] { run(); });
}

TraceThread::~TraceThread() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  drain();
}

void TraceThread::run() noexcept {
  request_background();
  std::unique_lock lock(mutex_);
  while (!stop_) {
    wake_.wait_for(lock, std::chrono::milliseconds(50));
    drain_locked();
  }
}

void TraceThread::drain() noexcept {
  const std::lock_guard lock(mutex_);
  drain_locked();
}

void TraceThread::drain_locked() noexcept {
  TickRecord record;
  while (loop_.pop_record(record)) trace_.add(record);
  trace_.flush();
  error_.store(trace_.status().error, std::memory_order_relaxed);
}

}  // namespace spidar
