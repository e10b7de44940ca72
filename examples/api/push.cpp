// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Opens a device and pushes its grip in a circle for a second:
//   push [DEVICE]     default: sim, the simulated SPIDAR
// Needs only libgst-spidar: g++ -std=c++17 push.cpp $(pkg-config --cflags --libs gst-spidar)
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <thread>

#include <gst-spidar/device.h>

int main(int argc, char** argv) {
  using namespace std::chrono_literals;
  try {
    gst_spidar::Device device(argc > 1 ? argv[1] : "sim");
    device.set_limits(2.0, 0.05);
    double strongest_N = 0;
    for (int step = 0; step < 100; ++step) {
      const double angle = 2 * M_PI * step / 100;
      gst_spidar::Wrench wrench;
      wrench.force_N = {std::cos(angle), std::sin(angle), 0};
      device.push(wrench);
      std::this_thread::sleep_for(10ms);
      const gst_spidar::Vector3 felt = device.felt().force_N;
      strongest_N = std::fmax(strongest_N, std::hypot(felt.x, felt.y, felt.z));
    }
    std::printf("%s: %.2f N at most\n", device.name().c_str(), strongest_N);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "push: %s\n", error.what());
    return 1;
  }
}
