// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gst/gst.h>

#include "core/analysis/frame.h"
#include "core/fields.h"
#include "core/orientation.h"
#include "core/picture/image_view.h"
#include "core/touch/depth_picture.h"
#include "core/touch/relief.h"
#include "plugin/frame/frame_luma.h"
#include "plugin/properties/motion_properties.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/profiles/profile.h"
#include "spidar/realtime/latency_histogram.h"
#include "spidar/touch/touch_rendering.h"

namespace spidar::filter {

/// Returns the displacement from the previous frame to this one, in pixels of the frame: x right, y
/// down. `position` is the position of the finger, with (0, 0) at the top left corner of the
/// picture and (1, 1) at the bottom right. The result is the motion of the object whose box
/// contains the finger (of several, the one with the smallest area), otherwise that of the
/// background at this point. With motion=mean, which detects neither, the result is the motion of
/// the whole picture. The result is zero if the motion is unknown, or if the frame repeats the
/// previous picture.
Eigen::Vector2d touched_displacement_px(const Frame& frame, const Eigen::Vector2d& position);

touch::ContactSettings contact_settings(const TouchProperties& properties, const Profile& profile);

/// Builds the relief of every frame and passes it to the haptic loop. Until touch is first enabled,
/// this object allocates nothing and is not connected to the loop.
class ReliefStream {
 public:
  /// The most frames between the element and the screen; reliefs of further frames are left out.
  static constexpr size_t kSlots = 32;

  // --- state changes

  /// Call this after a device was opened. `half_size_m` is half the width and height of the
  /// picture, see GripPointer.
  void connect(HapticLoop* loop, const Profile& profile, const Eigen::Vector2d& half_size_m);
  /// Call this after the device was closed and its loop destroyed.
  void disconnect();

  // --- any thread

  /// Removes the surface until the next frame.
  void clear();
  /// Removes the surface until set_muted(false).
  void set_muted(bool muted);
  void describe(FieldSink& to) const;

  // --- streaming thread

  /// Adds a frame that is shown at `shown_ns`. `luma` covers the whole frame, `analyzed` the part
  /// that is picture. For `finger` see touched_displacement_px(). Throws std::invalid_argument when
  /// the device has no workspace for a picture. Allocates only when the frame size changes. If
  /// `shading` is not null, it is set to touch::HeightField::shading(), or left as it is where
  /// there is no surface.
  void add(const ImageView& luma, const Frame& analyzed, int64_t shown_ns,
           const TouchProperties& properties, const Eigen::Vector2d& finger,
           std::string* shading = nullptr);
  /// Sets how the following frames are turned for display; the relief is turned likewise.
  void set_turn(const Orientation& turn) { turn_ = turn; }
  /// Sets the brightness of black and white in the following frames.
  void set_levels(const LumaLevels& levels) { levels_ = levels; }
  /// Removes the surface from `shown_ns` on.
  void end(int64_t shown_ns);

 private:
  void start();
  bool build(const ImageView& luma, int64_t shown_ns, const TouchProperties& properties,
             touch::Surface& frame);
  ImageView thinned(const ImageView& luma);
  const float* turned(const float* levels);

  HapticLoop* loop_ = nullptr;
  Profile profile_;
  Eigen::Vector2d half_size_m_ = Eigen::Vector2d::Zero();
  std::mutex mutex_;  ///< guards mailbox_ against clear()
  std::unique_ptr<touch::Mailbox> mailbox_;
  std::atomic<bool> muted_{false};
  // Streaming thread.
  touch::ReliefBuilder builder_;
  touch::DepthPicture depth_;
  int64_t depth_ns_ = INT64_MIN;  ///< the time of the last frame whose depth was read
  Orientation turn_;
  LumaLevels levels_;
  std::vector<uint8_t> thinned_;
  std::vector<float> turned_levels_;
  bool touched_ = false;   ///< whether the newest frame has a surface
  bool left_out_ = false;  ///< whether the newest frame was not published
  uint32_t generation_ = 0;

  std::atomic<double> stiffness_N_m_{0};
  std::atomic<uint64_t> reliefs_{0};
  std::atomic<uint64_t> reliefs_left_out_{0};
  LatencyHistogram took_;
};

}  // namespace spidar::filter
