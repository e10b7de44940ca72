// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_file.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <gst/gst.h>

#include "plugin/gobject/ref.h"
#include "plugin/tracks/file_pipeline.h"
#include "plugin/tracks/track_mark.h"

namespace spidar {
namespace {

constexpr const char* kDescription =
    "Wrench on the grip: fx fy fz tx ty tz; x right, y up, z towards the viewer. Full scale is 10 "
    "N and 1 N m.\n";
// Lines of the comment after the description.
constexpr const char* kFilm = "HAPTIC_FILM=";
constexpr const char* kSettings = "HAPTIC_SETTINGS=";

std::string comment_of(const TrackNotes& notes) {
  std::string comment = std::string(kDescription) + kTrackMark;
  if (!notes.film.empty()) comment += std::string("\n") + kFilm + to_text(notes.film);
  if (notes.settings) comment += std::string("\n") + kSettings + *notes.settings;
  return comment;
}

struct Tagging {
  TrackNotes notes;
  bool done = false;
};

/// Replaces all tags, which GStreamer may send again later, and sends some before the first buffer
/// if none has come.
GstPadProbeReturn replace_tags(GstPad* pad, GstPadProbeInfo* info, gpointer user) {
  auto& tagging = *static_cast<Tagging*>(user);
  if (info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) {
    if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) != GST_EVENT_TAG) return GST_PAD_PROBE_OK;
    GstEvent* const event = gst_event_new_tag(track_tags(tagging.notes));
    gst_event_unref(GST_PAD_PROBE_INFO_EVENT(info));
    GST_PAD_PROBE_INFO_DATA(info) = event;
  } else if (!tagging.done) {
    gst_pad_send_event(pad, gst_event_new_tag(track_tags(tagging.notes)));
  }
  tagging.done = true;
  return GST_PAD_PROBE_OK;
}

}  // namespace

GstTagList* track_tags(const TrackNotes& notes) {
  GstTagList* tags =
      gst_tag_list_new(GST_TAG_TITLE, "Haptic track", GST_TAG_COMMENT, comment_of(notes).c_str(),
                       GST_TAG_EXTENDED_COMMENT, kTrackMark, nullptr);
  gst_tag_list_set_scope(tags, GST_TAG_SCOPE_STREAM);
  return tags;
}

void read_notes(const GstTagList* tags, TrackNotes& notes) {
  const guint count = gst_tag_list_get_tag_size(tags, GST_TAG_COMMENT);
  for (guint i = 0; i < count; ++i) {
    gchar* comment = nullptr;
    if (!gst_tag_list_get_string_index(tags, GST_TAG_COMMENT, i, &comment)) continue;
    std::istringstream lines(comment);
    g_free(comment);
    for (std::string line; std::getline(lines, line);) {
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.rfind(kFilm, 0) == 0) {
        notes.film = parse_fingerprint(line.substr(std::string(kFilm).size()));
      } else if (line.rfind(kSettings, 0) == 0) {
        notes.settings = line.substr(std::string(kSettings).size());
      }
    }
  }
}

void tag_track(GstPad* pad, const TrackNotes& notes) {
  constexpr auto kAll =
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST |
                                   GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM);
  GstPad* into = gst_pad_get_peer(pad);
  gst_pad_add_probe(into, kAll, replace_tags, new Tagging{notes},
                    [](gpointer owned) { delete static_cast<Tagging*>(owned); });
  gst_object_unref(into);
}

namespace {

/// Which stream of a file is taken for the track.
enum class Wanted { kHapticTrack, kFirstSound };

struct Reading {
  const FilePipeline& file;
  const bool only_notes;
  const Wanted wanted;
  TrackInput input;
  TrackFile track;
  std::string problem;
  Ref<GstCaps> caps;
  std::atomic<bool> is_chosen{false};
  std::atomic<bool> has_sound{false};
  std::atomic<int> ended{0};  // streams
};

/// Ends reading before the end of the file, or where no stream is decoded.
void give_up(GstElement* element) {
  gst_element_post_message(
      element, gst_message_new_application(GST_OBJECT(element), gst_structure_new_empty("enough")));
}

bool is_wanted(const Reading& reading, StreamKind kind) {
  if (reading.is_chosen) return false;
  return kind == StreamKind::kHapticTrack ||
         (reading.wanted == Wanted::kFirstSound && kind == StreamKind::kSound);
}

/// The type of a file that nothing has taken apart, so that the stream is the file as it is: that
/// of Wave64, whose only decoder gives other values. Empty for all others.
std::string unparsed_type(GstPad* pad) {
  const Ref<GstPad> inner(gst_ghost_pad_get_target(GST_GHOST_PAD(pad)));
  const Ref<GstElement> source(inner ? gst_pad_get_parent_element(inner.get()) : nullptr);
  GstElementFactory* const factory = source ? gst_element_get_factory(source.get()) : nullptr;
  if (!factory || g_strcmp0(GST_OBJECT_NAME(factory), "typefind") != 0) return {};
  const Ref<GstCaps> caps(caps_of(pad));
  return gst_structure_get_name(gst_caps_get_structure(caps.get(), 0));
}

/// The first stream that is wanted is decoded, and all others are ignored.
GstElement* take_stream(Reading& reading, GstPad* pad) {
  const StreamKind kind = kind_of(pad);
  if (kind == StreamKind::kSound) reading.has_sound = true;
  if (!is_wanted(reading, kind)) return nullptr;
  reading.is_chosen = true;
  const std::string unparsed = unparsed_type(pad);
  if (unparsed.empty()) return reading.file.find("decode");
  reading.problem = "GStreamer cannot take " + unparsed +
                    " apart; make WAV, FLAC or Matroska of it, with ffmpeg for example.";
  give_up(GST_PAD_PARENT(pad));
  return nullptr;
}

/// Ends reading when all streams have ended, and none was wanted.
GstPadProbeReturn count_end(GstPad* pad, GstPadProbeInfo* info, gpointer user) {
  auto& reading = *static_cast<Reading*>(user);
  if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) != GST_EVENT_EOS) return GST_PAD_PROBE_OK;
  GstElement* const parser = GST_PAD_PARENT(pad);
  if (++reading.ended == parser->numsrcpads && !reading.is_chosen) give_up(parser);
  return GST_PAD_PROBE_OK;
}

void add_stream(GstElement*, GstPad* pad, gpointer user) {
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, count_end, user, nullptr);
}

/// Of sound that could be a track: six channels, at some rate.
std::string why_unmarked(const GstCaps* caps) {
  int rate_Hz = 0;
  gst_structure_get_int(gst_caps_get_structure(caps, 0), "rate", &rate_Hz);
  return "Nothing says that this sound of " + std::to_string(rate_Hz) +
         " Hz is a haptic track: a track has " + std::to_string(kTrackRate_Hz) +
         " samples a second, or the tag HAPTIC_FULL_SCALE. If it is one, mark it: " +
         how_to_mark() + ".";
}

/// Runs in the streaming thread of the pipeline that reads the file.
void take_buffer(GstElement*, GstBuffer* buffer, GstPad* pad, gpointer user) {
  auto& reading = *static_cast<Reading*>(user);
  const Ref<GstCaps> caps(gst_pad_get_current_caps(pad));
  if (caps.get() != reading.caps.get()) {  // also in the middle of a stream
    reading.problem = reading.input.set_caps(caps.get());
    if (reading.problem.empty() && reading.wanted == Wanted::kFirstSound)
      reading.problem = why_unmarked(caps.get());
    reading.caps.reset(gst_caps_ref(caps.get()));
    if (reading.only_notes || !reading.problem.empty()) give_up(GST_PAD_PARENT(pad));
  }
  if (reading.only_notes || !reading.problem.empty()) return;
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  reading.input.read(buffer, segment, 1, [&reading, pad](const TrackBlock& block) {
    if (block.begin_ns + block.duration_ns <= TrackFile::kLongest_ns) {
      reading.track.blocks.push_back(block);
      return GST_FLOW_OK;
    }
    reading.problem = "its samples reach to " + std::to_string(block.begin_ns / GST_SECOND) +
                      " s, and a track lasts at most 24 h: is a timestamp in it wrong?";
    give_up(GST_PAD_PARENT(pad));
    return GST_FLOW_EOS;
  });
}

/// All tags that have come to `pad`.
void read_tags(GstPad* pad, TrackNotes& notes) {
  for (guint i = 0; GstEvent* event = gst_pad_get_sticky_event(pad, GST_EVENT_TAG, i); ++i) {
    GstTagList* tags = nullptr;
    gst_event_parse_tag(event, &tags);
    read_notes(tags, notes);
    gst_event_unref(event);
  }
}

/// How many times as many samples as it has a file should have by its own head: above 1 for a WAV
/// file that is cut off, of which wavparse plays what is there. 1 for files that do not tell.
double promised_length(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const auto id = [&file] {
    std::string four(4, ' ');
    file.read(four.data(), 4);
    return four;
  };
  const auto number = [&file] {
    std::array<uint8_t, 4> bytes{};
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(file.get());
    return bytes[0] | bytes[1] << 8U | bytes[2] << 16U | static_cast<uint32_t>(bytes[3]) << 24U;
  };
  if (id() != "RIFF") return 1;
  file.seekg(12);
  while (id() != "data") {
    const uint32_t bytes = number();
    if (!file.seekg(bytes + bytes % 2, std::ios::cur)) return 1;
  }
  const uint32_t promised = number();
  const auto begin = file.tellg();
  const auto there = static_cast<double>(file.seekg(0, std::ios::end).tellg() - begin);
  // A writer that could not seek back has left 0 or the largest number.
  if (!file || there <= 0 || promised == UINT32_MAX) return 1;
  return std::max(1.0, promised / there);
}

/// Sorts what was read. Throws std::runtime_error when there is nothing.
void finish(Reading& reading) {
  std::vector<TrackBlock>& blocks = reading.track.blocks;
  if (blocks.empty()) throw std::runtime_error("there are no samples in it.");
  const auto earlier = [](const TrackBlock& a, const TrackBlock& b) {
    return a.begin_ns < b.begin_ns;
  };
  std::stable_sort(blocks.begin(), blocks.end(), earlier);
  reading.track.duration_ns = blocks.back().begin_ns + blocks.back().duration_ns;
  reading.track.faults = reading.input.faults();
}

TrackFile read(const std::string& path, bool only_notes, const std::atomic<bool>* stopped,
               Wanted wanted = Wanted::kHapticTrack) {
  FilePipeline file(
      "filesrc name=source ! parsebin name=parse decodebin name=decode ! audio/x-raw ! "
      "fakesink name=out signal-handoffs=true sync=false",
      path, stopped);
  Reading reading{file, only_notes, wanted, {}, {}, {}, {}};
  GstElement* const out = file.find("out");
  GstElement* const parser = file.find("parse");
  g_signal_connect(out, "handoff", G_CALLBACK(take_buffer), &reading);
  file.link_streams([&reading](GstPad* stream) { return take_stream(reading, stream); });
  g_signal_connect(parser, "pad-added", G_CALLBACK(add_stream), &reading);
  struct Stop {
    const FilePipeline& file;
    ~Stop() { file.stop(); }
  } const stop{file};  // before what its streaming threads use
  file.play_until(GST_MESSAGE_APPLICATION);
  const Ref<GstPad> pad(gst_element_get_static_pad(out, "sink"));
  read_tags(pad.get(), reading.track.notes);
  gint64 promised_ns = 0;
  // For a film this is the duration of its longest stream.
  if (parser->numsrcpads == 1 &&
      gst_element_query_duration(file.pipeline(), GST_FORMAT_TIME, &promised_ns)) {
    reading.track.promised_ns = promised_ns;
  }
  file.stop();
  if (!reading.problem.empty()) throw std::runtime_error(reading.problem);
  if (!reading.is_chosen) {
    if (!reading.has_sound) {
      throw std::runtime_error("There is no haptic track in it, and no sound.");
    }
    return read(path, only_notes, stopped, Wanted::kFirstSound);  // which tells why it is none
  }
  if (only_notes) return std::move(reading.track);
  finish(reading);
  if (const double times = promised_length(path); times > 1) {
    reading.track.promised_ns =
        static_cast<gint64>(times * static_cast<double>(reading.track.duration_ns));
  }
  return std::move(reading.track);
}

}  // namespace

std::string TrackFile::missing() const {
  // Containers round durations, to milliseconds or samples.
  if (promised_ns <= duration_ns + GST_MSECOND) return {};
  return "it is cut off: " + seconds_text(duration_ns) + " of " + seconds_text(promised_ns) +
         " are there";
}

TrackFile read_track_file(const std::string& path, const std::atomic<bool>* stopped) {
  try {
    return read(path, false, stopped);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

TrackNotes read_track_notes(const std::string& path) {
  try {
    return read(path, true, nullptr).notes;
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace spidar
