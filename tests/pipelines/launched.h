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

/// How a pipeline ended, and its messages.
struct Outcome {
  bool eos = false;
  std::string error;
  std::vector<std::string> warnings;
  std::string clock;  ///< type of the last clock
  int motions = 0;
  double largest_force_N = 0;
};

/// Records a message.
void take(Outcome& outcome, GstMessage* message);

/// Records every tick of each spidarmotion and spidarsink in `bin`, including ones added later, and
/// checks them when it is destroyed; the pipeline must be in NULL by then.
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

/// Plays to the end or, if `frames` is not 0, until that many frames were analysed. Takes ownership
/// of the pipeline.
Outcome run_to_end(GstElement* pipeline, int frames = 0);

/// The same for a launch line.
Outcome launch(const std::string& line, int frames = 0);

}  // namespace spidar::test
