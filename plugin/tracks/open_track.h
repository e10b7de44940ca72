// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/track/track_format.h"
#include "plugin/tracks/read_ahead.h"
#include "plugin/tracks/track_tags.h"

namespace spidar::tracks {

/// A haptic track that is read from a file piece by piece. Owned by one thread. The pieces wait in
/// blocks(), from which another thread may take them.
class OpenTrack {
 public:
  /// A longer track must have a wrong timestamp.
  static constexpr int64_t kLongest_ns = 24 * 3600 * int64_t{1'000'000'000};

  virtual ~OpenTrack() = default;

  virtual const Notes& notes() const = 0;
  /// The duration by the header and the last bytes of the file. Nothing when they do not state it,
  /// or when other streams may be longer.
  virtual std::optional<int64_t> duration_ns() const = 0;
  /// For a track that ends at `end_ns`: empty, or what is missing at the end of the file.
  virtual std::string missing(int64_t end_ns) const = 0;
  virtual const std::shared_ptr<ReadAhead>& blocks() const = 0;

  /// Returns the next block; false at the end. Times rise. Throws std::runtime_error when the file
  /// is damaged, the track longer than kLongest_ns, or `stopped` has become true.
  virtual bool next(TrackBlock& block) = 0;
  /// Seeks to the position that ReadAhead::await_seek() has returned.
  virtual void seek(int64_t time_ns) = 0;
  /// At the beginning and after seek(): fills blocks() until nothing more of this pass is wanted.
  /// Returns at once if the track has threads of its own for that.
  virtual void read_pass() {}
  /// For an exchange format, a line for each part: its file, and the axis on which it is felt.
  virtual std::vector<std::string> about() const { return {}; }
  /// The parts of the track that are not felt.
  virtual std::vector<std::string> unfelt() const { return {}; }
};

/// Opens the haptic track of a file, else its first sound, from any container for which GStreamer
/// has a decoder. Returns when the first second has been read. Throws std::runtime_error when there
/// is none, when the sound is not a haptic track (Input::set_caps()), when the file is damaged or
/// not a regular one, or when `stopped` has become true.
std::unique_ptr<OpenTrack> open_track(const std::string& path,
                                      const std::atomic<bool>* stopped = nullptr);

/// Finds the end of a track that does not state it, by reading all of it; it can be read again from
/// its beginning. Throws as next() does.
int64_t find_end(OpenTrack& track);

/// Reads only the notes of a track, from the beginning of the file. Empty where there are none.
Notes notes_of(const std::string& path);

}  // namespace spidar::tracks
