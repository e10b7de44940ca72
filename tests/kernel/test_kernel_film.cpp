// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A film on force-feedback devices that need a long time for an update, or are unplugged and
/// plugged in again while it plays. The sink reports how late each frame was (QoS events). Time is
/// that of the virtual machine, which counts instructions: a busy host makes no frame late, but a
/// wait in the streaming thread does.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/kernel/uinput_device.h"
#include "tests/support/felt_player.h"

namespace spidar::test::kernel_film_test {
namespace {

constexpr int64_t kMs = kSecond_ns / 1000;
constexpr int kFramesPerSecond = 30;

/// A frame as the sink reports it.
struct Shown {
  GstClockTime running_ns;
  GstClockTimeDiff late_ns;  ///< negative: it came before its time, and waited for it
};

class Film {
 public:
  explicit Film(const std::string& device) {
    gst_init(nullptr, nullptr);
    // A frame that is more than 5 ms late is dropped, as by video sinks.
    const std::string launch =
        "videotestsrc pattern=ball motion=sweep ! video/x-raw,width=160,height=120,framerate=30/1 "
        "! spidarmotion device=" +
        device + " ! fakesink name=sink sync=true qos=true max-lateness=5000000";
    pipeline_ = gst_parse_launch(launch.c_str(), nullptr);
    if (!pipeline_) throw std::runtime_error("plugins are missing");
    sink_ = gst_bin_get_by_name(GST_BIN(pipeline_), "sink");
    bus_ = gst_element_get_bus(pipeline_);
    GstPad* pad = gst_element_get_static_pad(sink_, "sink");
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_EVENT_UPSTREAM, note, this, nullptr);
    gst_object_unref(pad);
    play();
  }
  ~Film() {
    stop();
    gst_object_unref(bus_);
    gst_object_unref(sink_);
    gst_object_unref(pipeline_);
  }
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  void play() {
    EXPECT_NE(gst_element_set_state(pipeline_, GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
  }
  void pause() { gst_element_set_state(pipeline_, GST_STATE_PAUSED); }
  void stop() { gst_element_set_state(pipeline_, GST_STATE_NULL); }

  size_t frames() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return shown_.size();
  }
  void wait_for_frames(size_t more) const {
    const size_t until = frames() + more;
    wait_for([&] { return frames() >= until; });
  }

  /// Frames from number `first` on: none is missing, and each came before its time.
  void expect_in_time(size_t first, const char* what) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    ASSERT_GT(shown_.size(), first + 1);
    GstClockTimeDiff latest_ns = shown_[first].late_ns;
    for (size_t i = first; i < shown_.size(); ++i) {
      EXPECT_LE(shown_[i].late_ns, 0) << what << ", frame " << i;
      latest_ns = std::max(latest_ns, shown_[i].late_ns);
      if (i == first) continue;
      // Times of frames are rounded to nanoseconds.
      const GstClockTime after_ns = shown_[i].running_ns - shown_[i - 1].running_ns;
      EXPECT_NEAR(static_cast<double>(after_ns), 1.0 * kSecond_ns / kFramesPerSecond, 1)
          << what << ", frame " << i;
    }
    GstStructure* stats = nullptr;
    g_object_get(sink_, "stats", &stats, nullptr);
    guint64 dropped = 0;
    EXPECT_TRUE(gst_structure_get_uint64(stats, "dropped", &dropped));
    EXPECT_EQ(dropped, 0u) << what;
    gst_structure_free(stats);
    std::printf("%s: %d frames, the latest of them %.1f ms before its time\n", what,
                static_cast<int>(shown_.size() - first), -1e-6 * static_cast<double>(latest_ns));
  }

  /// The text of the first warning that has not been read, without waiting.
  std::string warning() const {
    GstMessage* message = gst_bus_pop_filtered(
        bus_, static_cast<GstMessageType>(GST_MESSAGE_WARNING | GST_MESSAGE_ERROR));
    if (!message) return {};
    GError* error = nullptr;
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING)
      gst_message_parse_warning(message, &error, nullptr);
    else
      gst_message_parse_error(message, &error, nullptr);
    const std::string text = error->message;
    g_clear_error(&error);
    gst_message_unref(message);
    return text;
  }

 private:
  static GstPadProbeReturn note(GstPad*, GstPadProbeInfo* info, gpointer self) {
    GstEvent* event = GST_PAD_PROBE_INFO_EVENT(info);
    if (GST_EVENT_TYPE(event) != GST_EVENT_QOS) return GST_PAD_PROBE_OK;
    Shown frame{};
    gst_event_parse_qos(event, nullptr, nullptr, &frame.late_ns, &frame.running_ns);
    auto* film = static_cast<Film*>(self);
    const std::lock_guard<std::mutex> lock(film->mutex_);
    film->shown_.push_back(frame);
    return GST_PAD_PROBE_OK;
  }

  GstElement* pipeline_ = nullptr;
  GstElement* sink_ = nullptr;
  GstBus* bus_ = nullptr;
  mutable std::mutex mutex_;
  std::vector<Shown> shown_;
};

TEST(KernelFilm, NoFrameIsLateWhileAnUpdateTakes50Ms) {
  for (const int upload_ms : {0, 50}) {
    UinputDevice stick(UinputKind::kStick);
    const std::string device = listed();
    stick.upload_ms = upload_ms;
    Film film(device);
    wait_for([&] { return !stick.at_rest(); });
    const size_t first = film.frames();
    const int uploads = stick.uploads;
    film.wait_for_frames(2 * kFramesPerSecond);
    EXPECT_GT(stick.uploads, uploads + 10);  // there was something to wait for
    film.expect_in_time(first, upload_ms == 0 ? "updates at once" : "updates of 50 ms");
    EXPECT_EQ(film.warning(), "");
  }
}

TEST(KernelFilm, PlaysOnWhileTheStickIsUnpluggedAndPluggedIn) {
  auto stick = std::make_unique<UinputDevice>(UinputKind::kStick);
  listed();
  Film film("ff");
  wait_for([&] { return !stick->at_rest(); });
  const size_t first = film.frames();

  film.wait_for_frames(kFramesPerSecond / 2);
  // In the middle of an update.
  stick->upload_ms = 50;
  wait_for([&] { return stick->uploading.load(); });
  stick.reset();
  std::string warning;
  wait_for([&] { return !(warning = film.warning()).empty(); });
  EXPECT_EQ(warning,
            "The haptic device does not answer: unplugged. The video continues without it.");
  film.wait_for_frames(kFramesPerSecond / 2);

  stick = std::make_unique<UinputDevice>(UinputKind::kStick);
  stick->upload_ms = 50;
  wait_for([&] { return !stick->at_rest(); });
  film.wait_for_frames(kFramesPerSecond);
  film.expect_in_time(first, "unplugged and plugged in");
  EXPECT_EQ(film.warning(), "");
  film.stop();
  EXPECT_FALSE(stick->has_effects());
}

TEST(KernelFilm, APauseIsAtZeroWithin60Ms) {
  UinputDevice stick(UinputKind::kStick);
  Film film(listed());
  wait_for([&] { return !stick.at_rest(); });
  for (int times = 0; times < 3; ++times) {
    film.wait_for_frames(kFramesPerSecond / 3);
    wait_for([&] { return !stick.at_rest(); });
    const int64_t paused_ns = monotonic_now_ns();
    film.pause();
    wait_for([&] { return stick.at_rest(); });
    const int64_t taken_ns = monotonic_now_ns() - paused_ns;
    std::printf("film paused: at zero after %.1f ms\n", 1e-6 * static_cast<double>(taken_ns));
    EXPECT_LE(taken_ns, 60 * kMs);
    film.play();
  }
}

}  // namespace
}  // namespace spidar::test::kernel_film_test
