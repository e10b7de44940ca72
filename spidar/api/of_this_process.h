// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Objects that a copy of their process must not touch.
#pragma once

#include <memory>
#include <mutex>
#include <unistd.h>
#include <utility>

namespace gst_spidar {
inline namespace v0 {

/// A child process by fork() has a copy of each object, but only of the thread that called fork():
/// a lock that another one held is held for ever, and nobody completes what it was writing. So what
/// has locks or threads is reached through this only, which gives it to the process that made it.
/// A copy is not destroyed either: there is no thread to wait for.
template <typename T>
class OfThisProcess {
 public:
  template <typename... Arguments>
  explicit OfThisProcess(Arguments&&... arguments)
      : held_(std::make_unique<T>(std::forward<Arguments>(arguments)...)) {}
  ~OfThisProcess() {
    if (!get()) static_cast<void>(held_.release());
  }
  OfThisProcess(const OfThisProcess&) = delete;
  OfThisProcess& operator=(const OfThisProcess&) = delete;

  /// Null in a copy.
  T* get() const noexcept { return getpid() == owner_ ? held_.get() : nullptr; }

 private:
  std::unique_ptr<T> held_;
  const pid_t owner_ = getpid();
};

/// An object of this process for one call, while others wait: `calls` is its mutex.
template <typename T>
class Locked {
 public:
  explicit Locked(T& object) : object_(object), lock_(object.calls) {}
  T* operator->() const noexcept { return &object_; }

 private:
  T& object_;
  const std::unique_lock<std::mutex> lock_;
};

}  // namespace v0
}  // namespace gst_spidar
