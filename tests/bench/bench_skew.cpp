// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Time from a picture to its force at the device, in real pipelines in real time, with the plugin
// as GStreamer loads it and the simulated device.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gst/base/gstbasesink.h>
#include <gst/gst.h>

#include "spidar/realtime/monotonic.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/busy_cores.h"
#include "tests/bench/call_timer.h"
#include "tests/bench/gst_pipeline.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace spidar;
using namespace spidar::bench;

struct Scenario {
  const char* what;    ///< for the table
  const char* player;  ///< that plays the clip, or nullptr for a live videotestsrc
  double rate = 1;
  int seeks = 0;        ///< before what is measured
  bool drifts = false;  ///< the pipeline's clock runs kDrift_ppm too fast
};

constexpr int kDrift_ppm = 300;

constexpr Scenario kScenarios[] = {
    {"file, playbin", "playbin"},
    {"file, playbin3", "playbin3"},
    {"live", nullptr},
    {"file at rate 0.5", "playbin", 0.5},
    {"file at rate 2", "playbin", 2},
    {"file after 100 seeks", "playbin", 1, 100},
    {"file, clock +300 ppm", "playbin", 1, 0, true},
    {"the same after 100 seeks", "playbin", 1, 100, true},
};

struct Measurement {
  /// Force − picture of each frame that was both shown and felt, ms.
  std::vector<double> skew_ms;
  uint64_t shown = 0;
  uint64_t dropped = 0;  ///< frames that came to the sink too late
  std::string scheduling;
};

/// A pipeline whose sink says when it has waited for a frame, and would begin to draw it.
class Player {
 public:
  Player(const Scenario& scenario, const std::string& clip, const std::string& trace)
      : scenario_(scenario), pipeline_(line(scenario, clip, trace)) {
    if (scenario.player) {
      g_object_get(pipeline_.get(), "video-sink", &screen_, "video-filter", &filter_, nullptr);
    } else {
      screen_ = pipeline_.by_name("screen").release();
      filter_ = pipeline_.by_name("motion").release();
    }
    g_signal_connect(screen_, "handoff", G_CALLBACK(see), this);
    bus_ = gst_element_get_bus(pipeline_.get());
    if (!scenario.drifts) return;
    auto* const clock = static_cast<GstClock*>(g_object_new(GST_TYPE_SYSTEM_CLOCK, nullptr));
    const GstClockTime now = gst_clock_get_internal_time(clock);
    gst_clock_set_calibration(clock, now, now, 1'000'000 + kDrift_ppm, 1'000'000);
    gst_pipeline_use_clock(GST_PIPELINE(pipeline_.get()), clock);
    gst_object_unref(clock);
  }
  ~Player() {
    stop();
    for (gpointer object : {gpointer(bus_), gpointer(screen_), gpointer(filter_)})
      gst_object_unref(object);
  }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  /// Plays, after the seeks if there are any. CLOCK_MONOTONIC at which nothing of before was on
  /// its way any more, and no frame of after had been shown.
  int64_t start() {
    int64_t begin_ns = monotonic_now_ns();
    set_state(GST_STATE_PAUSED);
    if (scenario_.rate != 1) seek(0);
    set_state(GST_STATE_PLAYING);
    std::mt19937 random(1);
    std::uniform_int_distribution<GstClockTime> position(0, 2 * GST_SECOND);
    for (int n = 0; n < scenario_.seeks; ++n) {
      play_for(0.02);
      begin_ns = seek(position(random));
    }
    return begin_ns;
  }

  void play_for(double seconds) {
    const int64_t end_ns = monotonic_now_ns() + static_cast<int64_t>(1e9 * seconds);
    for (int64_t left_ns; (left_ns = end_ns - monotonic_now_ns()) > 0;)
      take_messages(static_cast<GstClockTime>(left_ns));
  }
  void stop() { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }

  uint64_t dropped() const {
    guint64 dropped = 0;
    GstStructure* const stats = stats_of(screen_);
    gst_structure_get_uint64(stats, "dropped", &dropped);
    gst_structure_free(stats);
    return dropped;
  }
  /// What spidarmotion got of the real-time priority that it asks for.
  std::string scheduling() const {
    GstStructure* const stats = stats_of(filter_);
    const std::string scheduling = gst_structure_get_string(stats, "scheduling");
    gst_structure_free(stats);
    return scheduling;
  }
  /// CLOCK_MONOTONIC of each frame, by its running time; when it has stopped.
  const std::vector<std::pair<int64_t, int64_t>>& shown() const { return shown_; }

 private:
  static std::string line(const Scenario& scenario, const std::string& clip,
                          const std::string& trace) {
    const std::string filter = "spidarmotion name=motion haptic-trace=" + trace;
    // As GstVideoSink has them.
    const std::string screen =
        "fakesink name=screen sync=true signal-handoffs=true qos=true max-lateness=5000000 "
        "processing-deadline=15000000";
    if (scenario.player) {
      return std::string(scenario.player) + " uri=file://" + clip + " video-filter=\"" + filter +
             "\" video-sink=\"" + screen + "\"";
    }
    return "videotestsrc is-live=true pattern=ball ! video/x-raw,format=I420,width=1280,"
           "height=720,framerate=30000/1001 ! " +
           filter + " ! queue ! " + screen;
  }

  static void see(GstElement* sink, GstBuffer* buffer, GstPad*, gpointer self) {
    const int64_t now_ns = monotonic_now_ns();
    const GstClockTime running_time = gst_segment_to_running_time(
        &GST_BASE_SINK(sink)->segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
    if (GST_CLOCK_TIME_IS_VALID(running_time))
      static_cast<Player*>(self)->shown_.emplace_back(running_time, now_ns);
  }
  static GstStructure* stats_of(GstElement* element) {
    GstStructure* stats = nullptr;
    g_object_get(element, "stats", &stats, nullptr);
    return stats;
  }

  void set_state(GstState state) {
    gst_element_set_state(pipeline_.get(), state);
    await_state();
  }
  void await_state() {
    const GstStateChangeReturn result =
        gst_element_get_state(pipeline_.get(), nullptr, nullptr, 20 * GST_SECOND);
    take_messages(0);  // has the reason
    if (result == GST_STATE_CHANGE_FAILURE || result == GST_STATE_CHANGE_ASYNC)
      throw std::runtime_error("the pipeline does not get ready to play");
  }
  /// CLOCK_MONOTONIC at which what was before has been flushed.
  int64_t seek(GstClockTime position) {
    const auto flags = static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_KEY_UNIT);
    if (!gst_element_seek(pipeline_.get(), scenario_.rate, GST_FORMAT_TIME, flags,
                          GST_SEEK_TYPE_SET, static_cast<gint64>(position), GST_SEEK_TYPE_NONE, 0))
      throw std::runtime_error("the pipeline cannot seek");
    const int64_t flushed_ns = monotonic_now_ns();
    await_state();
    return flushed_ns;
  }
  void take_messages(GstClockTime timeout) {
    constexpr auto kTypes =
        static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS | GST_MESSAGE_LATENCY);
    while (GstMessage* const message = gst_bus_timed_pop_filtered(bus_, timeout, kTypes)) {
      timeout = 0;
      const GstMessageType type = GST_MESSAGE_TYPE(message);
      gst_message_unref(message);
      if (type == GST_MESSAGE_ERROR) throw std::runtime_error("the pipeline has failed");
      if (type == GST_MESSAGE_EOS) throw std::runtime_error("the clip is too short");
      gst_bin_recalculate_latency(GST_BIN(pipeline_.get()));
    }
  }

  const Scenario scenario_;
  Pipeline pipeline_;
  GstElement* screen_ = nullptr;
  GstElement* filter_ = nullptr;
  GstBus* bus_ = nullptr;
  std::vector<std::pair<int64_t, int64_t>> shown_;  // streaming thread
};

Measurement measure(const Scenario& scenario, const std::string& clip, double seconds) {
  constexpr double kLongest_s = 0.3;  // the force of what is shown last has so long to come
  const test::TemporaryFolder folder;
  const std::string trace = folder.path / "haptic.csv";
  Player player(scenario, clip, trace);
  Measurement result;
  const int64_t begin_ns = player.start();
  player.play_for(seconds);
  const int64_t end_ns = monotonic_now_ns();
  player.play_for(kLongest_s);
  result.dropped = player.dropped();
  result.scheduling = player.scheduling();
  player.stop();
  // Of the first tick of each frame; before a seek, the same running time was another frame.
  std::map<int64_t, int64_t> felt_ns;
  for (const std::vector<double>& tick : read_trace(trace, {"playing", "frame_ns", "monotonic_ns"}))
    if (tick[0] == 1 && tick[1] >= 0 && tick[2] >= static_cast<double>(begin_ns))
      felt_ns.emplace(std::llround(tick[1]), std::llround(tick[2]));
  for (const auto& [running_ns, shown_ns] : player.shown()) {
    if (shown_ns < begin_ns || shown_ns > end_ns) continue;
    ++result.shown;
    const auto tick = felt_ns.find(running_ns);
    if (tick != felt_ns.end())
      result.skew_ms.push_back(1e-6 * static_cast<double>(tick->second - shown_ns));
  }
  return result;
}

/// A ball jumps about for `seconds`: 1280x720, 29.97 frames/s, VP8 with a key frame every half
/// second, in AVI, which counts frames exactly. Throws std::runtime_error.
void make_clip(const std::string& path, int seconds) {
  constexpr int kFrames_s = 30;
  Pipeline pipeline("videotestsrc pattern=ball num-buffers=" + std::to_string(seconds * kFrames_s) +
                    " ! video/x-raw,format=I420,width=1280,height=720,framerate=30000/1001 "
                    "! vp8enc deadline=1 cpu-used=16 keyframe-max-dist=15 threads=2 ! avimux "
                    "! filesink location=\"" +
                    path + "\"");
  pipeline.play();
  pipeline.wait_for_end();
}

/// With lines between the columns, as documents have them.
void print_head() {
  double load_average = 0;
  getloadavg(&load_average, 1);
  std::printf(
      "skew: force at the device − picture at the sink, ms; 99 %%: of its size.\n"
      "busy: with a computing thread for every core.\n"
      "Load average before the start: %.2f; what else the machine does is in the figures.\n\n",
      load_average);
  std::printf("| %-25s | %-5s | %6s | %6s | %6s | %7s | %8s | %7s |\n", "playback", "cores",
              "frames", "median", "99 %", "worst", "not felt", "dropped");
  std::printf("|---|---|---|---|---|---|---|---|\n");
}

/// `fraction` between 0 and 1: of the sizes.
double size_of(std::vector<double> values, double fraction) {
  for (double& value : values) value = std::abs(value);
  return quantile(std::move(values), fraction);
}

void print_row(const Scenario& scenario, const char* cores, const Measurement& m) {
  std::printf("| %-25s | %-5s | %6llu | %+6.2f | %6.2f | %7.2f | %8llu | %7llu |\n", scenario.what,
              cores, static_cast<unsigned long long>(m.shown), quantile(m.skew_ms, 0.5),
              size_of(m.skew_ms, 0.99), size_of(m.skew_ms, 1),
              static_cast<unsigned long long>(m.shown - m.skew_ms.size()),
              static_cast<unsigned long long>(m.dropped));
}

/// False when there is nothing to report.
bool report(const Scenario& scenario, const char* cores, const std::string& clip, int seconds,
            std::string& scheduling) {
  try {
    const Measurement measurement = measure(scenario, clip, seconds);
    scheduling = measurement.scheduling;
    if (measurement.skew_ms.empty()) {
      throw std::runtime_error("no frame was both shown and felt");
    }
    print_row(scenario, cores, measurement);
    return true;
  } catch (const std::exception& error) {
    std::printf("| %-25s | %-5s | not measured: %s |\n", scenario.what, cores, error.what());
    return false;
  }
}

}  // namespace

int spidar::bench::skew(int argc, char** argv) {
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 6;
  if (seconds < 1) {
    throw std::invalid_argument(std::string(argv[1]) + " is not a number of seconds above 0");
  }
  print_head();
  const spidar::test::TemporaryFolder folder;
  const std::string clip = folder.path / "clip.avi";
  // At twice the rate, and with what is played before and after the measurement.
  make_clip(clip, 2 * seconds + 4);
  bool all_good = true;
  std::string scheduling;
  for (const Scenario& scenario : kScenarios) {
    all_good &= report(scenario, "free", clip, seconds, scheduling);
    const BusyCores load;
    all_good &= report(scenario, "busy", clip, seconds, scheduling);
  }
  std::printf("\nhaptic thread: %s\n", scheduling.c_str());
  return all_good ? 0 : 1;
}
