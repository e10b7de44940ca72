// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Pipelines with the plugin as GStreamer loads it, in real time, with a check of every tick.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "tests/support/temporary_folder.h"

namespace spidar::test {

/// How a pipeline ended, and what it said on the way.
struct Outcome {
  bool eos = false;
  std::string error;
  std::vector<std::string> warnings;
  std::string clock;  ///< type of the one that was played by last
  int motions = 0;
  double largest_force_N = 0;
};

/// Adds what a message says.
void take(Outcome& outcome, GstMessage* message);

/// Records every tick of each spidarmotion and spidarsink in `bin`, also of those to come, and
/// looks at them when it goes: the pipeline has to be in NULL by then.
class Traces {
 public:
  explicit Traces(GstElement* bin);
  ~Traces();
  Traces(const Traces&) = delete;
  Traces& operator=(const Traces&) = delete;

 private:
  static void added(GstBin*, GstBin*, GstElement* element, Traces* self) { self->record(element); }
  void record(GstElement* element);

  TemporaryFolder folder_;
  std::mutex mutex_;
  std::vector<std::string> paths_;
};

/// Plays to the end, or until `frames` were analysed where that is not 0. Takes the pipeline.
Outcome run_to_end(GstElement* pipeline, int frames = 0);

/// The same of a launch line.
Outcome launch(const std::string& line, int frames = 0);

}  // namespace spidar::test
