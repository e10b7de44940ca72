// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "plugin/feel/follow/film_plan.h"
#include "plugin/films/video_choice.h"

namespace spidar::follow {

/// Requests of the debug window for the player.
struct FilmWish {
  std::optional<bool> plays;
  std::optional<int64_t> position_ns;

  void add(const FilmWish& later) {
    if (later.plays) plays = later.plays;
    if (later.position_ns) position_ns = later.position_ns;
  }
};

/// A film that is felt and not shown, at the position at which another program plays it: its haptic
/// track, or its analysis. One thread, which files, networks and devices may delay. Times are of
/// CLOCK_MONOTONIC.
class FollowedFilm {
 public:
  /// `properties` are those of spidarmotion, NAME=VALUE. Opens the device, and begins at rest.
  /// Without a device, the debug window shows the force, where there is a display. Throws
  /// std::runtime_error, which says what is wrong.
  FollowedFilm(const FilmPlan& plan, const std::vector<std::string>& properties);
  ~FollowedFilm();
  FollowedFilm(const FollowedFilm&) = delete;
  FollowedFilm& operator=(const FollowedFilm&) = delete;

  /// Prints the pipeline's messages, each text once. Returns false when the pipeline has failed.
  bool check();
  /// Follows a player that plays at `rate` and is at this position. Small errors are corrected
  /// slowly, large ones by a seek.
  void follow(int64_t now_ns, int64_t position_ns, double rate);
  /// Rests with the player, at this position if known.
  void rest(std::optional<int64_t> position_ns);
  /// Returns the requests since the last call.
  FilmWish take_wish();

 private:
  void build(bool has_window);
  void build_track();
  void build_film();
  static GstPadProbeReturn take_seek(GstPad*, GstPadProbeInfo* info, gpointer self);
  static void choose_stream(GstElement* decoder, gpointer self);
  void pause();
  void seek(int64_t position_ns, double rate);
  void play(int64_t now_ns, int64_t position_ns);
  void set_base_time(int64_t base_ns);
  void read_segment();
  /// The position of this film, or where it was paused.
  int64_t position_at(int64_t now_ns) const;
  int64_t running_at(int64_t position_ns) const;

  const FilmPlan plan_;
  const std::vector<std::string> properties_;
  VideoChoice videos_{VideoChoice::Rule::kMarked};
  std::mutex mutex_;
  FilmWish wish_;  ///< set by the thread of the window
  std::atomic<guint32> own_seek_{GST_SEQNUM_INVALID};
  std::unique_ptr<GstElement, void (*)(GstElement*)> pipeline_;
  GstElement* felt_ = nullptr;  ///< spidarmotion or spidarsink; owned by the pipeline
  GstElement* sink_ = nullptr;  ///< the sink that waits for the clock
  std::string begins_;          ///< printed when it plays for the first time
  std::set<std::string> said_;
  bool is_simulated_ = false;  ///< no device renders it
  double rate_ = 1;
  bool ready_ = false;  ///< prerolled
  bool playing_ = false;
  bool failed_ = false;
  int64_t base_ns_ = 0;
  int64_t paused_at_ns_ = 0;
  int64_t checked_ns_ = 0;  ///< when follow() last checked the position
  int64_t settled_ns_ = 0;  ///< from when on the player's position is known well
  // The segment: a position and its running time.
  int64_t begin_position_ns_ = 0, begin_running_ns_ = 0;
  int64_t seek_began_ns_ = 0, seek_took_ns_ = 0;
};

}  // namespace spidar::follow
