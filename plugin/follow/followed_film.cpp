// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/follow/followed_film.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include <gst/pbutils/pbutils.h>

#include "plugin/films/film_reader.h"
#include "plugin/films/stream_content.h"
#include "plugin/follow/position_filter.h"
#include "plugin/gobject/ref.h"
#include "plugin/tracks/open_track.h"
#include "plugin/tracks/sidecar.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::follow {
namespace {

/// A larger error is not corrected little by little: at 2 % of the time that would take seconds.
constexpr int64_t kSmall_ns = 60'000'000;
/// Until the first positions after a jump are told, more is not known than where it was to lead.
constexpr int64_t kSettles_ns = 1'000'000'000;
/// A larger one needs other parts of the film; a smaller one only another time for them.
constexpr int64_t kNear_ns = 500'000'000;
/// It takes a picture, at most.
constexpr GstClockTime kLongestPause = 200 * GST_MSECOND;

struct FilmTrack {
  std::string path;  ///< empty: the film has none
  int64_t later_ns = 0;
};

/// Throws std::runtime_error when there is one that is not that of the film.
FilmTrack track_of(const std::string& path, const Film& film) {
  const std::string beside = find_sidecar(path);
  if (beside.empty()) return {film.has_track ? path : "", 0};
  const std::unique_ptr<tracks::OpenTrack> track = tracks::open_track(beside);
  const int64_t end_ns = track->duration_ns() ? *track->duration_ns() : tracks::find_end(*track);
  const FilmMatch match = match_film(film, end_ns, track->notes());
  if (!match.mismatch.empty()) throw std::runtime_error(beside + ": " + match.mismatch);
  return {beside, match.later_ns};
}

GstElement* parse(const char* line) {
  GError* error = nullptr;
  GstElement* const pipeline = gst_parse_launch(line, &error);
  if (!error) return pipeline;
  const std::string what = error->message;
  g_clear_error(&error);
  gst_clear_object(const_cast<GstElement**>(&pipeline));
  throw std::runtime_error(what);
}

/// The first stream that is a haptic track is felt.
void link_track(GstElement*, GstPad* pad, gpointer decode) {
  const Ref<GstPad> sink(gst_element_get_static_pad(GST_ELEMENT(decode), "sink"));
  if (!gst_pad_is_linked(sink.get()) && content_of(pad) == StreamContent::kHapticTrack) {
    gst_pad_link(pad, sink.get());
  }
}

void print_missing(GstMessage* message) {
  if (!gst_is_missing_plugin_message(message)) return;
  gchar* const what = gst_missing_plugin_message_get_description(message);
  tell(std::string("not installed for GStreamer: ") + what +
       "; Debian has most decoders in gstreamer1.0-libav");
  g_free(what);
}

/// Prints the text of a message, if it is for people.
void print(GstMessage* message) {
  GError* error = nullptr;
  switch (GST_MESSAGE_TYPE(message)) {
    case GST_MESSAGE_ERROR:
      gst_message_parse_error(message, &error, nullptr);
      break;
    case GST_MESSAGE_WARNING:
      gst_message_parse_warning(message, &error, nullptr);
      break;
    case GST_MESSAGE_INFO:
      gst_message_parse_info(message, &error, nullptr);
      break;
    default:
      return print_missing(message);
  }
  tell(error->message);
  g_clear_error(&error);
}

void give_base_time(const GValue* element, gpointer base) {
  gst_element_set_base_time(GST_ELEMENT(g_value_get_object(element)),
                            *static_cast<GstClockTime*>(base));
}

}  // namespace

FollowedFilm::FollowedFilm(const std::string& uri, const std::vector<std::string>& properties)
    : pipeline_(nullptr, [](GstElement* pipeline) {
        gst_element_set_state(pipeline, GST_STATE_NULL);
        gst_object_unref(pipeline);
      }) {
  gchar* const name = g_filename_from_uri(uri.c_str(), nullptr, nullptr);
  const std::string path = name ? name : "";
  g_free(name);
  FilmTrack track;
  try {
    if (!path.empty()) {
      const Film film = read_film(path);
      frame_ns_ = film.frame_ns;
      track = track_of(path, film);
    }
  } catch (const std::runtime_error& error) {
    tell(std::string(error.what()) + "; the film is analysed");
  }
  if (track.path.empty()) {
    build_film(uri);
  } else {
    build_track(track.path, track.later_ns);
  }
  set_properties(properties);
  // The base time is set by hand.
  gst_element_set_start_time(pipeline_.get(), GST_CLOCK_TIME_NONE);
  const Ref<GstClock> clock(gst_system_clock_obtain());
  gst_pipeline_use_clock(GST_PIPELINE(pipeline_.get()), clock.get());
  gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
}

FollowedFilm::~FollowedFilm() {
  pause();
}

void FollowedFilm::build_track(const std::string& path, int64_t later_ns) {
  pipeline_.reset(
      parse("filesrc name=source ! parsebin name=parse decodebin name=decode ! audioconvert "
            "dithering=none noise-shaping=none ! spidarsink name=felt"));
  GstBin* const bin = GST_BIN(pipeline_.get());
  const Ref<GstElement> source(gst_bin_get_by_name(bin, "source"));
  const Ref<GstElement> parser(gst_bin_get_by_name(bin, "parse"));
  const Ref<GstElement> decoder(gst_bin_get_by_name(bin, "decode"));
  const Ref<GstElement> felt(gst_bin_get_by_name(bin, "felt"));
  felt_ = sink_ = felt.get();
  g_object_set(source.get(), "location", path.c_str(), nullptr);
  g_object_set(felt_, "ts-offset", later_ns, "accept-unmarked", TRUE, nullptr);
  g_signal_connect(parser.get(), "pad-added", G_CALLBACK(link_track), decoder.get());
  tell("the haptic track " + path + " is felt");
}

void FollowedFilm::build_film(const std::string& uri) {
  pipeline_.reset(parse(
      // With any feature of its memory: decoders of FFmpeg name interlaced pictures beside others.
      "uridecodebin name=source caps=video/x-raw(ANY) expose-all-streams=false ! videoconvert ! "
      "spidarmotion name=felt ! queue max-size-buffers=3 ! fakesink name=sink sync=true qos=true"));
  GstBin* const bin = GST_BIN(pipeline_.get());
  const Ref<GstElement> source(gst_bin_get_by_name(bin, "source"));
  const Ref<GstElement> felt(gst_bin_get_by_name(bin, "felt"));
  const Ref<GstElement> sink(gst_bin_get_by_name(bin, "sink"));
  felt_ = felt.get();
  sink_ = sink.get();
  g_object_set(source.get(), "uri", uri.c_str(), nullptr);
  tell(uri + " is analysed");
}

void FollowedFilm::set_properties(const std::vector<std::string>& properties) {
  std::string others;
  for (const std::string& property : properties) {
    const size_t end = property.find('=');
    const std::string name = property.substr(0, end), value = property.substr(end + 1);
    if (name == "preset" && GST_IS_PRESET(felt_)) {
      gst_preset_load_preset(GST_PRESET(felt_), value.c_str());
    } else if (g_object_class_find_property(G_OBJECT_GET_CLASS(felt_), name.c_str())) {
      gst_util_set_object_arg(G_OBJECT(felt_), name.c_str(), value.c_str());
    } else {
      others += (others.empty() ? "" : ", ") + name;
    }
  }
  // Of spidarmotion, which looks at pictures.
  if (!others.empty()) tell("a track is played as it is, so these have no effect: " + others);
}

bool FollowedFilm::check() {
  const Ref<GstBus> bus(gst_element_get_bus(pipeline_.get()));
  while (GstMessage* const message = gst_bus_pop(bus.get())) {
    print(message);
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) failed_ = true;
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ASYNC_DONE) read_segment();
    gst_message_unref(message);
  }
  return !failed_;
}

void FollowedFilm::read_segment() {
  const Ref<GstPad> pad(gst_element_get_static_pad(sink_, "sink"));
  GstEvent* const event = gst_pad_get_sticky_event(pad.get(), GST_EVENT_SEGMENT, 0);
  if (!event) return;
  GstSegment segment;
  gst_event_copy_segment(event, &segment);
  gst_event_unref(event);
  const guint64 stream = gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, segment.start);
  const guint64 running = gst_segment_to_running_time(&segment, GST_FORMAT_TIME, segment.start);
  begin_position_ns_ = static_cast<int64_t>(stream);
  begin_running_ns_ = static_cast<int64_t>(running);
  ready_ = true;
  if (seek_began_ns_ > 0) seek_took_ns_ = monotonic_now_ns() - seek_began_ns_;
  seek_began_ns_ = 0;
}

int64_t FollowedFilm::running_at(int64_t position_ns) const {
  const auto since_ns = static_cast<double>(position_ns - begin_position_ns_);
  return begin_running_ns_ + std::llround(since_ns / rate_);
}

int64_t FollowedFilm::position_at(int64_t now_ns) const {
  if (!playing_) return paused_at_ns_;
  const auto since_ns = static_cast<double>(now_ns - base_ns_ - begin_running_ns_);
  return begin_position_ns_ + std::llround(since_ns * rate_);
}

void FollowedFilm::set_base_time(int64_t base_ns) {
  base_ns_ = base_ns;
  auto base = static_cast<GstClockTime>(base_ns);
  gst_element_set_base_time(pipeline_.get(), base);
  GstIterator* const all = gst_bin_iterate_recurse(GST_BIN(pipeline_.get()));
  // Elements that come meanwhile get it from their bin.
  while (gst_iterator_foreach(all, give_base_time, &base) == GST_ITERATOR_RESYNC) {
    gst_iterator_resync(all);
  }
  gst_iterator_free(all);
}

void FollowedFilm::pause() {
  if (!playing_) return;
  paused_at_ns_ = position_at(monotonic_now_ns());
  playing_ = false;
  gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
}

void FollowedFilm::play(int64_t now_ns, int64_t position_ns) {
  set_base_time(now_ns - running_at(position_ns));
  playing_ = true;
  checked_ns_ = now_ns;
  gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
}

void FollowedFilm::seek(int64_t position_ns, double rate) {
  pause();
  const auto flags = static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE);
  // What is prerolled by now is not what the seek leads to.
  gst_element_get_state(pipeline_.get(), nullptr, nullptr, kLongestPause);
  check();
  ready_ = false;
  // Even if it leads to a place before.
  paused_at_ns_ = position_ns;
  rate_ = rate;
  seek_began_ns_ = monotonic_now_ns();
  if (gst_element_seek(pipeline_.get(), rate, GST_FORMAT_TIME, flags, GST_SEEK_TYPE_SET,
                       std::max<int64_t>(position_ns, 0), GST_SEEK_TYPE_NONE, 0)) {
    return;
  }
  tell("this film cannot be entered at another place");
  failed_ = true;
}

void FollowedFilm::follow(int64_t now_ns, int64_t position_ns, double rate) {
  if (!ready_) return;
  const int64_t error_ns = position_ns - position_at(now_ns);
  if (rate != rate_ || std::abs(error_ns) > kNear_ns) {
    return seek(position_ns + std::llround(static_cast<double>(seek_took_ns_) * rate), rate);
  }
  if (!playing_) settled_ns_ = now_ns + kSettles_ns;
  if (playing_ && std::abs(error_ns) > kSmall_ns) pause();
  if (!playing_) return play(now_ns, position_ns);
  const int64_t shift_ns =
      small_correction_ns(error_ns, now_ns - checked_ns_, now_ns < settled_ns_);
  checked_ns_ = now_ns;
  if (shift_ns != 0) set_base_time(base_ns_ - std::llround(static_cast<double>(shift_ns) / rate_));
}

void FollowedFilm::rest(int64_t position_ns) {
  pause();
  if (ready_ && std::abs(position_ns - paused_at_ns_) > kNear_ns) seek(position_ns, rate_);
}

}  // namespace spidar::follow
