// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <atomic>
#include <cstddef>

namespace spidar {

/// A queue between one thread that writes and one that reads. Fixed size, wait-free. Holds N
/// entries; N is a power of two.
template <typename T, size_t N>
class SpscRing {
  static_assert(N > 0 && (N & (N - 1)) == 0);

 public:
  /// Writer: returns false when the queue is full; the entry is then not taken.
  bool push(const T& entry) noexcept {
    const size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_.load(std::memory_order_acquire) == N) return false;
    entries_[tail & (N - 1)] = entry;
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  /// Reader: returns the oldest entry, which stays until drop(); null when the queue is empty.
  const T* front() const noexcept {
    const size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return nullptr;
    return &entries_[head & (N - 1)];
  }

  void drop() noexcept {
    head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  /// Reader: returns false when the queue is empty.
  bool pop(T& entry) noexcept {
    const T* oldest = front();
    if (oldest == nullptr) return false;
    entry = *oldest;
    drop();
    return true;
  }

 private:
  // On separate cache lines, so that writer and reader do not invalidate each other's.
  alignas(64) std::atomic<size_t> head_{0};
  alignas(64) std::atomic<size_t> tail_{0};
  alignas(64) std::array<T, N> entries_{};
};

}  // namespace spidar
