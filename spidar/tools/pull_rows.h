// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>
#include <chrono>
#include <iostream>
#include <string>
#include <thread>

#include "spidar/selftest/wiring_answers.h"
#include "spidar/text.h"

namespace spidar::tools {

/// Shows the pulls of `selftest` and `calibrate`: prints what each pull has moved as soon as it is
/// over, in a thread of its own, so that the thread that pulls does not wait for a terminal.
class PullRows {
 public:
  explicit PullRows(int strings) : thread_([this, strings] { print(strings); }) {}
  ~PullRows() {
    ends_ = true;
    thread_.join();
  }
  PullRows(const PullRows&) = delete;
  PullRows& operator=(const PullRows&) = delete;

  auto* pulled() { return &pulled_; }

 private:
  void print(int strings) {
    constexpr std::chrono::milliseconds kLook{50};
    for (int told = 0;;) {
      const bool ends = ends_;
      for (selftest::PulledMotor row; pulled_.pop(row);) {
        // Unclear strings are pulled again, so there may be more rows than strings.
        std::cerr << (++told <= strings ? formatted("pulled %d of %d", told, strings)
                                        : std::string("pulled again"))
                  << formatted(": motor %d, own length %+.2f mm%s\n", row.motor,
                               1e3 * row.own_length_m, row.steady ? "" : ", the hand moved");
      }
      if (ends) return;
      std::this_thread::sleep_for(kLook);
    }
  }

  SpscRing<selftest::PulledMotor, 64> pulled_;
  std::atomic<bool> ends_{false};
  std::thread thread_;  ///< starts when all other members exist
};

}  // namespace spidar::tools
