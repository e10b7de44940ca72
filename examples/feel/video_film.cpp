#include "examples/feel/video_film.h"

#include <filesystem>
#include <memory>
#include <stdexcept>

#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gst/video/video.h>

namespace spidar {
namespace {

struct Unref {
  void operator()(GstElement* element) const {
    gst_element_set_state(element, GST_STATE_NULL);
    gst_object_unref(element);
  }
  void operator()(GstSample* sample) const { gst_sample_unref(sample); }
  void operator()(GstBus* bus) const { gst_object_unref(bus); }
  void operator()(GstMessage* message) const { gst_message_unref(message); }
};
template <typename T>
using Ref = std::unique_ptr<T, Unref>;

std::string take_text(GError* error) {
  const std::string text = error ? error->message : "unknown error";
  g_clear_error(&error);
  return text;
}

void throw_if_failed(GstElement* pipeline, const std::string& path) {
  const Ref<GstBus> bus(gst_element_get_bus(pipeline));
  const Ref<GstMessage> message(gst_bus_pop_filtered(bus.get(), GST_MESSAGE_ERROR));
  if (!message) return;
  GError* error = nullptr;
  gst_message_parse_error(message.get(), &error, nullptr);
  throw std::runtime_error(path + ": " + take_text(error));
}

void add(FilmRecorder& recorder, GstSample* sample) {
  GstVideoInfo info;
  GstVideoFrame frame;
  GstBuffer* const buffer = gst_sample_get_buffer(sample);
  if (!gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) ||
      !gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ)) {
    throw std::runtime_error("a frame cannot be read");
  }
  const guint64 time = gst_segment_to_running_time(gst_sample_get_segment(sample), GST_FORMAT_TIME,
                                                   GST_BUFFER_PTS(buffer));
  if (GST_CLOCK_TIME_IS_VALID(time)) {
    recorder.add({static_cast<const uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0)),
                  GST_VIDEO_FRAME_WIDTH(&frame), GST_VIDEO_FRAME_HEIGHT(&frame),
                  GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0)},
                 static_cast<int64_t>(time));
  }
  gst_video_frame_unmap(&frame);
}

}  // namespace

Film read_film(const std::string& path, const AnalyzerSettings& settings) {
  gst_init(nullptr, nullptr);
  GError* error = nullptr;
  const Ref<GstElement> pipeline(gst_parse_launch(
      "filesrc name=file ! decodebin ! videoconvert ! video/x-raw,format=(string){I420,NV12,GRAY8} "
      "! appsink name=frames sync=false max-buffers=4",
      &error));
  if (!pipeline || error) throw std::runtime_error("GStreamer: " + take_text(error));
  const Ref<GstElement> source(gst_bin_get_by_name(GST_BIN(pipeline.get()), "file"));
  const Ref<GstElement> sink(gst_bin_get_by_name(GST_BIN(pipeline.get()), "frames"));
  g_object_set(source.get(), "location", path.c_str(), nullptr);
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  FilmRecorder recorder(std::filesystem::path(path).filename().string(), settings);
  while (const Ref<GstSample> sample{gst_app_sink_pull_sample(GST_APP_SINK(sink.get()))}) {
    add(recorder, sample.get());
  }
  throw_if_failed(pipeline.get(), path);
  if (recorder.film().frames.empty()) throw std::runtime_error(path + ": there is no video in it");
  return recorder.film();
}

}  // namespace spidar
