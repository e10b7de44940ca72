// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Samples that need not fit into memory.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/track/exchange_formats.h"
#include "plugin/tracks/part_file.h"

namespace spidar {

/// A file of F32 samples beside the file that is made of them, which is removed with the object.
class SampleFile {
 public:
  /// `target` is the file that is made. Throws std::runtime_error as PartFile.
  explicit SampleFile(const std::string& target) : part_(target + ".raw", {true, {}}) {}

  /// Throws std::runtime_error when it cannot be written.
  void add(const TrackSample& sample);
  /// What has been added is in the file.
  void flush();

  size_t count() const { return count_; }
  const std::string& path() const { return part_.path(); }
  /// All samples times `gain`. Throws std::runtime_error when they cannot be read. After flush().
  SampleSource samples(double gain = 1) const;

 private:
  PartFile part_;
  std::vector<TrackSample> waiting_;
  size_t count_ = 0;
};

}  // namespace spidar
