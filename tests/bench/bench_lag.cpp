// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// How much later than a motion on the screen its force is, measured from outside: the film of a
// disc that circles, whose position in each picture is exact; when the sink hands each picture on;
// and the force that the simulated device delivers. The disc's velocity turns with the time that
// the pictures are handed on by, and the force is behind it by an angle.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <gst/app/gstappsrc.h>
#include <gst/gst.h>

#include "spidar/realtime/monotonic.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/busy_cores.h"
#include "tests/bench/call_timer.h"
#include "tests/bench/gst_pipeline.h"
#include "tests/support/moving_scene.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace spidar;
using namespace spidar::bench;

constexpr int kWidth = 640, kHeight = 480;
constexpr double kRadius_px = 50, kCircle_px = 60, kTurns_Hz = 1;
/// Whole turns count: before, the filter learns how the motion changes.
constexpr int kFilm_s = 10, kBegin_s = 2, kEnd_s = 9;

double angle_at(double time_s) {
  return 2 * M_PI * kTurns_Hz * time_s;
}

/// In Motion JPEG: each picture is coded by itself.
void make_film(const std::string& path, int rate_Hz) {
  const std::string rate = std::to_string(rate_Hz);
  Pipeline pipeline(
      "appsrc name=pictures format=time caps=video/x-raw,format=I420,width=640,height=480,"
      "framerate=" +
      rate + "/1 ! jpegenc quality=95 ! avimux ! filesink location=\"" + path + "\"");
  const Element pictures = pipeline.by_name("pictures");
  pipeline.play();
  test::MovingScene scene(kWidth, kHeight);
  scene.add_disc(kRadius_px);
  test::Picture picture(kWidth, kHeight);
  for (int n = 0; n < kFilm_s * rate_Hz; ++n) {
    const double angle = angle_at(n / static_cast<double>(rate_Hz));
    const Eigen::Vector2d at_px(std::cos(angle), std::sin(angle));  // y down
    const ImageView drawn = scene.draw({}, {{kCircle_px * at_px}});
    picture.fill(
        [&](double x, double y) { return *drawn.at(static_cast<int>(x), static_cast<int>(y)); });
    GstBuffer* const buffer = i420_buffer(picture);
    set_time(buffer, n, rate_Hz);
    gst_app_src_push_buffer(GST_APP_SRC(pictures.get()), buffer);
  }
  gst_app_src_end_of_stream(GST_APP_SRC(pictures.get()));
  pipeline.wait_for_end();
}

/// CLOCK_MONOTONIC at which a picture was handed on, less its time in the film.
struct Screen {
  std::mutex mutex;
  std::vector<double> begin_s;
};

void see(GstElement*, GstBuffer* buffer, GstPad*, gpointer user) {
  const double now_s = 1e-9 * static_cast<double>(monotonic_now_ns());
  auto* const screen = static_cast<Screen*>(user);
  const std::lock_guard<std::mutex> lock(screen->mutex);
  screen->begin_s.push_back(now_s - 1e-9 * static_cast<double>(GST_BUFFER_PTS(buffer)));
}

/// Of the force, against the velocity of the disc when its pictures are handed on.
double lag_ms(const std::string& trace, double begin_s) {
  Eigen::Vector2d sum_N(0, 0);  // along the velocity, and behind it
  for (const std::vector<double>& tick :
       read_trace(trace, {"monotonic_ns", "delivered_force_x_N", "delivered_force_y_N"})) {
    const double film_s = 1e-9 * tick[0] - begin_s;
    if (film_s < kBegin_s || film_s >= kEnd_s) continue;
    const double angle = angle_at(film_s);
    Eigen::Matrix2d axes;
    axes << -std::sin(angle), -std::cos(angle), std::cos(angle), -std::sin(angle);
    sum_N += axes * Eigen::Vector2d(tick[1], tick[2]);  // y up
  }
  if (sum_N.isZero(0)) throw std::runtime_error("no force was delivered");
  return 1e3 * std::atan2(sum_N.y(), sum_N.x()) / (2 * M_PI * kTurns_Hz);
}

double measure(const std::string& film, const std::string& before, const std::string& after) {
  const test::TemporaryFolder folder;
  const std::string trace = folder.path / "haptic.csv";
  Screen screen;
  {
    Pipeline pipeline("filesrc location=\"" + film + "\" ! avidemux ! jpegdec ! " + before +
                      "spidarmotion haptic-trace=\"" + trace + "\" ! " + after +
                      "fakesink name=screen sync=true signal-handoffs=true");
    const Element sink = pipeline.by_name("screen");
    g_signal_connect(sink.get(), "handoff", G_CALLBACK(see), &screen);
    pipeline.play();
    pipeline.wait_for_end();
  }
  return lag_ms(trace, quantile(screen.begin_s, 0.5));
}

struct Path {
  const char* name;
  const char* before;
  const char* after;
};

constexpr Path kPaths[] = {
    {"a queue before the screen, as in players", "", "queue ! "},
    {"no queue", "", ""},
    // `identity` makes the pipeline live: the sink shows frames later by its processing-deadline.
    {"live, with the 20 ms of a sink", "identity sync=true ! ", "queue ! "},
};

}  // namespace

int spidar::bench::lag(int, char**) {
  std::printf(
      "lag of the delivered force behind the motion on the screen, ms; busy: with a computing\n"
      "thread for every core\n\n| frames/s |");
  for (const Path& path : kPaths) std::printf(" %s |", path.name);
  std::printf("\n|---|---|---|---|\n");
  for (const bool is_busy : {false, true}) {
    for (const int rate_Hz : {24, 30, 60}) {
      const test::TemporaryFolder folder;
      const std::string film = folder.path / "circle.avi";
      make_film(film, rate_Hz);
      std::printf("| %d%s |", rate_Hz, is_busy ? ", busy" : "");
      std::optional<BusyCores> load;
      if (is_busy) load.emplace();
      for (const Path& path : kPaths) {
        std::printf(" %.1f |", measure(film, path.before, path.after));
      }
      std::printf("\n");
    }
  }
  return 0;
}
