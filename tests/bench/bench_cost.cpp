// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Cost of the element in a pipeline, compared with identity, with the duration of a frame, and with
// a decoder; for moving frames, repeated frames, still frames and gaps.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include <gst/app/gstappsrc.h>
#include <gst/gst.h>

#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/bench/film_frames.h"
#include "tests/bench/gst_pipeline.h"
#include "tests/bench/paced_push.h"
#include "tests/support/film_studio.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace spidar::bench;
using spidar::test::Picture;

constexpr int kRate_Hz = 60;
constexpr double kInterval_ms = 1e3 / kRate_Hz;

struct Size {
  int width, height;
};

/// A camera that pans over a background with an object in front: drawn before anything is timed.
std::vector<Picture> film_of(const Size& size) {
  spidar::test::FilmStudio studio(size.width, size.height, 1);
  spidar::test::Film film = studio.pan_with_object();
  return draw_all(film, spidar::test::kFilmFrames);
}

void print_pushed(const Size& size, const std::vector<Picture>& film) {
  constexpr int kFrames = 60;
  constexpr int kPasses = 3;
  const std::vector<std::string> filters = {"", "identity", "spidarmotion device=none",
                                            "spidarmotion"};
  GstCaps* caps = gst_caps_new_simple("video/x-raw", "format", G_TYPE_STRING, "I420", "width",
                                      G_TYPE_INT, size.width, "height", G_TYPE_INT, size.height,
                                      "framerate", GST_TYPE_FRACTION, kRate_Hz, 1, nullptr);
  std::vector<GstBuffer*> frames;
  for (const Picture& picture : film) frames.push_back(i420_buffer(picture));

  std::printf(
      "\n### %dx%d\n\n"
      "| frames | source ! … ! fakesink | thread, µs | over identity, µs | %% of 1/%d s | wall, µs "
      "| 99 %% | other threads, %% of a core |\n|---|---|---|---|---|---|---|---|\n",
      size.width, size.height, kRate_Hz);
  const std::vector<std::pair<Content, const char*>> contents = {{Content::kMoving, "moving"},
                                                                 {Content::kRepeated, "repeated"},
                                                                 {Content::kStill, "still"},
                                                                 {Content::kGap, "GAP"}};
  for (const auto& [content, name] : contents) {
    std::map<std::string, PushCost> costs;
    // In turns: what disturbs meets all of them.
    for (int pass = 0; pass < kPasses; ++pass) {
      for (const std::string& filter : filters) {
        const PushCost cost = push_paced(filter, caps, frames, content, kFrames, kRate_Hz);
        PushCost& sum = costs[filter];
        sum.thread_ms.insert(sum.thread_ms.end(), cost.thread_ms.begin(), cost.thread_ms.end());
        sum.wall_ms.insert(sum.wall_ms.end(), cost.wall_ms.begin(), cost.wall_ms.end());
        sum.others += cost.others / kPasses;
      }
    }
    const double identity_ms = quantile(costs["identity"].thread_ms, 0.5);
    for (const std::string& filter : filters) {
      const PushCost& cost = costs[filter];
      const double thread_ms = quantile(cost.thread_ms, 0.5);
      const double over_ms = thread_ms - identity_ms;
      std::printf("| %s | %s | %.0f | %.0f | %.2f | %.0f | %.0f | %.1f |\n", name,
                  filter.empty() ? "(nothing)" : filter.c_str(), 1e3 * thread_ms, 1e3 * over_ms,
                  100 * over_ms / kInterval_ms, 1e3 * quantile(cost.wall_ms, 0.5),
                  1e3 * quantile(cost.wall_ms, 0.99), 100 * cost.others);
    }
  }
  for (GstBuffer* frame : frames) gst_buffer_unref(frame);
  gst_caps_unref(caps);
}

double process_time_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

/// Writes a film of `count` frames, which are those of `film` to and fro: H.264 in MP4.
void encode(const std::vector<Picture>& film, int count, int rate_Hz, const std::string& file) {
  const int width = film.front().width;
  const int height = film.front().height;
  constexpr double kBitsPerPixel = 0.06;  // as of a film
  Pipeline pipeline(
      "appsrc name=source format=time block=true caps=video/x-raw,format=I420,width=" +
      std::to_string(width) + ",height=" + std::to_string(height) + ",framerate=" +
      std::to_string(rate_Hz) + "/1,colorimetry=bt709 ! x264enc speed-preset=veryfast bitrate=" +
      std::to_string(std::lround(1e-3 * kBitsPerPixel * rate_Hz * width * height)) +
      " ! mp4mux ! filesink location=" + file);
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

/// Processor time of a frame of all threads, whoever else uses the machine, for playing `file` of
/// so many frames through avdec_h264 in one thread and `filter`.
double decoding_ms(const std::string& file, int frames, const std::string& filter) {
  Pipeline pipeline("filesrc location=" + file + " ! qtdemux ! avdec_h264 max-threads=1 ! " +
                    filter + " ! fakesink sync=false");
  pipeline.preroll();
  const double begin_ms = process_time_ms();
  pipeline.play();
  pipeline.wait_for_end();
  return (process_time_ms() - begin_ms) / (frames - 1);  // one was decoded before
}

void print_decoded(const Size& size, const std::vector<Picture>& film, const std::string& file) {
  constexpr int kPasses = 5;
  constexpr int kFrames = 88;  // as long as a decoder needs to get going
  encode(film, kFrames, kRate_Hz, file);
  const std::string filter = "spidarmotion device=none";
  std::map<std::string, double> best_ms;
  for (int pass = 0; pass < kPasses; ++pass) {
    for (const std::string& line : {std::string("identity"), filter}) {
      // What disturbs makes it only longer.
      const double ms = decoding_ms(file, kFrames, line);
      best_ms[line] = pass == 0 ? ms : std::min(best_ms[line], ms);
    }
  }
  const double decoding = best_ms["identity"];
  const double over_ms = best_ms[filter] - decoding;
  std::printf("| %dx%d | %.2f | %.2f | %.0f |\n", size.width, size.height, decoding, over_ms,
              100 * over_ms / decoding);
}

}  // namespace

int spidar::bench::cost(int, char**) {
  const spidar::test::TemporaryFolder folder;
  const std::vector<Size> sizes = {{1920, 1080}, {3840, 2160}};
  std::vector<std::vector<Picture>> films;
  for (const Size& size : sizes) {
    films.push_back(film_of(size));
    print_pushed(size, films.back());
  }
  std::printf("\n### Beside avdec_h264, one thread\n\n");
  std::printf("| size | decoding, ms | element, ms | %% of decoding |\n|---|---|---|---|\n");
  for (size_t i = 0; i < sizes.size(); ++i) {
    print_decoded(sizes[i], films[i], folder.path / (std::to_string(i) + ".mp4"));
  }
  return 0;
}
