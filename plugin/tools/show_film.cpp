// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <iostream>
#include <stdexcept>
#include <string>

#include "plugin/films/file_end.h"
#include "plugin/films/file_pipeline.h"
#include "plugin/gobject/ref.h"
#include "plugin/tools/film_encoder.h"
#include "plugin/tools/film_watch.h"
#include "plugin/tools/kept_streams.h"
#include "plugin/tools/record_report.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "spidar/tools/command_line.h"
#include "spidar/whole_file.h"

namespace spidar::tools {
namespace {

/// Upright, because the arrow and the curve are drawn into pictures as they are shown.
constexpr const char* kDrawnFilm =
    "filesrc name=source ! decodebin name=decode videoconvert name=convert ! "
    "videoflip video-direction=auto ! spidarmotion name=motion device=none overlay=curve ! ";
constexpr const char* kSubtitles = "subtitles.video_sink subtitleoverlay name=subtitles ! ";

/// Returns what is to be reported of it. Throws std::runtime_error, without the name of the film.
std::string show(const std::string& film, bool draws_subtitles, const RecordProperties& properties,
                 const PartFile& part) {
  RecordReport report({film});
  FilmProgress progress([&report](int percent) { report.progress(0, percent); });
  FilmWatch watch;
  KeptStreams others;
  QuietEnd quiet;
  GstClockTime last_frame = GST_CLOCK_TIME_NONE;  // outlives the pipeline
  const FilePipeline file(
      kDrawnFilm + std::string(draws_subtitles ? kSubtitles : "") + film_encoder(part), film,
      nullptr, kSlowShare);
  GstElement* const motion = file.find("motion");
  set_properties(motion, properties);
  const FilmEnd end = film_end(film);
  watch.begin(file.pipeline(), end == FilmEnd::kAppended);
  others.begin(file.pipeline());
  quiet.begin(file.pipeline());
  progress.watch(motion);
  const Ref<GstPad> drawn(gst_element_get_static_pad(motion, "src"));
  gst_pad_add_probe(drawn.get(), GST_PAD_PROBE_TYPE_BUFFER, order_frame, &last_frame, nullptr);
  watch.play(file);
  if (end == FilmEnd::kCutOff) throw std::runtime_error(kEndMissing);
  std::string said = watch.felt();
  for (const std::string& more : {others.missing(), watch.remark()}) {
    if (!more.empty()) said += "; " + more;
  }
  return said;
}

}  // namespace

int show_film(const std::string& film, const std::string& to, bool force, bool draws_subtitles,
              const RecordProperties& properties) {
  if (!ends_with(to, ".mp4") && !ends_with(to, ".mkv")) {
    throw UsageError(to + ": is to end in .mp4 or .mkv");
  }
  note_read(film);
  PartFile part(to, {force, "spidartrack show"});
  std::string said;
  try {
    said = show(film, draws_subtitles, properties, part);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(film + ": " + error.what());
  }
  publish(part);
  std::cout << film << ": " << to << "; " << said << '\n';
  return kDone;
}

}  // namespace spidar::tools
