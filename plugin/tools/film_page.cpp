// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_page.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <glib.h>
#include <gst-spidar/gstspidarobjectmeta.h>

#include "core/force/motion_rendering.h"
#include "core/json_text.h"
#include "core/track/keyframes.h"
#include "plugin/films/file_pipeline.h"
#include "plugin/films/stream_content.h"
#include "plugin/gobject/ref.h"
#include "plugin/tools/film_page_html.h"
#include "plugin/tools/film_watch.h"
#include "plugin/tools/record_options.h"

namespace spidar::tools {
namespace {

/// Turns the film upright, as a browser shows it.
constexpr const char* kMeasuredFilm =
    "filesrc name=source ! decodebin name=decode videoconvert name=convert ! "
    "videoflip video-direction=auto ! spidarmotion name=motion device=none attach-meta=true ! "
    "fakesink sync=false";

GstPadProbeReturn measured(GstPad* pad, GstPadProbeInfo* info, gpointer user) {
  auto& boxes = *static_cast<std::vector<FeltBox>*>(user);
  GstBuffer* const frame = GST_PAD_PROBE_INFO_BUFFER(info);
  const GstClockTime at = stream_time_of(pad, frame);
  if (!GST_CLOCK_TIME_IS_VALID(at)) return GST_PAD_PROBE_OK;
  FeltBox box;
  box.stream_ns = static_cast<int64_t>(at);
  const Ref<GArray> objects(gst_buffer_get_spidar_objects(frame));
  for (guint i = 0; i < objects->len; ++i) {
    const auto& object = g_array_index(objects.get(), GstSpidarObject, i);
    if (!object.felt) continue;
    const double width = object.frame_width, height = object.frame_height;
    box.edges = {object.x / width, object.y / height, (object.x + object.w) / width,
                 (object.y + object.h) / height};
  }
  boxes.push_back(box);
  return GST_PAD_PROBE_OK;
}

}  // namespace

std::vector<FeltBox> find_felt_boxes(const std::string& film, const std::string& settings,
                                     const std::function<void(int percent)>& report) {
  const RecordProperties properties = properties_of(settings);
  std::vector<FeltBox> boxes;  // must outlive the pipeline
  FilmProgress progress(report);
  FilmWatch watch;
  const FilePipeline file(kMeasuredFilm, film, nullptr, kShareTimeout);
  GstElement* const motion = file.find("motion");
  set_properties(motion, properties);
  watch.begin(file.pipeline(), film);
  progress.watch(motion);
  const Ref<GstPad> frames(gst_element_get_static_pad(motion, "src"));
  gst_pad_add_probe(frames.get(), GST_PAD_PROBE_TYPE_BUFFER, measured, &boxes, nullptr);
  watch.play(file);
  return boxes;
}

namespace {

constexpr int kZero = 128, kSteps = 127;  // the byte for 0, and the steps from 0 to 1

/// Encodes a curve for curveOf() of the page.
std::string curve_text(const std::vector<float>& values, double tolerance, double most) {
  std::string bytes;
  size_t before = 0;
  KeyframeChooser points(tolerance, [&](size_t i, double value) {
    constexpr int kBits = 7;
    constexpr size_t kMore = size_t{1} << kBits;
    const size_t distance = i - before;
    int shift = 0;
    while (distance >> shift >= kMore) shift += kBits;
    for (; shift >= 0; shift -= kBits) {
      const size_t bits = (distance >> shift) % kMore;
      bytes += static_cast<char>(shift > 0 ? bits + kMore : bits);
    }
    bytes += static_cast<char>(kZero + std::lround(kSteps * value / most));
    before = i;
  });
  for (const float value : values) points.add(value);
  points.finish();
  return base64(bytes);
}

/// Returns JSON as the content of a script element, which only "<" could end.
std::string script_json(const Json& value) {
  std::string text;
  for (const char c : json_text(value)) text += c == '<' ? "\\u003c" : std::string(1, c);
  return text;
}

}  // namespace

std::string base64(const std::string& bytes) {
  return taken(g_base64_encode(reinterpret_cast<const guchar*>(bytes.data()), bytes.size()));
}

void FilmPage::add(const TrackSample& sample) {
  Eigen::Vector3d force_N = to_wrench(sample).force_N;
  for (size_t axis = 0; axis < kAxes; ++axis) {
    double& now_N = force_N[static_cast<Eigen::Index>(axis)];
    if (!std::isfinite(now_N)) now_N = 0;
    force_N_[axis].push_back(static_cast<float>(now_N));
  }
  largest_N_ = std::max(largest_N_, force_N.norm());
}

void FilmPage::set_boxes(const std::vector<FeltBox>& boxes) {
  constexpr double kStep_ns = 1e9 * kBoxStep_samples / kTrackRate_Hz;
  auto next = boxes.begin();
  for (size_t step = 0; kBoxStep_samples * step < force_N_[0].size(); ++step) {
    const double now_ns = kStep_ns * static_cast<double>(step);
    while (next != boxes.end() && static_cast<double>(next->stream_ns) <= now_ns) ++next;
    FeltBox box;  // interpolated between two frames
    if (next != boxes.begin()) box = *std::prev(next);
    if (box.is_known() && next != boxes.end() && next->is_known()) {
      const double share = (now_ns - static_cast<double>(box.stream_ns)) /
                           static_cast<double>(next->stream_ns - box.stream_ns);
      for (size_t i = 0; i < box.edges.size(); ++i) {
        box.edges[i] += share * (next->edges[i] - box.edges[i]);
      }
    }
    for (size_t i = 0; i < box.edges.size(); ++i) {
      edges_[i].push_back(static_cast<float>(2 * box.edges[i] - 1));
    }
  }
}

FilmPage::Html FilmPage::html(const std::string& url, const std::string& name,
                              const std::string& type, double later_s,
                              const std::string& unplayed) const {
  constexpr double kCoarser = 1.25;
  // In a picture from -1 to 1: half a per cent of the picture, the width of the drawn line.
  double edges_off = 2 * 0.005;
  constexpr double kMaxOff = 2 * 0.1;  // beyond that, the eye sees another place
  const std::string page = kFilmPage, place = "@TRACK@";
  const size_t at = page.find(place);
  const double most_N = std::max(largest_N_, kFeltForce_N);
  Json track = {{"film", name},
                {"url", url},
                {"type", type},
                {"unplayed", unplayed},
                {"later_s", later_s},
                {"step_s", 1.0 / kTrackRate_Hz},
                {"most_N", most_N},
                {"box_step_s", static_cast<double>(kBoxStep_samples) / kTrackRate_Hz},
                {"is_felt", largest_N_ >= kFeltForce_N}};
  Html html;
  // The precision begins at what a hand can feel, and becomes coarser until a long film fits.
  for (double lines_N = kFeltForce_N / 2;; lines_N *= kCoarser) {
    track["force"] = Json::array();
    for (const std::vector<float>& force_N : force_N_) {
      track["force"].push_back(curve_text(force_N, lines_N, most_N));
    }
    track["box"] = Json::array();
    // A box shows nothing when it is smaller than the errors and the rounding of two edges.
    track["least"] = edges_off + 0.5 / kSteps;
    for (const std::vector<float>& edge : edges_) {
      if (edges_off < kMaxOff) track["box"].push_back(curve_text(edge, edges_off, 1));
    }
    edges_off *= kCoarser;
    html.text = page;
    html.text.replace(at, place.size(), script_json(track));
    html.tolerance_N = lines_N + most_N / kSteps / 2;
    if (html.text.size() < kMax_bytes || lines_N > 2 * most_N) return html;
  }
}

}  // namespace spidar::tools
