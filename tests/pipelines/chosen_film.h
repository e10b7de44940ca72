// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Three discs that a person chooses from.
#pragma once

#include <gst/check/gstharness.h>

#include "plugin/filter/display/motion_display.h"
#include "plugin/filter/spidar_motion.h"
#include "tests/support/element_harness.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test {

/// A film before whatever stands between it and the element, and the element and the window.
class ChosenFilm {
 public:
  using Vector2d = Eigen::Vector2d;
  static constexpr int kWidth = 480, kHeight = 270;
  static constexpr GstClockTime kFrame = 40 * GST_MSECOND;
  static constexpr double kFrame_s = 0.04;
  /// Frames until an object is known.
  static constexpr int kKnown = 4;
  /// What a person asks for.
  static constexpr double kMaxFrames = 0.95;

  /// Three discs that go straight ahead, in px from the middle of the frame.
  static constexpr int kDiscs = 3;
  static inline const std::array<Vector2d, kDiscs> kStart_px = {
      Vector2d(-180, -80), Vector2d(160, -90), Vector2d(60, 85)};
  static inline const std::array<Vector2d, kDiscs> kStep_px = {Vector2d(3, 0), Vector2d(0, 3),
                                                               Vector2d(-3, 0)};

  explicit ChosenFilm(const std::string& properties, const std::string& behind = "",
                      const std::string& before = "") {
    init_gstreamer();
    const std::string line = before + "spidarmotion name=motion device=none " + properties + behind;
    harness_ = gst_harness_new_parse(line.c_str());
    bus_ = gst_bus_new();
    gst_element_set_bus(harness_->element, bus_);
    gst_harness_set_src_caps(harness_, make_caps("GRAY8", kWidth, kHeight));
    scene_.plain_background();
    for (int i = 0; i < kDiscs; ++i) scene_.add_disc(28);
  }
  ~ChosenFilm() {
    gst_harness_teardown(harness_);
    gst_bus_set_flushing(bus_, TRUE);
    gst_object_unref(bus_);
  }
  ChosenFilm(const ChosenFilm&) = delete;
  ChosenFilm& operator=(const ChosenFilm&) = delete;

  GstHarness* harness() const { return harness_; }
  static Vector2d disc_px(int disc, int n) {
    const auto i = static_cast<size_t>(disc);
    return kStart_px[i] + n * kStep_px[i];
  }
  /// Of the next frame: from (0, 0) to (1, 1).
  Vector2d disc_position(int disc) const {
    const Vector2d at_px = disc_px(disc, frames_);
    return {0.5 + at_px.x() / kWidth, 0.5 + at_px.y() / kHeight};
  }

  void next() {
    std::vector<Placement> positions;
    for (int i = 0; i < kDiscs; ++i) positions.push_back({disc_px(i, frames_)});
    const ImageView picture = scene_.draw({}, positions);
    GstBuffer* const frame = gst_buffer_new_allocate(nullptr, kWidth * kHeight, nullptr);
    for (int y = 0; y < kHeight; ++y) {
      gst_buffer_fill(frame, static_cast<gsize>(y) * kWidth, picture.at(0, y), kWidth);
    }
    GST_BUFFER_PTS(frame) = static_cast<GstClockTime>(frames_++) * kFrame;
    GST_BUFFER_DURATION(frame) = kFrame;
    if (attach_) attach_(frame, frames_ - 1);
    ASSERT_EQ(gst_harness_push(harness_, frame), GST_FLOW_OK);
    drain();
  }
  void play_to(int frame) {
    while (frames_ < frame) next();
  }
  void set(const char* property, const std::string& value) {
    GstElement* const motion = gst_bin_get_by_name(GST_BIN(harness_->element), "motion");
    gst_util_set_object_arg(G_OBJECT(motion), property, value.c_str());
    gst_object_unref(motion);
  }

  /// The element as its debug window sees it.
  window::Source& window() {
    if (!window_) {
      GstElement* const motion = gst_bin_get_by_name(GST_BIN(harness_->element), "motion");
      window_ = gst_spidar_motion_state(GST_SPIDAR_MOTION(motion)).display.source();
      gst_object_unref(motion);
    }
    return *window_;
  }

  /// The disc whose motion is nearest to the one that is felt.
  int felt() const {
    int nearest = 0;
    for (int i = 1; i < kDiscs; ++i)
      if (off_px_s(i) < off_px_s(nearest)) nearest = i;
    return nearest;
  }
  double off_px_s(int disc) const {
    return (velocity_px_s_ - kStep_px[static_cast<size_t>(disc)] / kFrame_s).norm();
  }

  /// A detector that stands before the element.
  std::function<void(GstBuffer* frame, int n)> attach_;
  Vector2d velocity_px_s_{0, 0};
  guint object_ = 0;  ///< 0: not one alone
  std::vector<std::string> warnings_, notes_;

 private:
  void drain() {
    while (GstMessage* const message = gst_bus_pop(bus_)) {
      GError* error = nullptr;
      if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ELEMENT) {
        const GstStructure* const s = gst_message_get_structure(message);
        gst_structure_get(s, "velocity-x", G_TYPE_DOUBLE, &velocity_px_s_.x(), "velocity-y",
                          G_TYPE_DOUBLE, &velocity_px_s_.y(), "object", G_TYPE_UINT, &object_,
                          nullptr);
      } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING) {
        gst_message_parse_warning(message, &error, nullptr);
        warnings_.emplace_back(error->message);
      } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_INFO) {
        gst_message_parse_info(message, &error, nullptr);
        notes_.emplace_back(error->message);
      }
      g_clear_error(&error);
      gst_message_unref(message);
    }
  }

  MovingScene scene_{kWidth, kHeight};
  std::shared_ptr<window::Source> window_;
  GstHarness* harness_ = nullptr;
  GstBus* bus_ = nullptr;
  int frames_ = 0;
};

}  // namespace spidar::test
