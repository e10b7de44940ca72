// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <mutex>
#include <set>
#include <string>

#include <gst/gst.h>

namespace spidar {

/// Chooses the picture of a film among the streams of a decodebin or uridecodebin: a cover only
/// where there is nothing else. Outlives the pipeline.
class VideoChoice {
 public:
  enum class Rule {
    kFirst,   ///< as playbin and playbin3, even if the film marks another stream as default
    kMarked,  ///< as VLC and mpv: a stream that the film marks as default, else the first
  };

  explicit VideoChoice(Rule rule) : rule_(rule) {}
  VideoChoice(const VideoChoice&) = delete;
  VideoChoice& operator=(const VideoChoice&) = delete;

  /// Call this before `decoder` starts, to recognise covers, which look like any picture when
  /// decoded.
  void watch(GstElement* decoder);
  /// Call this once all streams of `decoder` are known; null without pictures. Owned by the
  /// decoder.
  GstPad* choose(GstElement* decoder);

 private:
  static gboolean may_continue(GstElement* decoder, GstPad* pad, GstCaps* caps, gpointer self);
  int rank(GstPad* pad) const;

  const Rule rule_;
  std::mutex mutex_;
  std::set<std::string> covers_;  ///< streams of pictures in still formats, by id
};

}  // namespace spidar
