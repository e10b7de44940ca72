// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/cost/decoding.h"

#include <cmath>
#include <cstdlib>
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

/// What encode() has in its launch line.
std::string h264_encoding(double bit_s) {
  if (h264_encoder() == "x264enc") {
    return "x264enc speed-preset=veryfast bitrate=" + std::to_string(std::lround(1e-3 * bit_s));
  }
  return "openh264enc complexity=low bitrate=" + std::to_string(std::lround(bit_s)) +
         " ! h264parse";
}

}  // namespace

bool is_installed(const std::string& element) {
  GstElementFactory* factory = gst_element_factory_find(element.c_str());
  if (factory) gst_object_unref(factory);
  return factory != nullptr;
}

std::string h264_encoder() {
  for (const char* encoder : {"x264enc", "openh264enc"}) {
    if (is_installed(encoder)) return encoder;
  }
  return {};
}

std::string missing_for_decoding() {
  if (h264_encoder().empty()) return kNoEncoder;
  for (const char* needed : {"mp4mux", "qtdemux", "avdec_h264"}) {
    if (!is_installed(needed))
      return std::string("GStreamer element ") + needed + " is not installed";
  }
  return {};
}

void encode(const std::vector<test::Picture>& film, int count, int rate_Hz, const std::string& file,
            const std::string& encoding) {
  const int width = film.front().width;
  const int height = film.front().height;
  constexpr double kBitsPerPixel = 0.06;  // as of a film
  Pipeline pipeline(
      "appsrc name=source format=time block=true caps=video/x-raw,format=I420,width=" +
      std::to_string(width) + ",height=" + std::to_string(height) +
      ",framerate=" + std::to_string(rate_Hz) + "/1,colorimetry=bt709 ! " +
      (encoding.empty() ? h264_encoding(kBitsPerPixel * rate_Hz * width * height) + " ! mp4mux"
                        : encoding) +
      " ! filesink location=" + file);
  pipeline.play();
  const Element source = pipeline.by_name("source");
  const int last = static_cast<int>(film.size()) - 1;
  for (int n = 0; n < count; ++n) {
    const int at = last - std::abs(n % (2 * last) - last);  // 0 … last … 0
    GstBuffer* buffer = i420_buffer(film[static_cast<size_t>(at)]);
    set_time(buffer, n, rate_Hz);
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
