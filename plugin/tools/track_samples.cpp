// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/track_samples.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include <gst/gst.h>

#include "core/track/hjif.h"
#include "core/track/track_reader.h"
#include "plugin/tools/part_file.h"
#include "plugin/tools/trace_track.h"
#include "plugin/track/track_file.h"

namespace spidar {
namespace {

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<TrackSample> samples_of(const TrackFile& track) {
  std::vector<TrackSample> samples(
      static_cast<size_t>((track.duration_ns + kTrackPeriod_ns / 2) / kTrackPeriod_ns));
  TrackReader reader;
  size_t next = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    const auto time_ns = static_cast<int64_t>(i) * kTrackPeriod_ns;
    while (next < track.blocks.size() && reader.read(track.blocks[next], time_ns)) ++next;
    const TimelineResult result =
        reader.at(time_ns, next < track.blocks.size() ? &track.blocks[next] : nullptr);
    const bool has = result.found == Found::kExact || result.found == Found::kInterpolated;
    if (has) samples[i] = to_track_sample(result.wrench);
  }
  // Samples at whole milliseconds are copied bit by bit.
  for (const TrackBlock& block : track.blocks) {
    if (block.begin_ns % kTrackPeriod_ns != 0 || block.period_ns() != kTrackPeriod_ns) continue;
    for (size_t i = 0; i < block.count; ++i) {
      const auto index = static_cast<size_t>(block.time_ns(i) / kTrackPeriod_ns);
      if (index < samples.size()) samples[index] = block.samples[i];
    }
  }
  return samples;
}

void write_text(const PartFile& part, const std::string& text) {
  std::ofstream file(part.path(), std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(part.target() + ": cannot be written; the disk may be full");
}

/// Positions from 0 to 100 with 50 in the middle, wherever a straight line between the neighbouring
/// positions would be off by one step.
std::string funscript(const std::vector<TrackSample>& samples, size_t axis) {
  std::ostringstream out;
  out << R"({"version":"1.0","inverted":false,"range":100,"actions":[)";
  const auto position = [&](size_t i) {
    const double share = std::isfinite(samples[i][axis]) ? samples[i][axis] : 0;
    return std::lround(50 + 50 * std::clamp(share, -1.0, 1.0));
  };
  bool first = true;
  for (size_t i = 0; i < samples.size(); ++i) {
    const bool corner = i == 0 || i + 1 == samples.size() || position(i) != position(i - 1) ||
                        position(i) != position(i + 1);
    if (!corner) continue;
    out << (first ? "" : ",") << R"({"at":)" << i << R"(,"pos":)" << position(i) << '}';
    first = false;
  }
  out << "]}\n";
  return out.str();
}

void write_sound(const PartFile& part, const std::string& encoder,
                 const std::vector<TrackSample>& samples, const TrackNotes& notes) {
  const PartFile raw(part.target() + ".raw");
  const auto* bytes = reinterpret_cast<const char*>(samples.data());
  write_text(raw, std::string(bytes, samples.size() * sizeof(TrackSample)));
  run_pipeline(
      "filesrc name=raw_file ! "
      "rawaudioparse format=pcm pcm-format=f32le sample-rate=1000 num-channels=6 ! "
      "capssetter name=samples caps=\"audio/x-raw,channel-mask=(bitmask)0x3f\" ! " +
          encoder + " ! filesink name=file",
      [&](GstElement* pipeline) {
        set_location(pipeline, "raw_file", raw.path());
        set_location(pipeline, "file", part.path());
        GstElement* element = gst_bin_get_by_name(GST_BIN(pipeline), "samples");
        GstPad* pad = gst_element_get_static_pad(element, "src");
        tag_track(pad, notes);
        gst_object_unref(pad);
        gst_object_unref(element);
      });
}

}  // namespace

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

void set_location(GstElement* pipeline, const char* name, const std::string& path) {
  GstElement* const element = gst_bin_get_by_name(GST_BIN(pipeline), name);
  g_object_set(element, "location", path.c_str(), nullptr);
  gst_object_unref(element);
}

std::string quoted(const std::string& path) {
  std::string text = "\"";
  for (const char c : path) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + "\"";
}

std::string encoder_of(const std::string& path) {
  if (ends_with(path, ".flac")) {
    return "audioconvert dithering=none noise-shaping=none ! audio/x-raw,format=S24_32LE ! "
           "flacenc blocksize=40";
  }
  if (ends_with(path, ".mka")) return "matroskamux";
  if (ends_with(path, ".wav")) return "wavenc";
  return {};
}

void run_pipeline(const std::string& line, const std::function<void(GstElement* pipeline)>& prepare,
                  GstClockTime start_limit) {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(line.c_str(), &error);
  if (error) {
    const std::string text = error->message;
    g_error_free(error);
    if (pipeline) gst_object_unref(pipeline);
    throw std::runtime_error(text);
  }
  if (prepare) prepare(pipeline);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  std::exception_ptr problem;
  try {
    await_message(pipeline, GST_MESSAGE_EOS, GST_CLOCK_TIME_NONE, start_limit);
  } catch (const std::runtime_error&) {
    problem = std::current_exception();
  }
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
  if (problem) std::rethrow_exception(problem);
}

void await_message(GstElement* pipeline, GstMessageType awaited, GstClockTime limit,
                   GstClockTime start_limit) {
  constexpr GstClockTime kLook = 100 * GST_MSECOND;  // for a state change that failed in silence
  const auto types = static_cast<GstMessageType>(awaited | GST_MESSAGE_ERROR);
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* message = nullptr;
  GstClockTime waited = 0;
  for (bool failed = false; !message && !failed && waited < limit; waited += kLook) {
    const GstStateChangeReturn change = gst_element_get_state(pipeline, nullptr, nullptr, 0);
    failed = change == GST_STATE_CHANGE_FAILURE ||
             (change == GST_STATE_CHANGE_ASYNC && waited >= start_limit);
    message = gst_bus_timed_pop_filtered(bus, kLook, types);
  }
  gst_object_unref(bus);
  if (!message) {
    throw SilentFailure(
        "it cannot be played, and GStreamer does not say why: it may be damaged or cut off");
  }
  std::string problem;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
    GError* error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    problem = error->message;
    g_error_free(error);
  }
  gst_message_unref(message);
  if (!problem.empty()) throw std::runtime_error(problem);
}

std::vector<TrackSample> load_track(const std::string& path, TrackCondition* condition) {
  if (condition) *condition = {};
  if (ends_with(path, ".funscript")) {
    throw std::runtime_error(path +
                             ": a funscript has one of the six channels of a track, so it is "
                             "written, but not read; use the track that it was made from");
  }
  if (ends_with(path, ".hjif")) return read_hjif(read_text(path));
  if (ends_with(path, ".csv")) return read_csv_trace(path, read_text(path));
  if (ends_with(path, ".jsonl")) return read_json_trace(path, read_text(path));
  const TrackFile track = read_track_file(path);
  if (condition) *condition = {track.faults, track.missing(), track.notes};
  return samples_of(track);
}

void save_track(const std::string& path, const std::vector<TrackSample>& samples,
                const SaveOptions& options) {
  const std::string encoder = encoder_of(path);
  const bool is_hjif = ends_with(path, ".hjif");
  if (encoder.empty() && !is_hjif && !ends_with(path, ".funscript")) {
    throw std::runtime_error(path + ": ends in none of .flac .mka .wav .hjif .funscript");
  }
  PartFile part(path);
  if (!encoder.empty()) {
    write_sound(part, encoder, samples, options.notes);
  } else if (is_hjif) {
    write_text(part, write_hjif(samples, options.hjif_tolerance));
  } else {
    write_text(part, funscript(samples, options.funscript_axis));
  }
  part.publish();
}

}  // namespace spidar
