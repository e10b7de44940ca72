// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/track_samples.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <unistd.h>

#include "core/track/funscript.h"
#include "core/track/track_reader.h"
#include "plugin/films/file_pipeline.h"
#include "plugin/films/film_reader.h"
#include "plugin/gobject/ref.h"
#include "plugin/tools/csv_track.h"
#include "plugin/tracks/exchange_file.h"
#include "plugin/tracks/open_track.h"
#include "plugin/tracks/sidecar.h"
#include "spidar/realtime/uninterrupted.h"
#include "spidar/whole_file.h"

namespace spidar::tools {
namespace {

constexpr size_t kAtOnce = 4096;  // samples

}  // namespace

void SampleFile::add(const TrackSample& sample) {
  waiting_.push_back(sample);
  ++count_;
  if (waiting_.size() == kAtOnce) flush();
}

void SampleFile::flush() {
  part_.write(
      {reinterpret_cast<const char*>(waiting_.data()), waiting_.size() * sizeof(TrackSample)});
  waiting_.clear();
}

SampleSource SampleFile::samples(double gain) const {
  return {count_, [this, gain](const SampleSource::Take& take) {
            std::vector<TrackSample> samples(kAtOnce);
            for (size_t at = 0; at < count_;) {
              const ssize_t got = uninterrupted([&] {
                return pread(part_.descriptor(), samples.data(),
                             samples.size() * sizeof(TrackSample),
                             static_cast<off_t>(at * sizeof(TrackSample)));
              });
              const size_t whole = got > 0 ? static_cast<size_t>(got) / sizeof(TrackSample) : 0;
              if (whole == 0) {
                throw std::runtime_error(
                    part_.path() + ": cannot be read: " + std::strerror(got < 0 ? errno : EIO));
              }
              for (size_t i = 0; i < whole; ++i) {
                for (float& value : samples[i]) value = static_cast<float>(gain * value);
                take(samples[i]);
              }
              at += whole;
            }
          }};
}

namespace {

/// The sample of `block` at `time_ns`, if it lies at a whole millisecond, for an exact copy.
std::optional<TrackSample> exact_sample(const TrackBlock& block, int64_t time_ns) {
  const bool is_whole =
      block.begin_ns % kTrackPeriod_ns == 0 && block.period_ns() == kTrackPeriod_ns;
  if (!is_whole || time_ns < block.begin_ns || time_ns >= end_of(block)) return std::nullopt;
  return block.samples[static_cast<size_t>((time_ns - block.begin_ns) / kTrackPeriod_ns)];
}

/// Passes 1000 samples a second to `take`, and returns the end of the track.
int64_t read_samples(tracks::OpenTrack& track, const SampleSource::Take& take) {
  TrackReader reader;
  TrackBlock block;
  int64_t end_ns = 0;
  bool is_block = track.next(block);
  for (int64_t time_ns = 0; is_block || time_ns + kTrackPeriod_ns / 2 <= end_ns;
       time_ns += kTrackPeriod_ns) {
    std::optional<TrackSample> exact;
    while (is_block) {
      end_ns = end_of(block);
      if (const auto sample = exact_sample(block, time_ns)) exact = sample;
      if (!reader.read(block, time_ns)) break;
      is_block = track.next(block);
    }
    if (time_ns + kTrackPeriod_ns / 2 > end_ns) break;
    const TimelineResult result = reader.at(time_ns, is_block ? &block : nullptr);
    const bool has = result.found == Found::kExact || result.found == Found::kInterpolated;
    take(exact ? *exact : has ? to_track_sample(result.wrench) : TrackSample{});
  }
  return end_ns;
}

/// Reads from a film, or from its track itself.
void read_sound(const std::string& path, const Film& film, const SampleSource::Take& take,
                TrackCondition& found) {
  const std::unique_ptr<tracks::OpenTrack> track = tracks::open_track(found.track);
  int64_t end_ns = 0;
  try {
    end_ns = read_samples(*track, take);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(found.track + ": " + error.what());
  }
  found.faults = track->blocks()->faults();
  found.missing = track->missing(end_ns);
  found.notes = track->notes();
  if (found.track != path) {
    const FilmMatch match = match_film(film, end_ns, found.notes);
    found.other = match.mismatch;
    found.later_ns = match.later_ns;
  }
}

/// Finds the file of the track, and facts about the film when `path` is one; no file when that film
/// has no track. Throws std::runtime_error when `path` is a picture.
TrackCondition find_track(const std::string& path, Film& film) {
  TrackCondition found;
  found.track = path;
  for (const char* end : {".flac", ".wav", ".mka", ".hjif", ".funscript", ".ahap", ".csv"}) {
    if (ends_with(path, end)) return found;
  }
  try {
    film = read_film(path);
  } catch (const std::runtime_error&) {
    return found;  // reading the track will report why
  }
  if (film.packets.size() == 1) {
    throw std::runtime_error(path + ": is a single picture, in which nothing moves");
  }
  found.film = path;
  if (film.has_track) return found;
  found.track = find_sidecar(path);
  if (found.track.empty()) found.track = tracks::find_exchange_file(path);
  return found;
}

void read_script(tracks::ScriptChoice choice, const SampleSource::Take& take,
                 TrackCondition& found) {
  choice.film = found.film;
  const tracks::ScriptSet set = tracks::read_scripts(found.track, choice);
  found.notes.origin = "funscript";
  found.about = set.about;
  for (const std::string& name : set.unfelt) found.about.push_back(name + ": is not read");
  for (int64_t ms = 0; ms < set.length_ms(); ++ms) take(set.at(ms));
}

void read_hjif_track(const SampleSource::Take& take, TrackCondition& found) {
  std::vector<std::string> unfelt;
  const std::vector<TrackSample> samples = tracks::read_hjif_file(found.track, unfelt);
  found.notes.origin = "hjif";
  for (const std::string& name : unfelt) found.about.push_back(name + ": is not read");
  for (const TrackSample& sample : samples) take(sample);
}

/// Stores caps until after the segment: flacenc pushes the end of a track that is no longer than
/// one of its blocks before its own caps, and GStreamer warns of that.
GstPadProbeReturn store_caps(GstPad* pad, GstPadProbeInfo* info, gpointer) {
  if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) != GST_EVENT_STREAM_START) {
    return GST_PAD_PROBE_OK;
  }
  const Ref<GstCaps> caps(gst_caps_new_empty_simple("audio/x-flac"));
  const Ref<GstEvent> event(gst_event_new_caps(caps.get()));
  gst_pad_store_sticky_event(pad, event.get());
  return GST_PAD_PROBE_REMOVE;
}

void write_sound(const PartFile& part, const std::string& encoder, const SampleFile& samples,
                 const tracks::Notes& notes) {
  StoredSound stored;
  const FilePipeline file(
      "filesrc name=source ! "
      "rawaudioparse format=pcm pcm-format=f32le sample-rate=1000 num-channels=6 ! "
      "capssetter name=samples caps=\"audio/x-raw,channel-mask=(bitmask)0x3f\" ! " +
          encoder + " ! fdsink sync=false fd=" + std::to_string(part.descriptor()),
      samples.path());
  stored.watch(file.find("stored"));
  const Ref<GstPad> pad(gst_element_get_static_pad(file.find("samples"), "src"));
  tracks::tag(pad.get(), notes);
  if (ends_with(part.target(), ".flac")) {
    const Ref<GstPad> encoded(gst_element_get_static_pad(file.find("flac"), "src"));
    gst_pad_add_probe(encoded.get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, store_caps, nullptr,
                      nullptr);
  }
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
           "identity name=stored ! flacenc name=flac blocksize=40 seekpoints=0";
  }
  if (ends_with(path, ".mka")) return "identity name=stored ! matroskamux";
  if (ends_with(path, ".wav")) return "identity name=stored ! wavenc";
  return {};
}

bool has_track(const std::string& path) {
  Film film;
  return !find_track(path, film).track.empty();
}

TrackCondition read_track(const std::string& path, const SampleSource::Take& take,
                          const tracks::ScriptChoice& script, const std::string& track) {
  Film film;
  TrackCondition found = find_track(path, film);
  if (!track.empty() && !found.film.empty()) found.track = track;
  if (found.track.empty()) {
    throw std::runtime_error(
        path + ": is a film without a haptic track, inside it or beside it; " +
        "spidartrack record makes one, and --folder FOLDER finds it elsewhere");
  }
  note_read(found.track);
  if (tracks::is_script(found.track)) {
    read_script(script, take, found);
  } else if (ends_with(found.track, ".ahap")) {
    throw std::runtime_error(found.track +
                             ": AHAP has neither directions nor torque, so it is written, but not "
                             "read; use the track that it was made from");
  } else if (ends_with(found.track, ".csv")) {
    found.notes.origin = "csv";
    read_csv(found.track, take);
  } else if (tracks::is_exchange_file(found.track)) {
    read_hjif_track(take, found);
  } else {
    read_sound(path, film, take, found);
  }
  return found;
}

void expect_own_track(const TrackCondition& condition) {
  if (condition.other.empty()) return;
  throw std::runtime_error(condition.track + ": is that of another film: " + condition.other);
}

void check_format(const std::string& path) {
  if (!encoder_of(path).empty()) return;
  for (const char* const end : {".hjif", ".ahap", ".funscript", ".csv"}) {
    if (ends_with(path, end)) return;
  }
  throw std::runtime_error(path + ": ends in none of .flac .mka .wav .hjif .ahap .funscript .csv");
}

void save_track(PartFile& part, const SampleFile& samples, const SaveOptions& options) {
  const std::string& path = part.target();
  const std::string encoder = encoder_of(path);
  if (!encoder.empty()) return write_sound(part, encoder, samples, options.notes);
  std::string waiting;
  constexpr size_t kBlock_bytes = size_t{1} << 16U;
  const auto write = [&](const std::string& text) {
    waiting += text;
    if (waiting.size() < kBlock_bytes) return;
    part.write(waiting);
    waiting.clear();
  };
  const SampleSource source = samples.samples(options.gain);
  if (ends_with(path, ".csv")) {
    write_csv(source, write);
  } else if (ends_with(path, ".hjif")) {
    write_hjif(source, write, options.tolerance.value_or(kHjifTolerance));
  } else if (ends_with(path, ".ahap")) {
    write_ahap(source, write, options.tolerance.value_or(kAhapTolerance), options.gain);
  } else {
    write_funscript(source, options.axis, write, options.tolerance.value_or(kFunscriptTolerance),
                    options.gain);
  }
  part.write(waiting);
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

}  // namespace spidar::tools
