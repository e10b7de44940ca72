// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_loader.h"

#include <atomic>
#include <condition_variable>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "plugin/films/film_reader.h"
#include "plugin/gobject/bus_messages.h"
#include "plugin/gobject/category.h"
#include "plugin/gobject/ref.h"
#include "plugin/tracks/exchange_file.h"
#include "plugin/tracks/sidecar.h"
#include "spidar/realtime/thread_setup.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element)

namespace spidar::tracks {
namespace {

/// How long stop() waits for a thread, which looks every 20 ms whether it must stop.
constexpr std::chrono::milliseconds kLongestStop{500};

/// Returns nothing when the film cannot be read.
std::optional<Film> read_if_possible(const std::string& film, const std::atomic<bool>* stopped) {
  if (film.empty()) return std::nullopt;
  try {
    return read_film(film, stopped);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

/// Removes the full stop of a sentence, for the end of another one.
std::string clause(std::string sentence) {
  if (!sentence.empty() && sentence.back() == '.') sentence.pop_back();
  return sentence;
}

std::string joined(const std::vector<std::string>& parts, const char* between) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
  return text;
}

/// Opens the track, and compares it with the film. Null without a track, or on an error.
std::unique_ptr<OpenTrack> load_track(const std::string& wanted, const std::string& film,
                                      const std::atomic<bool>* stopped, LoadedTrack& loaded) {
  loaded.path = wanted == "auto" ? find_sidecar(film) : wanted;
  const std::optional<Film> read = read_if_possible(film, stopped);
  loaded.is_named = wanted != "auto";
  if (loaded.path.empty() && read && read->has_track) loaded.path = film;
  if (loaded.path.empty()) loaded.path = find_exchange_file(film);
  if (loaded.path.empty()) return nullptr;
  std::unique_ptr<OpenTrack> track =
      is_exchange_file(loaded.path) ? open_exchange_file(loaded.path, loaded.is_named ? "" : film)
                                    : open_track(loaded.path, stopped);
  loaded.about = joined(track->about(), "; ");
  loaded.remark = joined(track->unfelt(), ", ");
  if (!loaded.remark.empty()) loaded.remark = "is felt without " + loaded.remark;
  // A track inside the film is the film's own.
  const bool is_inside = loaded.path == film;
  loaded.is_compared = is_inside || read || !track->notes().origin.empty();
  loaded.blocks = track->blocks();
  loaded.error = track->missing(track->duration_ns().value_or(INT64_MAX));
  if (is_inside || !loaded.error.empty()) return track;
  loaded.duration_ns = track->duration_ns() ? *track->duration_ns() : find_end(*track);
  if (!read) return track;
  const FilmMatch match = match_film(*read, loaded.duration_ns, track->notes());
  if (!loaded.is_named) {
    loaded.error = match.mismatch;
  } else if (!match.mismatch.empty()) {
    loaded.remark = "is felt, as track= says, though " + match.mismatch;
  }
  loaded.blocks->set_later(match.later_ns);
  return track;
}

void post_what_is_felt(GstElement* element, const std::string& text) {
  post_information(element, GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_SETTINGS, text,
                   "The property 'track' chooses another.");
}

/// Warns of properties that are set and change nothing while a track is played.
void warn_of_unused(GstElement* element, const std::string& path) {
  g_autofree gchar* feel = nullptr;
  g_object_get(element, "feel", &feel, nullptr);
  if (feel) {
    GST_ELEMENT_WARNING(
        element, RESOURCE, SETTINGS,
        ("feel=%s has no effect while the haptic track %s is played.", feel, path.c_str()),
        ("Leave out the one or the other, or make the haptic track anew with it."));
  }
}

}  // namespace

struct Loader::Reading {
  void set_opened(const LoadedTrack& what) {
    const std::lock_guard<std::mutex> lock(mutex);
    loaded = what;
    opened = true;
    if (stopped && loaded.blocks) loaded.blocks->stop();
    if (interrupted && loaded.blocks) loaded.blocks->set_interrupted(true);
    changed.notify_all();
  }
  void set_done() {
    const std::lock_guard<std::mutex> lock(mutex);
    done = true;
    changed.notify_all();
  }

  std::atomic<bool> stopped{false};
  std::mutex mutex;  // guards the members below
  std::condition_variable changed;
  bool interrupted = false;
  bool opened = false;  // the track is open, or its error is known
  bool taken = false;
  bool done = false;  // the thread has ended
  LoadedTrack loaded;
};

std::shared_ptr<Loader::Reading> Loader::reading() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return reading_;
}

void Loader::begin(const std::string& wanted, const std::string& film) {
  stop();
  if (wanted.empty()) return;
  const auto reading = std::make_shared<Reading>();
  auto read = [reading, wanted, film] {
    LoadedTrack loaded;
    std::unique_ptr<OpenTrack> track;
    try {
      track = load_track(wanted, film, &reading->stopped, loaded);
    } catch (const std::exception& error) {
      if (loaded.path.empty()) loaded.path = wanted;
      loaded.error = clause(error.what());
    }
    const bool is_played = track && loaded.error.empty();
    reading->set_opened(loaded);
    while (is_played) {
      track->read_pass();
      const std::optional<int64_t> position_ns = loaded.blocks->await_seek();
      if (!position_ns) break;
      track->seek(*position_ns);
    }
    track = nullptr;
    reading->set_done();
  };
  try {
    thread_ = start_thread("spidar-track", std::move(read));
  } catch (const std::system_error& error) {
    reading->loaded.path = wanted == "auto" ? film : wanted;
    reading->loaded.error = std::string("the system gives no thread to read it: ") + error.what();
    reading->opened = reading->done = true;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  reading_ = reading;
}

void Loader::await(std::chrono::milliseconds limit) {
  const auto reading = this->reading();
  if (!reading) return;
  std::unique_lock<std::mutex> lock(reading->mutex);
  reading->changed.wait_for(lock, limit, [&] { return reading->opened || reading->interrupted; });
}

std::optional<LoadedTrack> Loader::take() {
  const auto reading = this->reading();
  if (!reading) return std::nullopt;
  const std::lock_guard<std::mutex> lock(reading->mutex);
  if (!reading->opened || std::exchange(reading->taken, true)) return std::nullopt;
  return reading->loaded;
}

void Loader::set_interrupted(bool interrupted) {
  const auto reading = this->reading();
  if (!reading) return;
  const std::lock_guard<std::mutex> lock(reading->mutex);
  reading->interrupted = interrupted;
  if (reading->loaded.blocks) reading->loaded.blocks->set_interrupted(interrupted);
  reading->changed.notify_all();
}

void Loader::stop() {
  const auto reading = this->reading();
  if (!reading) return;
  reading->stopped = true;
  std::unique_lock<std::mutex> lock(reading->mutex);
  if (reading->loaded.blocks) reading->loaded.blocks->stop();
  const bool done = reading->changed.wait_for(lock, kLongestStop, [&] { return reading->done; });
  lock.unlock();
  if (done) {
    if (thread_.joinable()) thread_.join();
  } else {
    thread_.detach();
  }
  const std::lock_guard<std::mutex> pointer_lock(mutex_);
  reading_ = nullptr;
}

std::shared_ptr<ReadAhead> FeltTrack::judge(const LoadedTrack& loaded, int64_t frame_ns,
                                            bool has_rules) {
  GstElement* const element = element_;
  if (has_rules && !loaded.is_named) {
    if (!loaded.path.empty()) {
      post_what_is_felt(
          element, "The haptic track " + loaded.path + " is not felt, because feel= says what is.");
    }
    return nullptr;
  }
  if (loaded.path.empty()) {
    post_what_is_felt(element, "The film has no haptic track or script: its motion is felt.");
    return nullptr;
  }
  std::string error = loaded.error;
  if (error.empty() && !loaded.is_compared) {
    const Ref<GstPad> pad(gst_element_get_static_pad(element, "sink"));
    error = why_other_film(pad.get(), loaded.duration_ns, frame_ns);
  }
  std::string remark = loaded.remark;
  if (!error.empty() && loaded.error.empty() && loaded.is_named) {
    remark = "is felt, as track= says, though " + std::exchange(error, {});
  }
  if (error.empty()) {
    warn_of_unused(element, loaded.path);
    if (!remark.empty()) {
      GST_ELEMENT_WARNING(element, RESOURCE, SETTINGS,
                          ("The haptic track %s %s.", loaded.path.c_str(), remark.c_str()),
                          (nullptr));
    }
    post_what_is_felt(
        element, "Felt instead of the film's motion: " +
                     (loaded.about.empty() ? "the haptic track " + loaded.path : loaded.about) +
                     ".");
    path_ = loaded.path;
    blocks_ = loaded.blocks;
    told_late_ = false;
    warnings_.start();
    return blocks_;
  }
  GST_ELEMENT_WARNING(element, RESOURCE, SETTINGS,
                      ("The haptic track %s is not felt: %s.", loaded.path.c_str(), error.c_str()),
                      ("The video is analysed in its place."));
  return nullptr;
}

bool FeltTrack::check() {
  if (!blocks_) return true;
  GstElement* const element = element_;
  warnings_.check(blocks_->faults(), true, path_);
  if (blocks_->was_late() && !std::exchange(told_late_, true)) {
    GST_ELEMENT_WARNING(element, RESOURCE, READ,
                        ("The haptic track %s is read too slowly: what comes too late of it is not "
                         "felt.",
                         path_.c_str()),
                        ("Its disk or network is slow."));
  }
  if (!blocks_->has_failed()) return true;
  GST_ELEMENT_WARNING(element, RESOURCE, READ,
                      ("The haptic track %s is not felt any further: %s.", path_.c_str(),
                       clause(blocks_->error()).c_str()),
                      ("The video is analysed in its place."));
  reset();
  return false;
}

}  // namespace spidar::tracks
