// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/follow/film_thread.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <utility>

#include "plugin/feel/follow/felt_element.h"
#include "plugin/feel/follow/position_filter.h"
#include "plugin/films/stream_content.h"
#include "plugin/films/video_choice.h"
#include "plugin/gobject/ref.h"
#include "plugin/tracks/exchange_file.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::follow {
namespace {

/// A larger error is corrected at once: a slow correction, by 2 % of the time, would take seconds.
constexpr int64_t kSmall_ns = 60'000'000;
/// For this time after a jump, the position of the player is not known well.
constexpr int64_t kSettles_ns = 1'000'000'000;
/// A larger error needs a seek; for a smaller one, another base time is enough.
constexpr int64_t kNear_ns = 500'000'000;
/// The time limit for a pause, which takes as long as one picture at most.
constexpr GstClockTime kLongestPause = 200 * GST_MSECOND;

/// Links the first stream that is a haptic track.
void link_track(GstElement*, GstPad* pad, gpointer decode) {
  const Ref<GstPad> sink(gst_element_get_static_pad(GST_ELEMENT(decode), "sink"));
  if (!gst_pad_is_linked(sink.get()) && content_of(pad) == StreamContent::kHapticTrack) {
    gst_pad_link(pad, sink.get());
  }
}

void set_element_base_time(const GValue* element, gpointer base) {
  gst_element_set_base_time(GST_ELEMENT(g_value_get_object(element)),
                            *static_cast<GstClockTime*>(base));
}

/// Renders the force of a film at the position at which another program shows it, from the film's
/// haptic track or by analysis. Use it in one thread, which files and devices may delay. Times are
/// of CLOCK_MONOTONIC.
class FollowedFilm {
 public:
  /// `properties` are those of spidarmotion, NAME=VALUE. Opens the device and keeps it at rest. If
  /// there is no device but a display, the debug window shows the force. Throws std::runtime_error,
  /// which says what is wrong.
  FollowedFilm(const FilmPlan& plan, const std::vector<std::string>& properties)
      : plan_(plan), properties_(properties), pipeline_(nullptr, [](GstElement* pipeline) {
          gst_element_set_state(pipeline, GST_STATE_NULL);
          gst_object_unref(pipeline);
        }) {
    const std::optional<bool> window = wants_window(properties_);
    build(window.value_or(false));
    check();  // sets is_simulated_
    if (is_simulated_ && !window && has_display()) build(true);
    gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
  }
  ~FollowedFilm() { pause(); }
  FollowedFilm(const FollowedFilm&) = delete;
  FollowedFilm& operator=(const FollowedFilm&) = delete;

  /// Prints the pipeline's messages, each text once. Returns false when the pipeline has failed.
  bool check() {
    const Ref<GstBus> bus(gst_element_get_bus(pipeline_.get()));
    while (GstMessage* const message = gst_bus_pop(bus.get())) {
      const std::string text = text_for_people(message);
      // Elements report one fault in several messages.
      if (!failed_ && !text.empty() && printed_.insert(text).second) print_message(text);
      is_simulated_ = parse_is_simulated(message).value_or(is_simulated_);
      if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) failed_ = true;
      if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_REQUEST_STATE) {
        GstState wanted;
        gst_message_parse_request_state(message, &wanted);
        const std::lock_guard<std::mutex> lock(mutex_);
        request_.add({wanted == GST_STATE_PLAYING, std::nullopt});
      }
      if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ASYNC_DONE) read_segment();
      gst_message_unref(message);
    }
    return !failed_;
  }

  /// Follows a player that plays at `rate` and is at this position. Corrects small errors slowly,
  /// larger ones at once, and the largest by a seek.
  void follow(int64_t now_ns, int64_t position_ns, double rate) {
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
    if (shift_ns == 0) return;
    set_base_time(base_ns_ - std::llround(static_cast<double>(shift_ns) / rate_));
  }

  /// Pauses like the player, at `position_ns` if known.
  void rest(std::optional<int64_t> position_ns) {
    pause();
    if (!ready_ || !position_ns) return;
    if (std::abs(*position_ns - paused_at_ns_) > kNear_ns) seek(*position_ns, rate_);
  }

  /// Returns the requests since the last call.
  FilmRequest take_request() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(request_, {});
  }

 private:
  void build(bool has_window) {
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

  void build_track() {
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

  void build_film() {
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
    gst_pad_add_probe(pictures.get(), GST_PAD_PROBE_TYPE_EVENT_UPSTREAM, on_seek, this, nullptr);
    g_object_set(source.get(), "uri", plan_.uri.c_str(), nullptr);
    videos_.watch(source.get());
    g_signal_connect(source.get(), "no-more-pads", G_CALLBACK(choose_stream), this);
    // For a track, spidarmotion prints this.
    begins_ = plan_.track.empty() ? plan_.name + " is analysed" : "";
  }

  /// Turns a seek of the debug window into a request to the player, which this film then follows.
  static GstPadProbeReturn on_seek(GstPad*, GstPadProbeInfo* info, gpointer user) {
    auto& self = *static_cast<FollowedFilm*>(user);
    GstEvent* const event = GST_PAD_PROBE_INFO_EVENT(info);
    if (GST_EVENT_TYPE(event) != GST_EVENT_SEEK || gst_event_get_seqnum(event) == self.own_seek_) {
      return GST_PAD_PROBE_OK;
    }
    gint64 to_ns = 0;
    gst_event_parse_seek(event, nullptr, nullptr, nullptr, nullptr, &to_ns, nullptr, nullptr);
    const std::lock_guard<std::mutex> lock(self.mutex_);
    self.request_.add({std::nullopt, to_ns});
    return GST_PAD_PROBE_DROP;
  }

  /// Called at no-more-pads: all streams are known.
  static void choose_stream(GstElement* decoder, gpointer user) {
    auto& self = *static_cast<FollowedFilm*>(user);
    const Ref<GstElement> convert(gst_bin_get_by_name(GST_BIN(self.pipeline_.get()), "convert"));
    const Ref<GstPad> into(gst_element_get_static_pad(convert.get(), "sink"));
    if (gst_pad_is_linked(into.get())) return;
    GstPad* const chosen = self.videos_.choose(decoder);
    if (chosen && gst_pad_link(chosen, into.get()) == GST_PAD_LINK_OK) return;
    GST_ELEMENT_ERROR(decoder, STREAM, WRONG_TYPE, ("there are no pictures in it"), (nullptr));
  }

  void read_segment() {
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

  /// The position of this film, or where it was paused.
  int64_t position_at(int64_t now_ns) const {
    if (!playing_) return paused_at_ns_;
    const auto since_ns = static_cast<double>(now_ns - base_ns_ - begin_running_ns_);
    return begin_position_ns_ + std::llround(since_ns * rate_);
  }

  int64_t running_at(int64_t position_ns) const {
    const auto since_ns = static_cast<double>(position_ns - begin_position_ns_);
    return begin_running_ns_ + std::llround(since_ns / rate_);
  }

  void set_base_time(int64_t base_ns) {
    base_ns_ = base_ns;
    auto base = static_cast<GstClockTime>(base_ns);
    gst_element_set_base_time(pipeline_.get(), base);
    GstIterator* const all = gst_bin_iterate_recurse(GST_BIN(pipeline_.get()));
    // Elements that are added meanwhile get the base time from their bin.
    while (gst_iterator_foreach(all, set_element_base_time, &base) == GST_ITERATOR_RESYNC) {
      gst_iterator_resync(all);
    }
    gst_iterator_free(all);
  }

  void pause() {
    if (!playing_) return;
    paused_at_ns_ = position_at(monotonic_now_ns());
    playing_ = false;
    gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
  }

  void play(int64_t now_ns, int64_t position_ns) {
    if (!begins_.empty()) print_message(begins_);
    begins_.clear();
    set_base_time(now_ns - running_at(position_ns));
    playing_ = true;
    checked_ns_ = now_ns;
    gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
  }

  void seek(int64_t position_ns, double rate) {
    pause();
    const auto flags = static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE);
    // Pictures that are prerolled by now precede the target of the seek.
    gst_element_get_state(pipeline_.get(), nullptr, nullptr, kLongestPause);
    check();
    ready_ = false;
    // Not clamped to 0: the player may be before the film.
    paused_at_ns_ = position_ns;
    rate_ = rate;
    seek_began_ns_ = monotonic_now_ns();
    GstEvent* const event =
        gst_event_new_seek(rate, GST_FORMAT_TIME, flags, GST_SEEK_TYPE_SET,
                           std::max<int64_t>(position_ns, 0), GST_SEEK_TYPE_NONE, 0);
    own_seek_ = gst_event_get_seqnum(event);
    if (gst_element_send_event(pipeline_.get(), event)) return;
    print_message("this film cannot be entered at another place");
    failed_ = true;
  }

  const FilmPlan plan_;
  const std::vector<std::string> properties_;
  VideoChoice videos_{VideoChoice::Rule::kMarked};
  std::mutex mutex_;
  FilmRequest request_;  ///< set by the thread of the window
  std::atomic<guint32> own_seek_{GST_SEQNUM_INVALID};
  std::unique_ptr<GstElement, void (*)(GstElement*)> pipeline_;
  GstElement* felt_ = nullptr;  ///< spidarmotion or spidarsink; owned by the pipeline
  GstElement* sink_ = nullptr;  ///< the sink that waits for the clock
  std::string begins_;          ///< printed when the film first plays
  std::set<std::string> printed_;
  bool is_simulated_ = false;  ///< the device is simulated
  double rate_ = 1;
  bool ready_ = false;  ///< prerolled
  bool playing_ = false;
  bool failed_ = false;
  int64_t base_ns_ = 0;
  int64_t paused_at_ns_ = 0;
  int64_t checked_ns_ = 0;  ///< when follow() last checked the position
  int64_t settled_ns_ = 0;  ///< from this time on, the player's position is known well
  // The segment: a position and its running time.
  int64_t begin_position_ns_ = 0, begin_running_ns_ = 0;
  int64_t seek_began_ns_ = 0, seek_took_ns_ = 0;
};

/// As often as the loop receives the playback clock.
constexpr std::chrono::milliseconds kTick{10};
/// An older goal means that the main loop is blocked, or the machine is very busy.
constexpr int64_t kStale_ns = 300'000'000;

/// Returns false when the film has failed.
bool apply_goal(FollowedFilm& film, const FilmGoal& goal) {
  if (!film.check()) return false;
  const int64_t now_ns = monotonic_now_ns();
  const int64_t passed_ns = now_ns - goal.at_ns;
  if (goal.plays && goal.position_ns && passed_ns < kStale_ns) {
    const int64_t since_ns = std::llround(static_cast<double>(passed_ns) * goal.rate);
    film.follow(now_ns, *goal.position_ns + since_ns, goal.rate);
  } else {
    film.rest(goal.plays ? std::nullopt : goal.position_ns);
  }
  return true;
}

}  // namespace

FilmThread::FilmThread(std::vector<std::string> properties)
    : properties_(std::move(properties)), thread_([this] { run(); }) {}

FilmThread::~FilmThread() {
  thread_.join();
}

void FilmThread::set_goal(FilmGoal goal) {
  const std::lock_guard<std::mutex> lock(mutex_);
  goal_ = std::move(goal);
}

FilmRequest FilmThread::take_request() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(request_, {});
}

bool FilmThread::end(std::chrono::milliseconds limit) {
  std::unique_lock<std::mutex> lock(mutex_);
  ends_ = true;
  changed_.notify_all();
  return changed_.wait_for(lock, limit, [this] { return has_ended_; });
}

void FilmThread::run() {
  std::shared_ptr<const FilmPlan> plan;
  std::unique_ptr<FollowedFilm> film;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!changed_.wait_for(lock, kTick, [this] { return ends_; })) {
    const FilmGoal goal = goal_;
    lock.unlock();
    if (goal.plan != plan) {
      plan = goal.plan;
      film.reset();  // releases the device for the next film
      try {
        if (plan) film = std::make_unique<FollowedFilm>(*plan, properties_);
      } catch (const std::runtime_error& error) {
        print_message(plan->name + ": " + error.what());
      }
    }
    if (film && !apply_goal(*film, goal)) {
      print_message("without force until the next film: " + plan->name);
      film.reset();
    }
    const FilmRequest request = film ? film->take_request() : FilmRequest();
    lock.lock();
    request_.add(request);
  }
  lock.unlock();
  film.reset();
  lock.lock();
  has_ended_ = true;
  changed_.notify_all();
}

}  // namespace spidar::follow
