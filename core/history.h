// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace spidar {

/// The last N values that were added, or fewer. Age 0 is the newest. Allocates nothing.
template <typename T, size_t N>
class History {
 public:
  void add(const T& value) {
    newest_ = (newest_ + 1) % N;
    values_[newest_] = value;
    count_ = std::min(count_ + 1, N);
  }
  void clear() { count_ = 0; }

  size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  T& operator[](size_t age) { return values_[(newest_ + N - age) % N]; }
  const T& operator[](size_t age) const { return values_[(newest_ + N - age) % N]; }

 private:
  std::array<T, N> values_{};
  size_t newest_ = 0;
  size_t count_ = 0;
};

}  // namespace spidar
