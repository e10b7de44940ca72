#include "plugin/motion_engine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/force/motion_bounds.h"
#include "spidar/device_factory.h"

namespace spidar {
namespace {

int64_t monotonic_now(void*) {
  return HapticSession::monotonic_now_ns();
}

/// Of frames that are closer together one timestamp is wrong: their distance is no time to divide a
/// motion by. An eighth of what the caps promise, as far as they can be believed.
int64_t least_interval_ns(const GstVideoInfo& info, double rate) {
  constexpr double kMost_ns = 5e6;
  if (info.fps_n <= 0) return kLeastInterval_ns;
  const double nominal_ns = 1e9 * info.fps_d / info.fps_n / std::fabs(rate);
  return std::max(kLeastInterval_ns, static_cast<int64_t>(std::min(nominal_ns / 8, kMost_ns)));
}

/// As the caps say it; 0 where they do not.
GstClockTime nominal_duration(const GstVideoInfo& info) {
  return info.fps_n > 0 ? gst_util_uint64_scale_int(GST_SECOND, info.fps_d, info.fps_n) : 0;
}

/// Running time at which a sink shows the frame: when what is to be seen of it begins, which is its
/// end when it is played backwards. GST_CLOCK_TIME_NONE when the sink drops it.
GstClockTime shown_at(const GstVideoFrame& frame, const GstSegment& segment) {
  const GstClockTime pts = GST_BUFFER_PTS(frame.buffer);
  GstClockTime duration = GST_BUFFER_DURATION(frame.buffer);
  if (!GST_CLOCK_TIME_IS_VALID(duration) && frame.info.fps_n > 0) {
    duration = nominal_duration(frame.info);
  }
  const bool has_end = GST_CLOCK_TIME_IS_VALID(duration) && duration < GST_CLOCK_TIME_NONE - pts;
  const GstClockTime end = has_end ? pts + duration : GST_CLOCK_TIME_NONE;
  guint64 from = 0, to = 0;
  if (!gst_segment_clip(&segment, GST_FORMAT_TIME, pts, end, &from, &to)) {
    return GST_CLOCK_TIME_NONE;
  }
  const bool backwards = segment.rate < 0 && GST_CLOCK_TIME_IS_VALID(to);
  return gst_segment_to_running_time(&segment, GST_FORMAT_TIME, backwards ? to : from);
}

}  // namespace

const char* to_string(FrameProblem problem) {
  switch (problem) {
    case FrameProblem::kNone:
      return "no problem";
    case FrameProblem::kNoTimestamp:
      return "it has no timestamp";
    case FrameProblem::kSameTimestamp:
      return "its timestamp is that of the frame before, or nearly so";
    case FrameProblem::kFallingTimestamp:
      return "its timestamp is before that of the frame before";
    case FrameProblem::kTooSmall:
      return "it has less memory than its picture needs";
    case FrameProblem::kNotShown:
      return "it is outside the segment or cropped to nothing";
  }
  return "unknown problem";
}

void MotionEngine::set_manual(PlaybackSync::Now now, void* user) {
  now_ = now;
  now_user_ = user;
}

std::string MotionEngine::open(const MotionProperties& properties) {
  analyzer_.configure(properties.analyzer);
  if (properties.device == "none") return {};
  const Profile profile = load_profile(properties.used_profile());
  grip_pointer_ = GripPointer(profile.geometry);
  SessionSettings settings;
  settings.trace_path = properties.haptic_trace;
  settings.threaded = now_ == nullptr;
  std::string trace_problem;
  const auto make_session = [&] {
    return std::make_unique<HapticSession>(profile, make_device(properties.device, profile),
                                           settings);
  };
  std::unique_ptr<HapticSession> session;
  try {
    session = make_session();
  } catch (const TraceError& error) {
    trace_problem = error.what();
    settings.trace_path.clear();
    session = make_session();
  }
  HapticLoop& loop = session->loop();
  auto follower = std::make_unique<PlaybackFollower>(
      element_,
      [this, &loop](const PlaybackClock& clock) {
        loop.set_playback_clock(clock);
        schedule_.hand_on();
        player_.hand_on();
      },
      now_ ? now_ : monotonic_now, now_user_, settings.threaded);
  const std::lock_guard<std::mutex> lock(session_mutex_);
  loop.set_limits(limits_);
  follower->set_latency(latency_);
  follower->set_offset(offset_ns_);
  schedule_.connect(&loop);
  player_.connect(&loop);
  profile_ = profile;
  session_ = std::move(session);
  follower_ = std::move(follower);
  return trace_problem;
}

void MotionEngine::close() {
  std::unique_ptr<PlaybackFollower> follower;
  std::unique_ptr<HapticSession> session;
  {
    const std::lock_guard<std::mutex> lock(session_mutex_);
    follower = std::move(follower_);
    session = std::move(session_);
  }
  follower.reset();  // before the loop that it publishes to
  schedule_.connect(nullptr);
  player_.connect(nullptr);
}

std::string MotionEngine::start(const std::string& trace_path) {
  stats_.reset();
  restart_timing();
  return trace_path.empty() ? std::string() : trace_.open(trace_path);
}

bool MotionEngine::stop() {
  flush();
  return trace_.close();
}

void MotionEngine::set_playing(bool playing) {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  if (follower_) follower_->set_playing(playing);
}

void MotionEngine::set_latency(GstClockTime latency) {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  latency_ = latency;
  if (follower_) follower_->set_latency(latency);
}

void MotionEngine::look_for_sink() {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  if (follower_) follower_->look_for_sink();
}

void MotionEngine::set_offset(GstClockTimeDiff offset_ns) {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  offset_ns_ = offset_ns;
  if (follower_) follower_->set_offset(offset_ns);
}

void MotionEngine::set_max_force(double max_force_N) {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  limits_.max_force_N = max_force_N;
  if (session_) session_->loop().set_limits(limits_);
}

void MotionEngine::set_muted(bool muted) {
  schedule_.set_muted(muted);
  limit_watch_.set_muted(muted);
  player_.set_muted(muted);
}

void MotionEngine::flush() {
  schedule_.forget();
  player_.forget();
}

void MotionEngine::expect_base_time() {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  if (follower_) follower_->expect_base_time();
}

void MotionEngine::skip(GstClockTime duration) {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  schedule_.skip(duration);
  if (follower_) follower_->set_skipped(schedule_.skipped_ns());
}

void MotionEngine::begin_segment() {
  schedule_.begin_segment();
  player_.restart();
  frames_in_segment_ = 0;
}

void MotionEngine::refresh_clock() {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  if (follower_) follower_->refresh();
}

GstStructure* MotionEngine::stats() const {
  GstStructure* structure = gst_structure_new_empty("spidar-motion-stats");
  stats_.describe(structure);
  describe_limit(force_limit(), structure);
  gst_structure_set(structure, "track-frames", G_TYPE_UINT64, player_.frames(), nullptr);
  const std::lock_guard<std::mutex> lock(session_mutex_);
  if (session_) {
    describe_session(*session_, structure);
    gst_structure_set(structure, "refused-wrenches", G_TYPE_UINT64,
                      schedule_.refused() + session_->loop().snapshot().counters.refused_wrenches,
                      nullptr);
  }
  return structure;
}

ForceLimit MotionEngine::force_limit() const {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  return limit_watch_.limit(open_loop(), true);
}

std::optional<LoopSnapshot> MotionEngine::open_loop() const {
  if (!session_) return std::nullopt;
  return session_->loop().snapshot();
}

std::optional<Eigen::Vector2d> MotionEngine::grip_place() const {
  if (!session_) return std::nullopt;
  const TickRecord tick = session_->loop().snapshot().last;
  if (tick.device != DeviceState::kRunning) return std::nullopt;
  return grip_pointer_.place(tick.pose.position_m);
}

bool MotionEngine::look_at_device(DeviceView& view) const {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  if (!session_) return false;
  view.name = session_->device().name();
  view.loop = session_->loop().snapshot();
  view.geometry = profile_.geometry;
  view.min_tension_N = profile_.min_tension_N();
  view.max_tension_N = profile_.max_tension_N();
  return true;
}

DeviceState MotionEngine::device_state() const {
  return session_ ? session_->loop().snapshot().last.device : DeviceState::kClosed;
}

void MotionEngine::change_rate(double multiplier, GstClockTime running_time,
                               GstClockTime upstream) {
  // Of a track everything, which the next frame gives again at the new rate. First, for what the
  // schedule hands on again stays.
  player_.forget();
  schedule_.change_rate(multiplier, running_time, upstream);
}

int64_t MotionEngine::pace(int64_t running_ns) {
  if (last_running_ns_ < 0) return running_ns;
  const double since_ns =
      static_cast<double>(running_ns - last_running_ns_) / schedule_.rate_multiplier();
  const double paced_ns = static_cast<double>(last_paced_ns_) + since_ns;
  if (std::fabs(paced_ns) > static_cast<double>(kLatest_ns)) return running_ns;  // anew
  return last_paced_ns_ + std::llround(since_ns);
}

void MotionEngine::restart() {
  analyzer_.restart();
}

void MotionEngine::restart_timing() {
  restart();
  {
    const std::lock_guard<std::mutex> lock(session_mutex_);
    schedule_.restart();
    player_.restart();
    if (follower_) follower_->set_skipped(0);
  }
  limit_watch_.forget();
  last_running_ns_ = -1;
  frames_in_segment_ = 0;
  last_interval_ns_ = 0;
}

void MotionEngine::run_out(GstClockTime running_time) {
  restart();
  if (!is_time(running_time)) return;  // what was scheduled expires by itself
  schedule_.add({static_cast<int64_t>(running_time), 0, Wrench()});
}

void MotionEngine::pass_gap(GstClockTime running_time) {
  if (!is_time(running_time)) {
    restart();
    return;
  }
  const int64_t running_ns = static_cast<int64_t>(running_time);
  const int64_t paced_ns = pace(running_ns);
  const int64_t since_ns = paced_ns - last_paced_ns_;
  const bool follows = last_running_ns_ >= 0 && since_ns > 0;
  // What videorate makes of a frame that is to be shown again.
  const std::optional<FrameAnalysis> analysis = follows ? analyzer_.repeat(paced_ns) : std::nullopt;
  if (analysis) {
    schedule_.add(
        {running_ns, WrenchTimeline::hold_after(since_ns), analysis->wrench, analysis->repeated});
    limit_watch_.repeat(schedule_.at_sink_ns(running_ns), analysis->wrench);
  } else {
    run_out(running_time);
    limit_watch_.repeat(schedule_.at_sink_ns(running_ns), Wrench());
  }
  last_paced_ns_ = paced_ns;
  last_running_ns_ = running_ns;
}

void MotionEngine::end_of_stream() {
  if (last_running_ns_ < 0) return;
  run_out(static_cast<GstClockTime>(last_running_ns_ + std::max<int64_t>(last_interval_ns_, 1)));
}

void MotionEngine::set_track(std::optional<TrackFile> track) {
  player_.set_track(std::move(track).value_or(TrackFile{}));
}

FrameReport MotionEngine::process(const GstVideoFrame& frame, const GstSegment& segment,
                                  const AnalyzerSettings& settings) {
  FrameReport report;
  const GstClockTime pts = GST_BUFFER_PTS(frame.buffer);
  if (segment.format != GST_FORMAT_TIME || !GST_CLOCK_TIME_IS_VALID(pts)) {
    restart();
    report.problem = FrameProblem::kNoTimestamp;
    return report;
  }
  report.running_time = shown_at(frame, segment);
  report.stream_time = gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, pts);
  if (!GST_CLOCK_TIME_IS_VALID(report.running_time)) {
    report.problem = FrameProblem::kNotShown;
    return report;
  }
  if (!is_time(report.running_time)) {
    restart();
    report.problem = FrameProblem::kNoTimestamp;
    return report;
  }
  const int64_t running_ns = static_cast<int64_t>(report.running_time);
  if (player_.active()) {
    const auto place = place_of(frame.buffer, nominal_duration(frame.info), segment,
                                schedule_.at_sink_ns(running_ns), schedule_.rate_multiplier());
    if (place) player_.play(*place);
    return report;
  }
  // Sources and decoders mark every buffer, or the first of every group, when they play backwards.
  if (GST_BUFFER_IS_DISCONT(frame.buffer) && segment.rate > 0) {
    restart();
  } else if (last_running_ns_ >= 0 && running_ns >= last_running_ns_ &&
             running_ns - last_running_ns_ < least_interval_ns(frame.info, segment.rate)) {
    // After an accurate seek what is left of the first frame may be next to nothing, and of the
    // segment before it nothing is left.
    if (frames_in_segment_ > 1) {
      report.problem = FrameProblem::kSameTimestamp;
      return report;
    }
    restart();
  } else if (running_ns < last_running_ns_) {
    restart();
    report.problem = FrameProblem::kFallingTimestamp;
  }

  if (!holds_picture(frame)) {
    restart();
    report.problem = FrameProblem::kTooSmall;
    return report;
  }
  const ImageView luma = luma_.view(frame);
  if (!luma.data) {
    restart();
    report.problem = FrameProblem::kNotShown;
    return report;
  }
  analyzer_.configure(settings);
  const int64_t begin_ns = HapticSession::monotonic_now_ns();
  const int64_t paced_ns = pace(running_ns);
  report.analysis = analyzer_.analyze(luma, paced_ns);
  report.analyzed = true;
  report.took_ns = HapticSession::monotonic_now_ns() - begin_ns;

  const bool in_place = running_ns == last_running_ns_;
  const int64_t since_ns =
      report.analysis.interval_ns > 0 || report.analysis.repeated ? paced_ns - last_paced_ns_ : 0;
  last_running_ns_ = running_ns;
  ++frames_in_segment_;
  last_paced_ns_ = paced_ns;
  if (since_ns > 0) last_interval_ns_ = since_ns;
  if (!in_place) {
    schedule_.add({running_ns, WrenchTimeline::hold_after(since_ns), report.analysis.wrench,
                   report.analysis.repeated});
  }
  limit_watch_.add(schedule_.at_sink_ns(running_ns), report.analysis, settings.motion);
  report.limit = limit_watch_.limit(open_loop(), false);
  if (trace_.is_open()) {
    report.trace_failed = !trace_.write(running_ns, static_cast<int64_t>(report.stream_time),
                                        report.analysis, report.limit);
  }
  stats_.add(report.analysis, report.took_ns);
  return report;
}

}  // namespace spidar
