// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads the track for a film in a thread of its own while it is played, and decides whether it is
/// rendered.
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

/// A track that is played in place of analysing frames.
struct LoadedTrack {
  std::string path;                   ///< empty: there is none
  std::shared_ptr<ReadAhead> blocks;  ///< null when the file cannot be read
  int64_t duration_ns = 0;
  std::string error;         ///< why it cannot be used; empty when it can
  bool is_compared = false;  ///< with the film
  bool is_named = false;     ///< by track=FILE, so that it is felt with any film
  std::string about;         ///< what is felt, and as what; empty: not known
  std::string remark;        ///< what is not felt, or why it is felt nevertheless; empty: nothing
};

/// Reading may take long on a slow disk or network share, and for ever on a broken one.
class Loader {
 public:
  Loader() = default;
  ~Loader() { stop(); }
  Loader(const Loader&) = delete;
  Loader& operator=(const Loader&) = delete;

  // --- streaming thread

  /// Opens `wanted`: a file, or with "auto" the one beside the file `film`, else the track inside
  /// it. Nothing when `wanted` is empty. Stops what was being read.
  void begin(const std::string& wanted, const std::string& film);
  /// Returns when it is known whether the track can be used, when `limit` has passed, or when it
  /// is interrupted.
  void await(std::chrono::milliseconds limit);
  /// The track that was opened, once; nothing before. It is read further until stop().
  std::optional<LoadedTrack> take();

  // --- any thread

  /// While it is interrupted, up to begin(), neither await() nor ReadAhead::take() waits.
  void set_interrupted(bool interrupted);

  // --- while no streaming thread runs

  /// Ends reading. If the system does not return from reading, the thread is left behind, and ends
  /// when it does.
  void stop();

 private:
  struct Reading;

  std::shared_ptr<Reading> reading() const;

  mutable std::mutex mutex_;  ///< guards reading_
  std::shared_ptr<Reading> reading_;
  std::thread thread_;
};

/// Reports on a track while it is played. Streaming thread.
class FeltTrack {
 public:
  explicit FeltTrack(GstElement* element) : element_(element), warnings_(element) {}

  /// The blocks to be rendered for the film that comes to the sink pad of the element. Null when
  /// there are none; a warning on the bus when the track cannot be used, or is that of another
  /// film; else information on what is felt. Rules of what is felt take precedence over a track
  /// that was only found, not over one that track= names.
  std::shared_ptr<ReadAhead> judge(const LoadedTrack& loaded, int64_t frame_ns, bool has_rules);
  /// Posts each warning once. False when the track cannot be read further.
  bool check();
  /// No track is rendered any more.
  void reset() { blocks_ = nullptr; }

 private:
  GstElement* element_;
  Warnings warnings_;
  std::string path_;
  std::shared_ptr<ReadAhead> blocks_;
  bool told_late_ = false;
};

}  // namespace spidar::tracks
