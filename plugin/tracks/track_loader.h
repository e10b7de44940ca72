// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads the track for a film in a thread of its own, and says whether it is felt.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <gst/gst.h>

#include "plugin/tracks/track_file.h"

namespace spidar {

/// What is played in place of analysing frames.
struct LoadedTrack {
  std::string path;  ///< empty: there is none
  std::optional<TrackFile> track;
  std::string problem;       ///< why `track` cannot be used; empty when it can
  bool is_compared = false;  ///< with the film
};

/// Reading may take long on a slow disk or share, and for ever on a broken one.
class TrackLoader {
 public:
  TrackLoader() = default;
  ~TrackLoader() { stop(); }
  TrackLoader(const TrackLoader&) = delete;
  TrackLoader& operator=(const TrackLoader&) = delete;

  // --- streaming thread

  /// Begins to read `wanted`: a file, or with "auto" the one beside the file `film`, else the track
  /// inside it. Nothing when `wanted` is empty. What was being read is forgotten.
  void begin(const std::string& wanted, const std::string& film);
  /// Returns when all has been read, when `limit` has passed, or at interrupt().
  void await(std::chrono::milliseconds limit);
  /// What was read, once; nothing before.
  std::optional<LoadedTrack> take();

  // --- any thread

  /// Until begin() or resume(), await() returns at once.
  void interrupt();
  void resume();

  // --- while no streaming thread runs

  /// Ends reading. Where the system does not return from reading, the thread is left behind, and
  /// ends when it does.
  void stop();

 private:
  struct Reading;

  std::shared_ptr<Reading> reading() const;

  mutable std::mutex mutex_;  // of the pointer
  std::shared_ptr<Reading> reading_;
  std::thread thread_;
};

/// The track to be felt for the film that comes to the sink pad of `element`. Nothing when there is
/// none; a warning on the bus when it cannot be used, or is that of another film.
std::optional<TrackFile> judge_track(GstElement* element, LoadedTrack loaded, int64_t frame_ns);

}  // namespace spidar
