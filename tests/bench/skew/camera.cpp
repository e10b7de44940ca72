// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/skew/camera.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <random>

#include <gst/app/gstappsrc.h>

#include "spidar/realtime/monotonic.h"

namespace spidar::bench {
namespace {

constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr size_t kLuma_bytes = size_t{kWidth} * kHeight;
constexpr int kSquare_px = 120;
constexpr uint8_t kDark = 40;
constexpr uint8_t kBright = 200;

/// The square moves by 8 px a frame, there and back.
GstBuffer* frame(int number) {
  constexpr int kSteps = 100;
  constexpr int kStep_px = 8;
  const int left_px = 100 + kStep_px * std::abs(number % (2 * kSteps) - kSteps);
  GstBuffer* const buffer = gst_buffer_new_allocate(nullptr, kLuma_bytes * 3 / 2, nullptr);
  GstMapInfo map;
  gst_buffer_map(buffer, &map, GST_MAP_WRITE);
  std::fill_n(map.data, kLuma_bytes, kDark);
  std::fill_n(map.data + kLuma_bytes, kLuma_bytes / 2, uint8_t{128});
  for (int y = 300; y < 300 + kSquare_px; ++y) {
    std::fill_n(map.data + y * kWidth + left_px, kSquare_px, kBright);
  }
  gst_buffer_unmap(buffer, &map);
  return buffer;
}

int64_t running_time_now(GstElement* element) {
  GstClock* const clock = gst_element_get_clock(element);
  const GstClockTime now = gst_clock_get_time(clock);
  gst_object_unref(clock);
  return static_cast<int64_t>(now) - static_cast<int64_t>(gst_element_get_base_time(element));
}

}  // namespace

Camera::Camera(GstElement* appsrc)
    : appsrc_(GST_ELEMENT(gst_object_ref(appsrc))), thread_([this] { run(); }) {}

Camera::~Camera() {
  stop_ = true;
  thread_.join();
  gst_object_unref(appsrc_);
}

void Camera::run() {
  constexpr int64_t kFrame_ns = kSecond_ns * 1001 / 30000;
  std::mt19937 random(1);
  std::uniform_int_distribution<int64_t> late_ns(0, 3'000'000);
  const int64_t first_running_ns = running_time_now(appsrc_);
  const int64_t first_ns = monotonic_now_ns();
  for (int number = 0; !stop_; ++number) {
    const int64_t since_first_ns = number * kFrame_ns;
    GstBuffer* const buffer = frame(number);
    GST_BUFFER_PTS(buffer) = static_cast<GstClockTime>(first_running_ns + since_first_ns);
    GST_BUFFER_DURATION(buffer) = static_cast<GstClockTime>(kFrame_ns);
    sleep_until_ns(first_ns + since_first_ns + kFrame_ns + late_ns(random));
    gst_app_src_push_buffer(GST_APP_SRC(appsrc_), buffer);
  }
}

}  // namespace spidar::bench
