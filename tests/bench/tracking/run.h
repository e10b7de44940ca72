// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Runs pipelines over the same frames.
#pragma once

#include <deque>
#include <vector>

#include "tests/bench/tracking/pipelines.h"
#include "tests/bench/tracking/score.h"
#include "tests/support/known_motion.h"
#include "tests/support/picture.h"

namespace spidar::bench {

/// A pipeline in use: memory lasts from film to film, as it does in a player.
class Runner {
 public:
  explicit Runner(const Pipeline& pipeline);

  const Pipeline& pipeline() const { return *pipeline_; }

  /// One film. The time is that of the thread: of the tracks, or of all of motion=object; the first
  /// frame is not in it.
  void run(const test::Film& film, const std::vector<test::Picture>& frames, Score& score);

 private:
  const MeasuredFrame& find_objects(const ImageView& frame);
  void restart();

  const Pipeline* pipeline_;
  std::unique_ptr<Peer> peer_;
  MotionEstimator motion_;
  ReducedFrame reduced_;
  MeasuredFrame scene_;
};

/// All over one film, one after the other, so that what disturbs hits all.
/// A score for each.
std::vector<Score> run_all(std::deque<Runner>& runners, const test::Film& film,
                           const std::vector<test::Picture>& frames);

}  // namespace spidar::bench
