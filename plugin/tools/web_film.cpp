// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/web_film.h"

#include <mutex>
#include <stdexcept>

#include <gst/gst.h>

#include "plugin/gobject/ref.h"
#include "plugin/tools/film_encoder.h"
#include "plugin/tools/film_progress.h"
#include "plugin/tools/film_watch.h"
#include "plugin/tracks/file_bytes.h"
#include "plugin/tracks/file_end.h"
#include "plugin/tracks/file_pipeline.h"

namespace spidar::tools {
namespace {

/// Pictures and sound that all browsers decode. Of H.264 with 8 bits and 4:2:0.
constexpr const char* kPlayed =
    "video/x-h264,profile=(string){constrained-baseline,baseline,main,high,constrained-high,"
    "progressive-high}; video/x-vp8; video/x-vp9,profile=(string)0; video/x-av1; "
    "audio/mpeg,mpegversion=(int){2,4}; audio/mpeg,mpegversion=(int)1,layer=(int)3; audio/x-opus; "
    "audio/x-vorbis";

bool has_played_container(const std::string& film) {
  constexpr size_t kHead_bytes = 64;
  const std::string head = FileBytes(film).read(0, kHead_bytes);
  return has_at(head, 4, "ftyp") ||
         (has_at(head, 0, "\x1a\x45\xdf\xa3") && head.find("webm") != std::string::npos);
}

/// Why browsers do not play one stream of a film; empty if they do.
std::string why_not_played(GstPad* pad) {
  const StreamKind kind = kind_of(pad);
  const Ref<GstCaps> caps(caps_of(pad)), played(gst_caps_from_string(kPlayed));
  if (kind != StreamKind::kVideo && kind != StreamKind::kSound) return {};
  if (is_picture(caps.get()) || gst_caps_can_intersect(caps.get(), played.get())) return {};
  const GstStructure* const format = gst_caps_get_structure(caps.get(), 0);
  const char* const profile = gst_structure_get_string(format, "profile");
  return std::string(kind == StreamKind::kVideo ? "its picture is " : "its sound is ") +
         gst_structure_get_name(format) + (profile ? std::string(" ") + profile : "");
}

}  // namespace

std::string why_no_browser(const std::string& film) {
  if (!has_played_container(film)) return "it is neither MP4 nor WebM";
  // Subtitles may come late, and are not looked at.
  constexpr GstClockTime kLongest = 2 * GST_SECOND;
  std::mutex mutex;  // outlive the pipeline
  std::string error;
  int known = 0;
  FilePipeline file("filesrc name=source ! parsebin name=parse", film);
  GstElement* const parser = file.find("parse");
  file.link_streams([&](GstPad* pad) -> GstElement* {
    const std::string why = why_not_played(pad);
    const std::lock_guard<std::mutex> lock(mutex);
    if (!why.empty()) error = why;
    if (++known == parser->numsrcpads || !why.empty()) {
      gst_element_post_message(parser, gst_message_new_application(
                                           GST_OBJECT(parser), gst_structure_new_empty("known")));
    }
    return nullptr;
  });
  // Streams that are added one by one may be more than those that are known.
  while (file.play_until(GST_MESSAGE_APPLICATION, kLongest) == GST_MESSAGE_APPLICATION) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (!error.empty()) break;
  }
  file.stop();
  return error;
}

std::string convert_for_browsers(const std::string& film, const PartFile& part) {
  FilmWatch watch;
  KeptSound sound;
  QuietEnd quiet;
  GstClockTime last_frame = GST_CLOCK_TIME_NONE;  // outlives the pipeline
  const FilePipeline file(
      "filesrc name=source ! decodebin name=decode videoconvert name=convert ! "
      "videoflip name=flip video-direction=auto ! " +
          film_encoder(part),
      film, nullptr, kSlowShare);
  watch.begin(file.pipeline(), film_end(film) == FilmEnd::kAppended);
  sound.begin(file.pipeline());
  quiet.begin(file.pipeline());
  const Ref<GstPad> pictures(gst_element_get_static_pad(file.find("flip"), "src"));
  gst_pad_add_probe(pictures.get(), GST_PAD_PROBE_TYPE_BUFFER, order_frame, &last_frame, nullptr);
  watch.play(file);
  return sound.missing();
}

}  // namespace spidar::tools
