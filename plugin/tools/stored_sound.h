// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Makes sure that a file contains the sound that was written into it.
#pragma once

#include <cstdint>
#include <string>

#include <gst/gst.h>

#include "plugin/tracks/part_file.h"

namespace spidar {

/// Sound that flows through a pad, as a checksum. Outlives the pipeline.
class StoredSound {
 public:
  StoredSound() = default;
  StoredSound(const StoredSound&) = delete;
  StoredSound& operator=(const StoredSound&) = delete;

  /// Of the element `name` in a pipeline that has not started.
  void watch(GstElement* pipeline, const char* name);
  /// Decodes the file `part`, which a pipeline with an element "stored" (encoder_of()) has written.
  /// Throws std::runtime_error when that is not what has flowed.
  void check(const PartFile& part) const;

 private:
  static GstPadProbeReturn flows(GstPad* pad, GstPadProbeInfo* info, gpointer self);

  std::string format_;  // of the samples, as caps name it
  uint64_t bytes_ = 0;
  uint64_t sum_ = 0xcbf29ce484222325;  // FNV-1a
};

}  // namespace spidar
