// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A stiff wall to the left of the centre, for two seconds; prints how deep the grip was in it:
//   wall [DEVICE]     default: sim, the simulated SPIDAR, whose hand is pushed into the wall
// The library keeps the wall passive: a hand gets no more energy from it than it has put in.
// Needs only libgst-spidar: g++ -std=c++17 wall.cpp $(pkg-config --cflags --libs gst-spidar)
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>

#include <gst-spidar/device.h>

int main(int argc, char** argv) {
  using namespace std::chrono_literals;
  try {
    const std::string name = argc > 1 ? argv[1] : "sim";
    std::atomic<double> deepest_m{0};  // must outlive the device, whose callback uses it
    gst_spidar::Device device(name);
    if (!device.wait_until_running(30s))
      throw std::runtime_error("no pose: " + device.last_fault());
    const double stiffness_N_m = device.capabilities().largest_stiffness_N_m;
    device.set_callback([&](const gst_spidar::GripState& grip) {
      gst_spidar::Wrench wrench;
      const double depth_m = -0.001 - grip.pose.position_m.x;  // the wall is at -1 mm
      if (depth_m > 0) wrench.force_N.x = stiffness_N_m * depth_m;
      if (depth_m > deepest_m) deepest_m = depth_m;
      return wrench;
    });
    gst_spidar::Wrench to_the_left;
    to_the_left.force_N.x = -1;
    for (int i = 0; i < 100 && device.callback_error().empty(); ++i) {
      if (name == "sim") device.push(to_the_left);  // nobody else pushes the simulated hand
      std::this_thread::sleep_for(20ms);
    }
    if (!device.callback_error().empty()) throw std::runtime_error(device.callback_error());
    std::printf("%.0f N/m: %.1f mm deep at most\n", stiffness_N_m, 1e3 * deepest_m);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "wall: %s\n", error.what());
    return 1;
  }
}
