// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>

namespace spidar::test {

/// How often a program that refers to this variable has allocated memory: malloc() and everything
/// that calls it, such as operator new and Eigen.
extern std::atomic<long> allocations;

/// A sanitizer has its own heap, which is not counted.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCountsAllocations = false;
#else
constexpr bool kCountsAllocations = true;
#endif

}  // namespace spidar::test
