// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/track_samples.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <gst/gst.h>

#include "core/track/exchange_formats.h"
#include "core/track/track_reader.h"
#include "plugin/gobject/ref.h"
#include "plugin/tracks/file_pipeline.h"
#include "plugin/tracks/film_reader.h"
#include "plugin/tracks/part_file.h"
#include "plugin/tracks/sidecar.h"
#include "plugin/tracks/track_file.h"
#include "spidar/regular_file.h"

namespace spidar {
namespace {

/// Of HJIF and funscripts: a track of 24 hours has less.
constexpr size_t kMostText_bytes = size_t{1} << 30;

std::string read_text(const std::string& path) {
  try {
    return read_regular_file(path, kMostText_bytes);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
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

/// Sound that `encoder` makes of samples in memory.
void write_sound(const PartFile& part, const std::string& encoder,
                 const std::vector<TrackSample>& samples, const TrackNotes& notes) {
  const PartFile raw(part.target() + ".raw");
  raw.write({reinterpret_cast<const char*>(samples.data()), samples.size() * sizeof(TrackSample)});
  StoredSound stored;
  const FilePipeline file(
      "filesrc name=source ! "
      "rawaudioparse format=pcm pcm-format=f32le sample-rate=1000 num-channels=6 ! "
      "capssetter name=samples caps=\"audio/x-raw,channel-mask=(bitmask)0x3f\" ! " +
          encoder + " ! fdsink sync=false fd=" + std::to_string(part.descriptor()),
      raw.path());
  stored.watch(file.find("stored"));
  const Ref<GstPad> pad(gst_element_get_static_pad(file.find("samples"), "src"));
  tag_track(pad.get(), notes);
  file.play_until(GST_MESSAGE_EOS);
  file.stop();
  stored.check(part);
}

}  // namespace

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() &&
         g_ascii_strcasecmp(text.c_str() + text.size() - end.size(), end.c_str()) == 0;
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
    if (found.track != path) {
      const FilmMatch match = match_film(film, track.duration_ns, track.notes);
      found.other = match.problem;
      found.later_ns = match.later_ns;
    }
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
  if (!encoder.empty()) {
    write_sound(part, encoder, samples, options.notes);
  } else if (is_hjif) {
    part.write(options.tolerance ? write_hjif(samples, *options.tolerance) : write_hjif(samples));
  } else if (is_ahap) {
    part.write(write_ahap(samples, options.tolerance.value_or(kAhapTolerance), options.gain));
  } else {
    part.write(
        write_funscript(samples, options.axis, options.tolerance.value_or(kFunscriptTolerance)));
  }
  part.publish();
}

void StoredSound::watch(GstElement* element) {
  const Ref<GstPad> pad(gst_element_get_static_pad(element, "sink"));
  gst_pad_add_probe(
      pad.get(),
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM),
      flows, this, nullptr);
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
  g_checksum_update(self.sum_.get(), map.data, static_cast<gssize>(map.size));
  self.bytes_ += map.size;
  gst_buffer_unmap(GST_PAD_PROBE_INFO_BUFFER(info), &map);
  return GST_PAD_PROBE_OK;
}

void StoredSound::check(const PartFile& part) const {
  part.check_in_place();
  StoredSound read;
  std::string why;
  try {
    const FilePipeline file(
        "filesrc name=source ! decodebin ! audioconvert dithering=none noise-shaping=none ! "
        "audio/x-raw,layout=interleaved,format=" +
            format_ + " ! fakesink name=read sync=false",
        part.path());
    read.watch(file.find("read"));
    file.play_until(GST_MESSAGE_EOS);
    file.stop();
  } catch (const std::runtime_error& error) {
    why = std::string(": ") + error.what();
  }
  const bool is_same = read.bytes_ == bytes_ && g_str_equal(g_checksum_get_string(read.sum_.get()),
                                                            g_checksum_get_string(sum_.get()));
  if (why.empty() && is_same) return;
  throw std::runtime_error(part.target() + ": what is read back is not what was written" + why);
}

}  // namespace spidar
