// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_loader.h"

#include <atomic>
#include <condition_variable>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "plugin/gobject/category.h"
#include "plugin/tracks/film_reader.h"
#include "plugin/tracks/sidecar.h"
#include "plugin/tracks/track_input.h"
#include "spidar/realtime/thread_setup.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element)

namespace spidar {
namespace {

/// How long stop() waits for a thread that has been told to stop; it looks every 20 ms.
constexpr std::chrono::milliseconds kLongestStop{500};

/// Nothing when the film cannot be read.
std::optional<Film> read_if_possible(const std::string& film, const std::atomic<bool>* stopped) {
  if (film.empty()) return std::nullopt;
  try {
    return read_film(film, stopped);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

void move(TrackFile& track, int64_t later_ns) {
  for (TrackBlock& block : track.blocks) block.begin_ns += later_ns;
}

/// A sentence without its full stop, for the end of another one.
std::string clause(std::string sentence) {
  if (!sentence.empty() && sentence.back() == '.') sentence.pop_back();
  return sentence;
}

LoadedTrack load_track(const std::string& wanted, const std::string& film,
                       const std::atomic<bool>* stopped) {
  LoadedTrack loaded;
  loaded.path = wanted == "auto" ? find_sidecar(film) : wanted;
  const std::optional<Film> read = read_if_possible(film, stopped);
  if (loaded.path.empty() && read && read->has_track) loaded.path = film;
  if (loaded.path.empty()) return loaded;
  try {
    loaded.track = read_track_file(loaded.path, stopped);
    loaded.problem = loaded.track->missing();
    // A track inside the film is the film's own.
    const bool is_inside = loaded.path == film;
    loaded.is_compared = is_inside || read;
    if (is_inside || !read) return loaded;
    const FilmMatch match = match_film(*read, loaded.track->duration_ns, loaded.track->notes);
    if (loaded.problem.empty()) loaded.problem = match.problem;
    move(*loaded.track, match.later_ns);
  } catch (const std::runtime_error& error) {
    loaded.problem = clause(error.what());
  }
  return loaded;
}

/// Names what is set and changes nothing while a track is played.
void name_unused(GstElement* element, const std::string& path) {
  gchar* feel = nullptr;
  g_object_get(element, "feel", &feel, nullptr);
  if (feel) {
    GST_ELEMENT_WARNING(
        element, RESOURCE, SETTINGS,
        ("feel=%s has no effect while the haptic track %s is played.", feel, path.c_str()),
        ("Leave out the one or the other, or make the haptic track anew with it."));
  }
  g_free(feel);
}

}  // namespace

struct TrackLoader::Reading {
  std::atomic<bool> stopped{false};
  std::mutex mutex;  // of what follows
  std::condition_variable changed;
  bool interrupted = false, done = false;
  LoadedTrack loaded;
};

std::shared_ptr<TrackLoader::Reading> TrackLoader::reading() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return reading_;
}

void TrackLoader::begin(const std::string& wanted, const std::string& film) {
  stop();
  if (wanted.empty()) return;
  const auto reading = std::make_shared<Reading>();
  auto read = [reading, wanted, film] {
    LoadedTrack loaded;
    try {
      loaded = load_track(wanted, film, &reading->stopped);
    } catch (const std::exception& error) {
      loaded.path = wanted;
      loaded.problem = clause(error.what());
    }
    const std::lock_guard<std::mutex> lock(reading->mutex);
    reading->loaded = std::move(loaded);
    reading->done = true;
    reading->changed.notify_all();
  };
  try {
    thread_ = start_thread("spidar-track", std::move(read));
  } catch (const std::system_error& error) {
    reading->loaded.path = wanted == "auto" ? film : wanted;
    reading->loaded.problem = std::string("the system gives no thread to read it: ") + error.what();
    reading->done = true;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  reading_ = reading;
}

void TrackLoader::await(std::chrono::milliseconds limit) {
  const auto reading = this->reading();
  if (!reading) return;
  std::unique_lock<std::mutex> lock(reading->mutex);
  reading->changed.wait_for(lock, limit, [&] { return reading->done || reading->interrupted; });
}

std::optional<LoadedTrack> TrackLoader::take() {
  const auto reading = this->reading();
  if (!reading) return std::nullopt;
  std::unique_lock<std::mutex> lock(reading->mutex);
  if (!reading->done) return std::nullopt;
  std::optional<LoadedTrack> loaded = std::move(reading->loaded);
  lock.unlock();
  stop();
  return loaded;
}

void TrackLoader::interrupt() {
  const auto reading = this->reading();
  if (!reading) return;
  const std::lock_guard<std::mutex> lock(reading->mutex);
  reading->interrupted = true;
  reading->changed.notify_all();
}

void TrackLoader::resume() {
  const auto reading = this->reading();
  if (!reading) return;
  const std::lock_guard<std::mutex> lock(reading->mutex);
  reading->interrupted = false;
}

void TrackLoader::stop() {
  const auto reading = this->reading();
  if (!reading) return;
  reading->stopped = true;
  std::unique_lock<std::mutex> lock(reading->mutex);
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

std::optional<TrackFile> judge_track(GstElement* element, LoadedTrack loaded, int64_t frame_ns) {
  if (loaded.path.empty()) return std::nullopt;
  if (loaded.problem.empty() && !loaded.is_compared) {
    GstPad* pad = gst_element_get_static_pad(element, "sink");
    loaded.problem = other_film(pad, loaded.track->duration_ns, frame_ns);
    gst_object_unref(pad);
  }
  if (loaded.problem.empty()) {
    TrackWarnings(element).check(loaded.track->faults, true, loaded.path);
    name_unused(element, loaded.path);
    return std::move(loaded.track);
  }
  GST_ELEMENT_WARNING(
      element, RESOURCE, SETTINGS,
      ("The haptic track %s is not felt: %s.", loaded.path.c_str(), loaded.problem.c_str()),
      ("The video is analysed in its place."));
  return std::nullopt;
}

}  // namespace spidar
