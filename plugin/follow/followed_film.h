// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A film that is felt and not shown, where another program is in it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <glib.h>
#include <gst/gst.h>

namespace spidar::follow {

/// What is said to people.
inline void tell(const std::string& text) {
  g_printerr("spidar-feel: %s\n", text.c_str());
}

/// Its haptic track, or the film once more. One thread. Times are of CLOCK_MONOTONIC.
class FollowedFilm {
 public:
  /// `properties` are of spidarmotion, NAME=VALUE. Opens the device, and begins at rest. Throws
  /// std::runtime_error, which says what is wrong.
  FollowedFilm(const std::string& uri, const std::vector<std::string>& properties);
  ~FollowedFilm();
  FollowedFilm(const FollowedFilm&) = delete;
  FollowedFilm& operator=(const FollowedFilm&) = delete;

  /// Between two pictures; 0 if it is not known.
  int64_t frame_ns() const { return frame_ns_; }
  /// Prints what the pipeline has to say. False when it has failed.
  bool check();
  /// The player plays at `rate` and is at this position. Small errors are corrected slowly, large
  /// ones by a seek.
  void follow(int64_t now_ns, int64_t position_ns, double rate);
  /// The player rests at this position.
  void rest(int64_t position_ns);

 private:
  void build_track(const std::string& path, int64_t later_ns);
  void build_film(const std::string& uri);
  void set_properties(const std::vector<std::string>& properties);
  void pause();
  void seek(int64_t position_ns, double rate);
  void play(int64_t now_ns, int64_t position_ns);
  void set_base_time(int64_t base_ns);
  void read_segment();
  /// Where this is, or was when it was paused.
  int64_t position_at(int64_t now_ns) const;
  int64_t running_at(int64_t position_ns) const;

  std::unique_ptr<GstElement, void (*)(GstElement*)> pipeline_;
  GstElement* felt_ = nullptr;  ///< spidarmotion or spidarsink; owned by the pipeline
  GstElement* sink_ = nullptr;  ///< that waits for the clock
  int64_t frame_ns_ = 0;
  double rate_ = 1;
  bool ready_ = false;  ///< prerolled
  bool playing_ = false;
  bool failed_ = false;
  int64_t base_ns_ = 0;
  int64_t paused_at_ns_ = 0;  ///< the position
  int64_t checked_ns_ = 0;    ///< when follow() has last looked
  int64_t settled_ns_ = 0;    ///< from when on the player's position is known well
  // The segment: a position and its running time.
  int64_t begin_position_ns_ = 0, begin_running_ns_ = 0;
  int64_t seek_began_ns_ = 0, seek_took_ns_ = 0;
};

}  // namespace spidar::follow
