// What the element costs beside the decoder it works for: a 1080p H.264 clip, decoded by avdec_h264
// in one thread, alone, with identity, and with spidarmotion.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>

#include <gst/app/gstappsrc.h>
#include <gst/gst.h>

#include "tests/support/picture.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/texture.h"

namespace {

using spidar::test::Picture;
using spidar::test::Texture;

constexpr int kWidth = 1920;
constexpr int kHeight = 1080;
constexpr int kFrames = 150;
constexpr int kStep_px = 6;

/// Processor time of all threads: what a pipeline costs, whoever else uses the machine.
double process_time_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

bool run_to_end(GstElement* pipeline) {
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
  const bool good = GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS;
  if (!good) {
    GError* error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    std::fprintf(stderr, "error: %s\n", error->message);
    g_error_free(error);
  }
  gst_message_unref(message);
  gst_object_unref(bus);
  return good;
}

/// A camera pans over a texture. The bit rate is that of a film.
bool encode(const std::string& file) {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(
      ("appsrc name=source format=time caps=video/x-raw,format=GRAY8,width=1920,height=1080,"
       "framerate=30/1 ! videoconvert ! video/x-raw,format=I420 ! x264enc speed-preset=veryfast "
       "bitrate=6000 ! mp4mux ! filesink location=" +
       file)
          .c_str(),
      &error);
  if (error) {
    std::fprintf(stderr, "%s\n", error->message);
    g_error_free(error);
    return false;
  }
  Picture sheet(kWidth + kFrames * kStep_px, kHeight);
  const Texture texture(1, 20);
  sheet.fill([&](double x, double y) { return texture.at(x, y); });
  GstElement* source = gst_bin_get_by_name(GST_BIN(pipeline), "source");
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  for (int n = 0; n < kFrames; ++n) {
    GstBuffer* buffer = gst_buffer_new_allocate(nullptr, gsize{kWidth} * kHeight, nullptr);
    for (int y = 0; y < kHeight; ++y) {
      gst_buffer_fill(buffer, gsize{kWidth} * static_cast<gsize>(y), &sheet.at(n * kStep_px, y),
                      kWidth);
    }
    GST_BUFFER_PTS(buffer) = gst_util_uint64_scale(static_cast<guint64>(n), GST_SECOND, 30);
    GST_BUFFER_DURATION(buffer) = GST_SECOND / 30;
    gst_app_src_push_buffer(GST_APP_SRC(source), buffer);
  }
  gst_app_src_end_of_stream(GST_APP_SRC(source));
  const bool good = run_to_end(pipeline);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(source);
  gst_object_unref(pipeline);
  return good;
}

/// Milliseconds a frame, the best of some passes: what disturbs makes it only longer.
double play_ms(const std::string& file, const std::string& filter) {
  double best_ms = 1e9;
  for (int pass = 0; pass < 5; ++pass) {
    GstElement* pipeline =
        gst_parse_launch(("filesrc location=" + file + " ! qtdemux ! avdec_h264 max-threads=1 ! " +
                          filter + " ! fakesink sync=false")
                             .c_str(),
                         nullptr);
    gst_element_set_state(pipeline, GST_STATE_PAUSED);
    gst_element_get_state(pipeline, nullptr, nullptr, GST_CLOCK_TIME_NONE);
    const double begin_ms = process_time_ms();
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    if (!run_to_end(pipeline)) std::exit(1);
    best_ms = std::min(best_ms, (process_time_ms() - begin_ms) / (kFrames - 1));
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
  }
  return best_ms;
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  for (const char* needed : {"x264enc", "mp4mux", "qtdemux", "avdec_h264", "spidarmotion"}) {
    GstElementFactory* factory = gst_element_factory_find(needed);
    if (!factory) {
      std::printf("skipped: GStreamer element %s is not installed\n", needed);
      return 77;  // meson: skipped
    }
    gst_object_unref(factory);
  }
  const spidar::test::TemporaryFolder folder;
  const std::string file = folder.path / "clip.mp4";
  if (!encode(file)) return 1;

  const double decode_ms = play_ms(file, "identity");
  std::printf("1920x1080, avdec_h264 in one thread: %.2f ms a frame\n", decode_ms);
  for (const char* filter :
       {"spidarmotion device=none post-messages=false", "spidarmotion device=none"}) {
    const double ms = play_ms(file, filter) - decode_ms;
    std::printf("+ %-45s %.2f ms a frame, %.0f %% of decoding\n", filter, ms, 100 * ms / decode_ms);
  }
  return 0;
}
