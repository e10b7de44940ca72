/// What the element does with frames and time, without GObject.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <gst/video/video.h>

#include "core/motion_analyzer.h"
#include "plugin/device_view.h"
#include "plugin/frame_luma.h"
#include "plugin/grip_pointer.h"
#include "plugin/properties/motion_properties.h"
#include "plugin/reports/frame_trace.h"
#include "plugin/reports/limit_watch.h"
#include "plugin/reports/motion_stats.h"
#include "plugin/timing/playback_follower.h"
#include "plugin/timing/wrench_schedule.h"
#include "plugin/track/track_player.h"
#include "spidar/haptic_session.h"

namespace spidar {

enum class FrameProblem {
  kNone,
  kNoTimestamp,       ///< no PTS, or no time in it or its segment: it cannot be felt in time
  kSameTimestamp,     ///< as the frame before, or nearly so: no Δt to divide by
  kFallingTimestamp,  ///< before the frame before
  kTooSmall,          ///< less memory than the picture needs
  kNotShown,          ///< outside the segment, or cropped to nothing
};

/// In words, for the log.
const char* to_string(FrameProblem problem);

/// What became of one frame.
struct FrameReport {
  FrameProblem problem = FrameProblem::kNone;
  bool analyzed = false;
  GstClockTime running_time = GST_CLOCK_TIME_NONE;
  GstClockTime stream_time = GST_CLOCK_TIME_NONE;
  FrameAnalysis analysis;
  int64_t took_ns = 0;                   ///< the analysis
  ForceLimit limit = ForceLimit::kNone;  ///< of the last second up to this frame
  bool trace_failed = false;             ///< the trace could not be written and was closed
};

/// Analysis, trace and haptic session of one element. Methods are grouped by the thread they belong
/// to; what they share is locked here.
class MotionEngine {
 public:
  explicit MotionEngine(GstElement* element) : element_(element) {}

  /// Tests only, before open(): `now` stands for CLOCK_MONOTONIC and the loop waits to be ticked.
  void set_manual(PlaybackSync::Now now, void* user);

  // --- state changes

  /// Opens the device. Throws ProfileError, DeviceError, std::runtime_error. Empty, or why the
  /// haptic trace cannot be written: the device works without it.
  std::string open(const MotionProperties& properties);
  /// Motors to rest, device closed.
  void close();
  /// Begins a stream. Empty, or why the trace cannot be written.
  std::string start(const std::string& trace_path);
  /// Ends it. False when the last rows of the trace could not be written.
  bool stop();
  void set_playing(bool playing);

  // --- any thread

  void set_latency(GstClockTime latency);
  /// Something behind the element was linked anew.
  void look_for_sink();
  void set_offset(GstClockTimeDiff offset_ns);
  /// Holds with the next tick of the haptic loop, whether frames come or not.
  void set_max_force(double max_force_N);
  /// The force ramps to rest at once and stays there until frames come after set_muted(false).
  void set_muted(bool muted);
  /// What was scheduled is forgotten at once.
  void flush();
  /// The sink shows what comes `multiplier` times as fast from this moment on, see InstantRate.
  void change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream);
  /// The sink has stepped over so much of running time: it shows what follows as much earlier.
  void skip(GstClockTime duration);
  /// The pipeline will distribute a new base time: nothing is on the screen until then.
  void expect_base_time();
  /// Looks at the pipeline's clock now; a thread does that by itself.
  void refresh_clock();
  GstStructure* stats() const;
  /// What has kept the force from being felt in the last second of what is on the screen.
  ForceLimit force_limit() const;
  /// False with device=none or while closed.
  bool look_at_device(DeviceView& view) const;
  /// Null with device=none or while closed.
  HapticSession* session() const { return session_.get(); }

  // --- streaming thread

  /// Frames are not analysed: the samples of this track are felt. Nothing: they are again.
  void set_track(std::optional<TrackFile> track);
  FrameReport process(const GstVideoFrame& frame, const GstSegment& segment,
                      const AnalyzerSettings& settings);
  /// The next frame has nothing to do with the one before.
  void restart();
  /// Running time begins anew: after a flush.
  void restart_timing();
  /// A sink that has skipped something is in time with the segment again.
  void begin_segment();
  /// Nothing is shown from this running time on: the force runs out.
  void run_out(GstClockTime running_time);
  /// In place of a frame that has no picture.
  void pass_gap(GstClockTime running_time);
  /// Nothing more comes.
  void end_of_stream();
  /// Where the grip points at the picture; nothing while no device runs.
  std::optional<Eigen::Vector2d> grip_place() const;
  /// kClosed with device=none.
  DeviceState device_state() const;

 private:
  /// Nothing while no device is open.
  std::optional<LoopSnapshot> open_loop() const;
  /// Time of a frame on a scale on which the distance to the last frame is that of showing them.
  int64_t pace(int64_t running_ns);

  GstElement* const element_;
  PlaybackSync::Now now_ = nullptr;
  void* now_user_ = nullptr;

  // These outlive the thread of follower_, which hands on what waits.
  WrenchSchedule schedule_;
  TrackPlayer player_;
  mutable std::mutex session_mutex_;  // state changes against any thread
  std::unique_ptr<HapticSession> session_;
  Profile profile_;  // of the session
  std::unique_ptr<PlaybackFollower> follower_;
  GstClockTime latency_ = 0;
  GstClockTimeDiff offset_ns_ = 0;
  SafetyLimits limits_;
  // Streaming thread.
  GripPointer grip_pointer_;
  MotionAnalyzer analyzer_;
  FrameLuma luma_;
  FrameTrace trace_;
  int64_t last_running_ns_ = -1;
  uint64_t frames_in_segment_ = 0;
  int64_t last_paced_ns_ = 0;
  int64_t last_interval_ns_ = 0;

  MotionStats stats_;
  LimitWatch limit_watch_;
};

}  // namespace spidar
