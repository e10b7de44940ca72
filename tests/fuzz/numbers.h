// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads a fuzzer's bytes as numbers, and reports failures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

class Numbers {
 public:
  Numbers(const uint8_t* data, size_t size) : data_(data), left_(size) {}

  bool empty() const { return left_ == 0; }

  /// Zeros once the bytes have run out.
  double next() {
    double x = 0;
    const size_t n = left_ < sizeof x ? left_ : sizeof x;
    if (n > 0) std::memcpy(&x, data_, n);
    data_ += n;
    left_ -= n;
    return x;
  }

 private:
  const uint8_t* data_;
  size_t left_;
};

inline void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}
