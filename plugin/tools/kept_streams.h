// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>

#include <gst/gst.h>

#include "plugin/gobject/ref.h"

namespace spidar::tools {

/// An encoder that may not be installed.
struct Encoder {
  const char* element;
  const char* line;  ///< elements for gst_parse_launch()
};

/// The line of the first encoder that is installed; null when none is.
template <size_t kCount>
const char* first_installed(const Encoder (&encoders)[kCount]) {
  for (const Encoder& encoder : encoders) {
    const Ref<GstElementFactory> factory(gst_element_factory_find(encoder.element));
    if (factory) return encoder.line;
  }
  return nullptr;
}

/// Keeps every sound and all subtitles of a film that is encoded anew. AAC and MP3 are copied,
/// other sound becomes AAC; text subtitles stay text, without styles. Outlives the pipeline.
class KeptStreams {
 public:
  KeptStreams() = default;
  KeptStreams(const KeptStreams&) = delete;
  KeptStreams& operator=(const KeptStreams&) = delete;

  /// `pipeline` has a decodebin "decode" and a muxer "mux", and has not started. If it has a
  /// subtitleoverlay "subtitles", that draws the first subtitles, and no others are kept.
  void begin(GstElement* pipeline);

  /// After the end: what is missing, and why, as sentences; empty if nothing is.
  const std::string& missing() const { return missing_; }

 private:
  static void choose(GstElement* decoder, gpointer self);
  static void hear_unknown(GstElement* decoder, GstPad* pad, GstCaps* caps, gpointer self);
  void keep_sound(GstPad* sound);
  void keep_subtitles(GstPad* subtitles);
  void lead_to_muxer(GstPad* stream, const char* elements, const char* into);
  void miss(const std::string& what);

  GstElement* pipeline_ = nullptr;
  std::string missing_;
};

}  // namespace spidar::tools
