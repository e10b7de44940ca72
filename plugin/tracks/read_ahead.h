// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "core/track/track_format.h"
#include "plugin/tracks/track_input.h"

namespace spidar {

/// The end of a block, where the next one begins.
inline int64_t end_of(const TrackBlock& block) {
  return block.begin_ns + block.duration_ns;
}

/// A queue with a few seconds of a track, between the thread that reads its file and the one that
/// plays it. A pass reads the file from one position on; each seek() begins another pass.
class ReadAhead {
 public:
  /// How far the file is read ahead of playing: longer than a disk takes to start.
  static constexpr int64_t kAhead_ns = 10'000'000'000;
  /// Ten seconds of blocks as short as encoders make them: 1 MB.
  static constexpr size_t kMaxBlocks = 1000;

  // --- the thread that reads

  /// Waits until the queue has space and adds the block. Blocks before the sought position, and
  /// those whose times do not rise, are left out. Returns false when this pass has ended.
  bool push(const TrackBlock& block, const tracks::Faults& faults);
  /// Call this at the end of the file, with an `error` if the file should not end there. Ignored
  /// when nothing more of this pass is wanted.
  void end_pass(const std::string& error);
  /// Call this when the file cannot be read further. Only the first error is kept.
  void end(const std::string& error);
  /// Waits for a seek(), whose position it returns; nothing after stop().
  std::optional<int64_t> await_seek();
  /// Call this before adding blocks from the position that await_seek() returned last.
  void begin_pass();

  // --- the thread that plays

  enum class Found {
    kBlock,
    kEnd,  ///< there is no more, see error()
    kLate  ///< the block has not been read yet
  };

  /// Adds `later_ns` to all times: the film shows everything that much later than the file says.
  /// Call this before the first pop().
  void set_later(int64_t later_ns);
  /// Seeks: the next blocks are those that end after `time_ns`.
  void seek(int64_t time_ns);
  /// Moves the oldest block into `block`; waits for it until `limit`, or until interrupted.
  Found pop(TrackBlock& block, std::chrono::steady_clock::time_point limit);

  // --- any thread

  /// Why the file could not be read to its end; empty if it could so far.
  std::string error() const;
  /// Whether there was an error, and every block before it has been taken.
  bool has_failed() const;
  /// Whether pop() has waited in vain.
  bool was_late() const;
  tracks::Faults faults() const;
  void set_interrupted(bool interrupted) { set(interrupted_, interrupted); }
  /// From now on, nothing waits and no block is added.
  void stop() { set(stopped_, true); }

 private:
  void set(bool& flag, bool value);
  void set_end(const std::string& error);  // with the mutex held
  bool is_wanted() const { return !stopped_ && pass_ == wanted_pass_; }
  bool is_full() const;

  mutable std::mutex mutex_;  ///< guards all
  std::condition_variable changed_;
  std::deque<TrackBlock> blocks_;
  bool ended_ = false, late_ = false, interrupted_ = false, stopped_ = false;
  std::string error_;
  tracks::Faults faults_;
  int64_t later_ns_ = 0;
  int64_t sought_ns_ = 0;        ///< in the file
  int64_t last_ns_ = INT64_MIN;  ///< begin of the last block of this pass
  // Passes: that of the arriving blocks, of the seek in progress, and of the last seek().
  uint64_t pass_ = 0, next_pass_ = 0, wanted_pass_ = 0;
};

}  // namespace spidar
