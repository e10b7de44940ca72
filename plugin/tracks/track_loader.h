// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <gst/gst.h>

#include "plugin/tracks/open_track.h"
#include "plugin/tracks/read_ahead.h"
#include "plugin/tracks/track_input.h"
#include "plugin/tracks/track_warnings.h"

namespace spidar::tracks {

/// A track that replaces the analysis of frames.
struct LoadedTrack {
  std::string path;                   ///< empty: there is none
  std::shared_ptr<ReadAhead> blocks;  ///< null when the file cannot be read
  int64_t duration_ns = 0;
  std::string error;         ///< why the track cannot be used; empty when it can
  bool is_compared = false;  ///< with the film
  bool is_named = false;     ///< by track=FILE, so that it is felt with any film
  std::string about;         ///< what is felt, and how; empty: unknown
  std::string remark;  ///< what is not felt, or why the track is felt nevertheless; empty: nothing
};

/// Reads the track for a film in a thread of its own while it is played. Reading may take long on a
/// slow disk or network share, and for ever on a broken one.
class Loader {
 public:
  Loader() = default;
  ~Loader() { stop(); }
  Loader(const Loader&) = delete;
  Loader& operator=(const Loader&) = delete;

  // --- streaming thread

  /// Opens `wanted`: a file, or with "auto" the one beside the file `film`, else the track inside
  /// it. Opens nothing if `wanted` is empty. Stops reading the previous track.
  void begin(const std::string& wanted, const std::string& film);
  /// Returns when the track is open or has failed, when `limit` has passed, or when interrupted.
  void await(std::chrono::milliseconds limit);
  /// Returns the opened track, once; nothing before. The thread continues to read until stop().
  std::optional<LoadedTrack> take();

  // --- any thread

  void set_interrupted(bool interrupted);

  // --- while no streaming thread runs

  /// Stops reading. A thread that is blocked in a system call is left behind, and ends later.
  void stop();

 private:
  struct Reading;

  std::shared_ptr<Reading> reading() const;

  mutable std::mutex mutex_;  ///< guards reading_
  std::shared_ptr<Reading> reading_;
  std::thread thread_;
};

/// Decides whether a track is rendered, and reports on it. Streaming thread.
class FeltTrack {
 public:
  explicit FeltTrack(GstElement* element) : element_(element), warnings_(element) {}

  /// Returns the blocks to render for the film at the sink pad of the element, or null. Posts a
  /// warning if the track cannot be used or belongs to another film, otherwise information on what
  /// is felt. Rules of what is felt take precedence over a track that was found automatically, but
  /// not over one that track= names.
  std::shared_ptr<ReadAhead> judge(const LoadedTrack& loaded, int64_t frame_ns, bool has_rules);
  /// Posts each warning once. Returns false when the track cannot be read further.
  bool check();
  void reset() { blocks_ = nullptr; }

 private:
  GstElement* element_;
  Warnings warnings_;
  std::string path_;
  std::shared_ptr<ReadAhead> blocks_;
  bool told_late_ = false;
};

}  // namespace spidar::tracks
