// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/track_samples.h"

#include <cmath>
#include <cstdint>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <gst/gst.h>

#include "core/track/ahap.h"
#include "core/track/funscript.h"
#include "core/track/hjif.h"
#include "core/track/track_reader.h"
#include "plugin/tracks/film_reader.h"
#include "plugin/tracks/part_file.h"
#include "plugin/tracks/sidecar.h"
#include "plugin/tracks/track_file.h"

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

/// Which file has the track, and what is known of the film when `path` is one. Throws
/// std::runtime_error when that is a film without a track.
TrackCondition find_track(const std::string& path, Film& film) {
  TrackCondition found;
  found.track = path;
  for (const char* end : {".flac", ".wav", ".mka", ".hjif", ".funscript", ".ahap"}) {
    if (ends_with(path, end)) return found;
  }
  try {
    film = read_film(path);
  } catch (const std::runtime_error&) {
    return found;  // reading the track will tell why
  }
  found.film = path;
  if (film.has_track) return found;
  found.track = find_sidecar(path);
  if (found.track.empty()) {
    throw std::runtime_error(path + ": is a film without a haptic track, inside it or beside it; " +
                             "spidartrack record makes one");
  }
  return found;
}

/// Samples in memory, 1000 a second, as a file that `elements` make of them.
void write_sound(const PartFile& part, const std::string& bytes, size_t channels,
                 const std::string& elements,
                 const std::function<void(GstElement* pipeline)>& prepare = {}) {
  const PartFile raw(part.target() + ".raw");
  raw.write(bytes);
  StoredSound stored;
  run_pipeline(
      "filesrc name=raw_file ! "
      "rawaudioparse format=pcm pcm-format=f32le sample-rate=1000 num-channels=" +
          std::to_string(channels) + " ! " + elements +
          " ! fdsink sync=false fd=" + std::to_string(part.descriptor()),
      [&](GstElement* pipeline) {
        set_location(pipeline, "raw_file", raw.path());
        stored.watch(pipeline, "stored");
        if (prepare) prepare(pipeline);
      });
  stored.check(part);
}

template <typename Value>
std::string bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

/// One channel, in which nothing is above half the rate of a track.
void write_channel(const PartFile& part, const std::string& encoder,
                   const std::vector<TrackSample>& samples, const SaveOptions& options) {
  std::vector<float> values;
  values.reserve(samples.size());
  for (const TrackSample& sample : samples) values.push_back(sample[options.axis]);
  write_sound(part, bytes_of(values), 1,
              "audioresample quality=10 ! audio/x-raw,rate=" + std::to_string(options.rate_Hz) +
                  " ! " + encoder);
}

void write_channels(const PartFile& part, const std::string& encoder,
                    const std::vector<TrackSample>& samples, const TrackNotes& notes) {
  write_sound(
      part, bytes_of(samples), kTrackChannels,
      "capssetter name=samples caps=\"audio/x-raw,channel-mask=(bitmask)0x3f\" ! " + encoder,
      [&](GstElement* pipeline) {
        GstElement* element = gst_bin_get_by_name(GST_BIN(pipeline), "samples");
        GstPad* pad = gst_element_get_static_pad(element, "src");
        tag_track(pad, notes);
        gst_object_unref(pad);
        gst_object_unref(element);
      });
}

}  // namespace

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() &&
         g_ascii_strcasecmp(text.c_str() + text.size() - end.size(), end.c_str()) == 0;
}

void set_location(GstElement* pipeline, const char* name, const std::string& path) {
  GstElement* const element = gst_bin_get_by_name(GST_BIN(pipeline), name);
  g_object_set(element, "location", path.c_str(), nullptr);
  gst_object_unref(element);
}

std::string encoder_of(const std::string& path) {
  if (ends_with(path, ".flac")) {
    return "audioconvert dithering=none noise-shaping=none ! audio/x-raw,format=S24_32LE ! "
           "identity name=stored ! flacenc blocksize=40 seekpoints=0";
  }
  if (ends_with(path, ".mka")) return "identity name=stored ! matroskamux";
  if (ends_with(path, ".wav")) return "identity name=stored ! wavenc";
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

std::vector<TrackSample> load_track(const std::string& path, TrackCondition* condition,
                                    size_t funscript_axis) {
  Film film;
  TrackCondition found = find_track(path, film);
  std::vector<TrackSample> samples;
  if (ends_with(path, ".funscript")) {
    samples = read_funscript(read_text(path), funscript_axis);
  } else if (ends_with(path, ".ahap")) {
    throw std::runtime_error(path +
                             ": AHAP has neither directions nor torque, so it is written, but not "
                             "read; use the track that it was made from");
  } else if (ends_with(path, ".hjif")) {
    samples = read_hjif(read_text(path));
  } else {
    const TrackFile track = read_track_file(found.track);
    found.faults = track.faults;
    found.missing = track.missing();
    found.notes = track.notes;
    if (found.track != path) found.other = match_film(film, track.duration_ns, track.notes).problem;
    samples = samples_of(track);
  }
  if (condition) *condition = found;
  return samples;
}

void expect_own_track(const TrackCondition& condition) {
  if (condition.other.empty()) return;
  throw std::runtime_error(condition.track + ": is that of another film: " + condition.other);
}

void save_track(const std::string& path, const std::vector<TrackSample>& samples,
                const SaveOptions& options) {
  const std::string encoder = encoder_of(path);
  const bool is_hjif = ends_with(path, ".hjif"), is_ahap = ends_with(path, ".ahap");
  if (encoder.empty() && !is_hjif && !is_ahap && !ends_with(path, ".funscript")) {
    throw std::runtime_error(path + ": ends in none of .flac .mka .wav .hjif .ahap .funscript");
  }
  PartFile part(path);
  if (!encoder.empty() && options.rate_Hz > 0) {
    write_channel(part, encoder, samples, options);
  } else if (!encoder.empty()) {
    write_channels(part, encoder, samples, options.notes);
  } else if (is_hjif) {
    part.write(options.tolerance ? write_hjif(samples, *options.tolerance) : write_hjif(samples));
  } else if (is_ahap) {
    part.write(options.tolerance ? write_ahap(samples, *options.tolerance) : write_ahap(samples));
  } else {
    part.write(
        write_funscript(samples, options.axis, options.tolerance.value_or(kFunscriptTolerance)));
  }
  part.publish();
}

void StoredSound::watch(GstElement* pipeline, const char* name) {
  GstElement* const element = gst_bin_get_by_name(GST_BIN(pipeline), name);
  GstPad* const pad = gst_element_get_static_pad(element, "sink");
  gst_pad_add_probe(
      pad,
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM),
      flows, this, nullptr);
  gst_object_unref(pad);
  gst_object_unref(element);
}

GstPadProbeReturn StoredSound::flows(GstPad*, GstPadProbeInfo* info, gpointer user) {
  auto& self = *static_cast<StoredSound*>(user);
  if (info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) {
    GstEvent* const event = GST_PAD_PROBE_INFO_EVENT(info);
    if (GST_EVENT_TYPE(event) != GST_EVENT_CAPS) return GST_PAD_PROBE_OK;
    GstCaps* caps = nullptr;
    gst_event_parse_caps(event, &caps);
    const char* const format = gst_structure_get_string(gst_caps_get_structure(caps, 0), "format");
    self.format_ = format ? format : "";
    return GST_PAD_PROBE_OK;
  }
  GstMapInfo map;
  if (!gst_buffer_map(GST_PAD_PROBE_INFO_BUFFER(info), &map, GST_MAP_READ)) return GST_PAD_PROBE_OK;
  for (size_t i = 0; i < map.size; ++i) self.sum_ = (self.sum_ ^ map.data[i]) * 0x100000001b3;
  self.bytes_ += map.size;
  gst_buffer_unmap(GST_PAD_PROBE_INFO_BUFFER(info), &map);
  return GST_PAD_PROBE_OK;
}

void StoredSound::check(const PartFile& part) const {
  part.check_in_place();
  StoredSound read;
  std::string why;
  try {
    run_pipeline(
        "filesrc name=file ! decodebin ! audioconvert dithering=none noise-shaping=none ! "
        "audio/x-raw,layout=interleaved,format=" +
            format_ + " ! fakesink name=read sync=false",
        [&](GstElement* pipeline) {
          set_location(pipeline, "file", part.path());
          read.watch(pipeline, "read");
        });
  } catch (const std::runtime_error& error) {
    why = std::string(": ") + error.what();
  }
  if (why.empty() && read.bytes_ == bytes_ && read.sum_ == sum_) return;
  throw std::runtime_error(part.target() + ": what is read back is not what was written" + why);
}

}  // namespace spidar
