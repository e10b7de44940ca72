// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/cost/decoding.h"

#include <ctime>

#include <gst/app/gstappsrc.h>

#include "tests/bench/gst_pipeline.h"

namespace spidar::bench {
namespace {

double process_time_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

}  // namespace

std::string missing_for_decoding() {
  for (const char* needed : {"x264enc", "mp4mux", "qtdemux", "avdec_h264"}) {
    GstElementFactory* factory = gst_element_factory_find(needed);
    if (!factory) return needed;
    gst_object_unref(factory);
  }
  return "";
}

void encode(const std::vector<test::Picture>& frames, int rate_Hz, const std::string& file) {
  const int width = frames.front().width;
  const int height = frames.front().height;
  constexpr double kBitsPerPixel = 0.06;  // as of a film
  const double kbit_s = 1e-3 * kBitsPerPixel * rate_Hz * width * height;
  Pipeline pipeline(
      "appsrc name=source format=time block=true caps=video/x-raw,format=I420,width=" +
      std::to_string(width) + ",height=" + std::to_string(height) +
      ",framerate=" + std::to_string(rate_Hz) + "/1,colorimetry=bt709 ! x264enc " +
      "speed-preset=veryfast bitrate=" + std::to_string(static_cast<int>(kbit_s)) +
      " ! mp4mux ! filesink location=" + file);
  pipeline.play();
  const Element source = pipeline.by_name("source");
  for (size_t n = 0; n < frames.size(); ++n) {
    GstBuffer* buffer = i420_buffer(frames[n]);
    set_time(buffer, static_cast<int>(n), rate_Hz);
    gst_app_src_push_buffer(GST_APP_SRC(source.get()), buffer);
  }
  gst_app_src_end_of_stream(GST_APP_SRC(source.get()));
  pipeline.wait_for_end();
}

double decoding_ms(const std::string& file, int frames, const std::string& filter) {
  Pipeline pipeline("filesrc location=" + file + " ! qtdemux ! avdec_h264 max-threads=1 ! " +
                    filter + " ! fakesink sync=false");
  pipeline.preroll();
  const double begin_ms = process_time_ms();
  pipeline.play();
  pipeline.wait_for_end();
  return (process_time_ms() - begin_ms) / (frames - 1);  // one was decoded before
}

}  // namespace spidar::bench
