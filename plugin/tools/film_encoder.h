// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <functional>
#include <string>

#include "plugin/tools/record_options.h"
#include "spidar/part_file.h"

namespace spidar::tools {

/// Remarks on a re-encoded film.
struct EncodedFilm {
  std::string felt, remark;  ///< see FilmWatch, if the film passes a spidarmotion
  std::string missing;       ///< see KeptStreams
};

/// Plays the pictures of `film`, upright and raw, through `elements`, each of which is followed by
/// "!". Writes the result as H.264 into `part`, whose name will end in .mp4 or .mkv, with the sound
/// and the subtitles of the film. The element named `last` (one of `elements`, or "flip", which
/// precedes them) gets `properties`, and `report` gets the progress of its frames, see
/// FilmProgress. Throws std::runtime_error, which names the package to install when GStreamer has
/// no encoder of H.264.
EncodedFilm encode_film(const std::string& film, const std::string& elements, const char* last,
                        const RecordProperties& properties, const PartFile& part,
                        const std::function<void(int percent)>& report);

/// Returns why some browser does not play the film, as the end of a sentence: "its picture is
/// video/x-h265". Empty when all do: H.264 in MP4, VP8 or VP9 in WebM, with AAC, MP3, Opus or
/// Vorbis. Throws std::runtime_error when the film cannot be read.
std::string why_no_browser(const std::string& film);

/// The end of that sentence for formats that most browsers play.
constexpr const char* kNotEveryBrowser = ", which not every iPhone or Mac (Safari) plays";

/// Whether `film` is in the container of WebM; browsers play other films in MP4.
bool is_webm(const std::string& film);

}  // namespace spidar::tools
