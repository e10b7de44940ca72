// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>

namespace spidar::test {

/// How often a program that refers to it has taken memory from the heap: malloc() and what ends
/// there, such as operator new and Eigen.
extern std::atomic<long> allocations;

/// A sanitizer has a heap of its own, of which nothing is counted.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCountsAllocations = false;
#else
constexpr bool kCountsAllocations = true;
#endif

}  // namespace spidar::test
