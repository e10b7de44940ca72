// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Writes films as H.264, and as browsers play them.
#pragma once

#include <functional>
#include <string>

#include <gst/gst.h>

#include "plugin/films/part_file.h"

namespace spidar::tools {

/// Elements from raw pictures to the file of `part`, whose name will end in .mp4 or .mkv, with a
/// muxer "mux". Throws std::runtime_error, which names the package to install, when GStreamer has
/// no encoder of H.264.
std::string film_encoder(const PartFile& part);

/// Some decoders give two frames the same time, as that of MPEG-4 in AVI does with the frames that
/// are stored in another order; MP4 does not allow that. The later one follows when the other one
/// ends. A probe for buffers, whose user data is the time of the last frame.
GstPadProbeReturn order_frame(GstPad* pad, GstPadProbeInfo* info, gpointer last_frame);

/// OpenH264 prints "Error: cmInitParaError" when GStreamer asks for its last pictures, although
/// nothing is wrong: as long as that takes, the standard error is discarded. Outlives the pipeline.
class QuietEnd {
 public:
  QuietEnd() = default;
  ~QuietEnd();
  QuietEnd(const QuietEnd&) = delete;
  QuietEnd& operator=(const QuietEnd&) = delete;

  /// `pipeline` has been made with film_encoder(), and has not started.
  void begin(GstElement* pipeline);

 private:
  static GstPadProbeReturn pass(GstPad* pad, GstPadProbeInfo* info, gpointer self);
  void speak();

  int errors_ = -1;  ///< the standard error while it is discarded, else −1
};

/// Why some browser does not play the film, as the end of a sentence: "its picture is
/// video/x-h265". Empty when all do: H.264 in MP4, VP8 or VP9 in WebM, with AAC, MP3, Opus or
/// Vorbis. Throws std::runtime_error when it cannot be read.
std::string why_no_browser(const std::string& film);

/// Ends that sentence for what most browsers play.
constexpr const char* kNotEveryBrowser = ", which not every iPhone or Mac (Safari) plays";

/// Whether `film` is in the container of WebM; any other that browsers play is in MP4.
bool is_webm(const std::string& film);

/// Writes `film` as H.264 and AAC into `part`, whose name ends in .mp4. Returns what is missing in
/// it, as a sentence; usually empty. `tell` is that of FilmProgress. Throws std::runtime_error.
std::string convert_for_browsers(const std::string& film, const PartFile& part,
                                 const std::function<void(int percent)>& tell);

}  // namespace spidar::tools
