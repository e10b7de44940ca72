// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/follow/followed_film.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "plugin/feel/follow/felt_element.h"
#include "plugin/feel/follow/position_filter.h"
#include "plugin/films/stream_content.h"
#include "plugin/gobject/ref.h"
#include "plugin/tracks/exchange_file.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::follow {
namespace {

/// A larger error is corrected by a seek: at 2 % of the time, a slow correction would take seconds.
constexpr int64_t kSmall_ns = 60'000'000;
/// Until the first reports after a jump, only the target of the jump is known.
constexpr int64_t kSettles_ns = 1'000'000'000;
/// A larger jump needs other parts of the film; a smaller one only another time for them.
constexpr int64_t kNear_ns = 500'000'000;
/// A pause takes a picture at most.
constexpr GstClockTime kLongestPause = 200 * GST_MSECOND;

/// Links the first stream that is a haptic track.
void link_track(GstElement*, GstPad* pad, gpointer decode) {
  const Ref<GstPad> sink(gst_element_get_static_pad(GST_ELEMENT(decode), "sink"));
  if (!gst_pad_is_linked(sink.get()) && content_of(pad) == StreamContent::kHapticTrack) {
    gst_pad_link(pad, sink.get());
  }
}

void give_base_time(const GValue* element, gpointer base) {
  gst_element_set_base_time(GST_ELEMENT(g_value_get_object(element)),
                            *static_cast<GstClockTime*>(base));
}

}  // namespace

FollowedFilm::FollowedFilm(const FilmPlan& plan, const std::vector<std::string>& properties)
    : plan_(plan), properties_(properties), pipeline_(nullptr, [](GstElement* pipeline) {
        gst_element_set_state(pipeline, GST_STATE_NULL);
        gst_object_unref(pipeline);
      }) {
  const std::optional<bool> window = wants_window(properties_);
  build(window.value_or(false));
  check();  // reports which device that is
  if (is_simulated_ && !window && has_display()) build(true);
  gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
}

void FollowedFilm::build(bool has_window) {
  // Only spidarmotion reads exchange formats, and rules, which have priority over a found track.
  const bool has_rules = value_of(properties_, "feel") != nullptr;
  const bool is_track = !plan_.track.empty() && !tracks::is_exchange_file(plan_.track);
  if (is_track && !has_window && !has_rules) {
    build_track();
  } else {
    build_film();
    if (has_window) g_object_set(felt_, "debug-window", TRUE, nullptr);
    if (!plan_.track.empty()) {
      g_object_set(felt_, "track", has_rules ? "auto" : plan_.track.c_str(), nullptr);
    }
  }
  const std::string others = set_properties(felt_, properties_);
  // Only spidarmotion, which analyses pictures, has these properties.
  if (!others.empty()) {
    begins_ += "; it is played as it is, so these have no effect: " + others;
  }
  // This class sets the base time itself.
  gst_element_set_start_time(pipeline_.get(), GST_CLOCK_TIME_NONE);
  const Ref<GstClock> clock(gst_system_clock_obtain());
  gst_pipeline_use_clock(GST_PIPELINE(pipeline_.get()), clock.get());
  gst_element_set_state(pipeline_.get(), GST_STATE_READY);
}

FollowedFilm::~FollowedFilm() {
  pause();
}

void FollowedFilm::build_track() {
  pipeline_.reset(parse_pipeline(
      "filesrc name=source ! parsebin name=parse decodebin name=decode ! audioconvert "
      "dithering=none noise-shaping=none ! spidarsink name=felt"));
  GstBin* const bin = GST_BIN(pipeline_.get());
  const Ref<GstElement> source(gst_bin_get_by_name(bin, "source"));
  const Ref<GstElement> parser(gst_bin_get_by_name(bin, "parse"));
  const Ref<GstElement> decoder(gst_bin_get_by_name(bin, "decode"));
  const Ref<GstElement> felt(gst_bin_get_by_name(bin, "felt"));
  felt_ = sink_ = felt.get();
  g_object_set(source.get(), "location", plan_.track.c_str(), nullptr);
  g_object_set(felt_, "ts-offset", plan_.later_ns, "accept-unmarked", TRUE, nullptr);
  g_signal_connect(parser.get(), "pad-added", G_CALLBACK(link_track), decoder.get());
  begins_ = "the haptic track " + plan_.track + " is felt";
}

void FollowedFilm::build_film() {
  pipeline_.reset(parse_pipeline(
      // Caps with any memory feature: decoders of FFmpeg list interlaced pictures separately.
      "uridecodebin name=source caps=video/x-raw(ANY) expose-all-streams=false videoconvert "
      "name=convert ! spidarmotion name=felt ! queue max-size-buffers=3 ! fakesink name=sink "
      "sync=true qos=true"));
  GstBin* const bin = GST_BIN(pipeline_.get());
  const Ref<GstElement> source(gst_bin_get_by_name(bin, "source"));
  const Ref<GstElement> felt(gst_bin_get_by_name(bin, "felt"));
  const Ref<GstElement> sink(gst_bin_get_by_name(bin, "sink"));
  felt_ = felt.get();
  sink_ = sink.get();
  const Ref<GstPad> pictures(gst_element_get_static_pad(felt_, "sink"));
  gst_pad_add_probe(pictures.get(), GST_PAD_PROBE_TYPE_EVENT_UPSTREAM, take_seek, this, nullptr);
  g_object_set(source.get(), "uri", plan_.uri.c_str(), nullptr);
  videos_.watch(source.get());
  g_signal_connect(source.get(), "no-more-pads", G_CALLBACK(choose_stream), this);
  // For a track, spidarmotion prints this.
  begins_ = plan_.track.empty() ? plan_.name + " is analysed" : "";
}

/// A seek of the debug window is for the player, which this film then follows.
GstPadProbeReturn FollowedFilm::take_seek(GstPad*, GstPadProbeInfo* info, gpointer user) {
  auto& self = *static_cast<FollowedFilm*>(user);
  GstEvent* const event = GST_PAD_PROBE_INFO_EVENT(info);
  if (GST_EVENT_TYPE(event) != GST_EVENT_SEEK || gst_event_get_seqnum(event) == self.own_seek_) {
    return GST_PAD_PROBE_OK;
  }
  gint64 to_ns = 0;
  gst_event_parse_seek(event, nullptr, nullptr, nullptr, nullptr, &to_ns, nullptr, nullptr);
  const std::lock_guard<std::mutex> lock(self.mutex_);
  self.wish_.add({std::nullopt, to_ns});
  return GST_PAD_PROBE_DROP;
}

FilmWish FollowedFilm::take_wish() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(wish_, {});
}

/// This signal means that all streams are known.
void FollowedFilm::choose_stream(GstElement* decoder, gpointer user) {
  auto& self = *static_cast<FollowedFilm*>(user);
  const Ref<GstElement> convert(gst_bin_get_by_name(GST_BIN(self.pipeline_.get()), "convert"));
  const Ref<GstPad> into(gst_element_get_static_pad(convert.get(), "sink"));
  if (gst_pad_is_linked(into.get())) return;
  GstPad* const chosen = self.videos_.choose(decoder);
  if (chosen && gst_pad_link(chosen, into.get()) == GST_PAD_LINK_OK) return;
  GST_ELEMENT_ERROR(decoder, STREAM, WRONG_TYPE, ("there are no pictures in it"), (nullptr));
}

bool FollowedFilm::check() {
  const Ref<GstBus> bus(gst_element_get_bus(pipeline_.get()));
  while (GstMessage* const message = gst_bus_pop(bus.get())) {
    const std::string text = text_for_people(message);
    // Elements report one fault in several messages.
    if (!failed_ && !text.empty() && said_.insert(text).second) tell(text);
    is_simulated_ = says_simulated(message).value_or(is_simulated_);
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) failed_ = true;
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_REQUEST_STATE) {
      GstState wanted;
      gst_message_parse_request_state(message, &wanted);
      const std::lock_guard<std::mutex> lock(mutex_);
      wish_.add({wanted == GST_STATE_PLAYING, std::nullopt});
    }
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ASYNC_DONE) read_segment();
    gst_message_unref(message);
  }
  return !failed_;
}

void FollowedFilm::read_segment() {
  const Ref<GstPad> pad(gst_element_get_static_pad(sink_, "sink"));
  const Ref<GstEvent> event(gst_pad_get_sticky_event(pad.get(), GST_EVENT_SEGMENT, 0));
  if (!event) return;
  GstSegment segment;
  gst_event_copy_segment(event.get(), &segment);
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
  // Elements that are added meanwhile get the base time from their bin.
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
  if (!begins_.empty()) tell(begins_);
  begins_.clear();
  set_base_time(now_ns - running_at(position_ns));
  playing_ = true;
  checked_ns_ = now_ns;
  gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
}

void FollowedFilm::seek(int64_t position_ns, double rate) {
  pause();
  const auto flags = static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE);
  // Pictures that are prerolled by now precede the target of the seek.
  gst_element_get_state(pipeline_.get(), nullptr, nullptr, kLongestPause);
  check();
  ready_ = false;
  // The rest also holds when the position is before the film.
  paused_at_ns_ = position_ns;
  rate_ = rate;
  seek_began_ns_ = monotonic_now_ns();
  GstEvent* const event =
      gst_event_new_seek(rate, GST_FORMAT_TIME, flags, GST_SEEK_TYPE_SET,
                         std::max<int64_t>(position_ns, 0), GST_SEEK_TYPE_NONE, 0);
  own_seek_ = gst_event_get_seqnum(event);
  if (gst_element_send_event(pipeline_.get(), event)) return;
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

void FollowedFilm::rest(std::optional<int64_t> position_ns) {
  pause();
  if (!ready_ || !position_ns) return;
  if (std::abs(*position_ns - paused_at_ns_) > kNear_ns) seek(*position_ns, rate_);
}

}  // namespace spidar::follow
