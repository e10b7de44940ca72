// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// From frames to what the grip touches.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gst/gst.h>

#include "core/image_view.h"
#include "core/motion_analyzer.h"
#include "core/touch/depth_picture.h"
#include "core/touch/relief.h"
#include "plugin/properties/touch_properties.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/profiles/profile.h"
#include "spidar/realtime/latency_histogram.h"
#include "spidar/touch/touch_mailbox.h"

namespace spidar {

/// The largest stiffness for a device with such drives, N/m. What has been measured to be stable in
/// a light hand is kMostStiffness_N_m at a delay of 3.5 ms (docs/touch.md), and what a surface asks
/// of the hand grows with stiffness · delay: a longer delay allows as much less.
double most_stiffness_N_m(const Profile& profile);

/// What the properties mean on this device.
ContactSettings contact_settings(const TouchProperties& properties, const Profile& profile);

/// The relief of every frame, on its way to the haptic loop. As long as nothing is touched it takes
/// no memory and the loop knows nothing of it. Methods are grouped by the thread they belong to.
class ReliefStream {
 public:
  /// So many frames can be between the element and the screen; reliefs of more are left out.
  static constexpr size_t kSlots = 32;

  // --- state changes

  /// A device was opened. The picture is as wide and as high as `half_size_m` says, see
  /// GripPointer.
  void connect(HapticLoop* loop, const Profile& profile, const Eigen::Vector2d& half_size_m);
  /// It was closed, and its loop is gone.
  void disconnect();

  // --- any thread

  /// There is nothing to touch from now on, until the next frame.
  void forget();
  /// The same, but no frame is touched until set_muted(false).
  void set_muted(bool muted);
  void describe(GstStructure* structure) const;

  // --- streaming thread

  /// A frame that is shown at `shown_ns`, as it comes to the sink. `luma`: of all of it;
  /// `analysis`: of the part that is picture. `finger`: see touched_displacement_px(). Throws
  /// std::invalid_argument when the device has no workspace that a picture fits into. Returns false
  /// when touch=depth finds no depth in the frame, which then leaves the last relief in place.
  /// After the first frame of a size nothing is taken from the heap.
  bool add(GstBuffer* buffer, const ImageView& luma, const FrameAnalysis& analysis,
           int64_t shown_ns, const TouchProperties& properties, const Eigen::Vector2d& finger);
  /// Whether add() makes a copy of the relief, which takes memory from the heap.
  void want_copy(bool wanted) { copy_wanted_ = wanted; }
  /// Of the frame that was added last; null when that made none.
  std::shared_ptr<const HeightField> take_copy() { return std::move(copy_); }
  /// From `shown_ns` on there is nothing to touch.
  void end(int64_t shown_ns);

 private:
  void start();
  bool build(GstBuffer* buffer, const ImageView& luma, int64_t shown_ns,
             const TouchProperties& properties, TouchFrame& frame);
  ImageView thinned(const ImageView& luma);

  HapticLoop* loop_ = nullptr;
  Profile profile_;
  Eigen::Vector2d half_size_m_ = Eigen::Vector2d::Zero();
  std::mutex mutex_;  // that there is a mailbox, against forget()
  std::unique_ptr<TouchMailbox> mailbox_;
  std::atomic<bool> muted_{false};
  // Streaming thread.
  ReliefBuilder builder_;
  DepthPicture depth_;
  int64_t depth_ns_ = INT64_MIN;  ///< of the last frame that had depth
  std::vector<uint8_t> thinned_;
  bool touched_ = false;   ///< the newest frame has a surface
  bool left_out_ = false;  ///< the newest frame did not get into the mailbox
  uint32_t generation_ = 0;
  bool copy_wanted_ = false;
  std::shared_ptr<const HeightField> copy_;

  std::atomic<double> stiffness_N_m_{0};
  std::atomic<uint64_t> reliefs_{0};
  std::atomic<uint64_t> reliefs_left_out_{0};
  LatencyHistogram took_;
};

}  // namespace spidar
