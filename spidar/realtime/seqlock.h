// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace spidar {

/// A value that one thread writes and others read without locks. The writer never waits; several
/// writers need a lock of their own. The words are atomics, so that there is no data race in the
/// sense of the language (H. Boehm, Can seqlocks get along with programming language memory
/// models?, 2012).
template <typename T>
class Seqlock {
  // Eigen's fixed-size types are plain memory but not formally trivially copyable.
  static_assert(std::is_trivially_destructible_v<T>);
  static constexpr size_t kWords = (sizeof(T) + 7) / 8;

 public:
  Seqlock() { store(T{}); }
  explicit Seqlock(const T& value) { store(value); }

  void store(const T& value) noexcept {
    std::array<uint64_t, kWords> words{};
    std::memcpy(words.data(), static_cast<const void*>(&value), sizeof(T));
    const uint64_t sequence = sequence_.load(std::memory_order_relaxed);
    sequence_.store(sequence + 1, std::memory_order_relaxed);
    // With release order, a reader that sees a new word also sees the odd number.
    for (size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    sequence_.store(sequence + 2, std::memory_order_release);
  }

  /// Returns false and leaves `value` unchanged while the writer writes. For readers of higher
  /// priority: on a single processor, load() would wait forever for the writer.
  bool try_load(T& value) const noexcept {
    std::array<uint64_t, kWords> words;
    const uint64_t before = sequence_.load(std::memory_order_acquire);
    for (size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
    if ((before & 1) != 0 || sequence_.load(std::memory_order_relaxed) != before) return false;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
    return true;
  }

  /// Waits while the writer writes.
  T load() const noexcept {
    T value;
    while (!try_load(value)) {
    }
    return value;
  }

 private:
  std::atomic<uint64_t> sequence_{0};
  std::array<std::atomic<uint64_t>, kWords> words_{};
};

}  // namespace spidar
