// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Prints where the grip of a device is, ten times in a second, in millimetres from the centre:
//   pose [DEVICE [PROFILE]]     default: sim, the simulated SPIDAR
// Needs only libgst-spidar: g++ -std=c++17 pose.cpp $(pkg-config --cflags --libs gst-spidar)
#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <thread>

#include <gst-spidar/device.h>

int main(int argc, char** argv) {
  using namespace std::chrono_literals;
  try {
    const gst_spidar::Device device(argc > 1 ? argv[1] : "sim", argc > 2 ? argv[2] : "");
    // The pose is known after several consistent readings.
    for (int i = 0; i < 500 && !device.pose(); ++i) std::this_thread::sleep_for(10ms);
    for (int i = 0; i < 10; ++i) {
      if (const std::optional<gst_spidar::Pose> pose = device.pose()) {
        const gst_spidar::Vector3 at = pose->position_m;
        std::printf("%.1f %.1f %.1f\n", 1e3 * at.x, 1e3 * at.y, 1e3 * at.z);
      } else {
        std::puts("not known");
      }
      std::this_thread::sleep_for(100ms);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pose: %s\n", error.what());
    return 1;
  }
}
