// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Objects that the child process of a fork() must not touch.
#pragma once

#include <memory>
#include <mutex>
#include <unistd.h>
#include <utility>

namespace gst_spidar {
inline namespace v0 {

/// After fork(), the child has a copy of each object, but only the thread that called fork(): a
/// lock that another thread held stays locked forever, and what that thread was writing stays
/// incomplete. Objects with locks or threads are therefore accessed only through this class, which
/// gives them only to the process that made them. The child does not destroy the copy either: there
/// is no thread to wait for.
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

  /// Returns null after fork() in the child.
  T* get() const noexcept { return getpid() == owner_ ? held_.get() : nullptr; }

 private:
  std::unique_ptr<T> held_;
  const pid_t owner_ = getpid();
};

/// Gives an object of this process to one call, while other calls wait for the mutex `calls`.
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
