// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Pipelines of the benchmarks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "tests/support/picture.h"

namespace spidar::bench {

struct Unref {
  void operator()(void* object) const { gst_object_unref(object); }
};
using Element = std::unique_ptr<GstElement, Unref>;

/// Stopped when it goes.
class Pipeline {
 public:
  /// Throws std::runtime_error when `line` is none.
  explicit Pipeline(const std::string& line);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  void play() { gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING); }
  GstElement* get() const { return pipeline_.get(); }
  /// Throws std::runtime_error with what went wrong.
  void wait_for_end();
  Element by_name(const char* name) const {
    return Element(gst_bin_get_by_name(GST_BIN(pipeline_.get()), name));
  }

 private:
  Element pipeline_;
};

/// A grey picture as I420, which is what encoders take as it is.
/// The values in these columns of a haptic trace, row by row. Throws std::runtime_error.
std::vector<std::vector<double>> read_trace(const std::string& path,
                                            const std::vector<std::string>& columns);

GstBuffer* i420_buffer(const test::Picture& picture);

/// The n-th of `rate_Hz` frames a second.
void set_time(GstBuffer* buffer, int n, int rate_Hz);

}  // namespace spidar::bench
