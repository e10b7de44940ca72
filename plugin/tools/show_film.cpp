// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <iostream>
#include <stdexcept>
#include <string>

#include "plugin/films/file_end.h"
#include "plugin/tools/film_encoder.h"
#include "plugin/tools/film_watch.h"
#include "plugin/tools/record_report.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "spidar/tools/command_line.h"
#include "spidar/whole_file.h"

namespace spidar::tools {
namespace {

/// The pictures are upright, because the arrow and the curve are drawn as shown.
constexpr const char* kDrawn = "spidarmotion name=motion device=none overlay=curve ! ";
constexpr const char* kSubtitles = "subtitles.video_sink subtitleoverlay name=subtitles ! ";

/// Returns a remark. Throws std::runtime_error, without the name of the film.
std::string show(const std::string& film, bool draws_subtitles, const RecordProperties& properties,
                 const PartFile& part) {
  RecordReport report({film});
  const EncodedFilm shown =
      encode_film(film, kDrawn + std::string(draws_subtitles ? kSubtitles : ""), "motion",
                  properties, part, [&report](int percent) { report.progress(0, percent); });
  if (film_end(film) == FilmEnd::kCutOff) throw std::runtime_error(kEndMissing);
  std::string said = shown.felt;
  for (const std::string& more : {shown.missing, shown.remark}) {
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
