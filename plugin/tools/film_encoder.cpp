// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_encoder.h"

#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <regex>
#include <stdexcept>
#include <unistd.h>
#include <utility>

#include <gst/gst.h>

#include "plugin/films/file_bytes.h"
#include "plugin/films/file_pipeline.h"
#include "plugin/films/stream_content.h"
#include "plugin/gobject/ref.h"
#include "plugin/tools/film_watch.h"
#include "plugin/tools/track_samples.h"

namespace spidar::tools {
namespace {

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

/// Encoders of constant quality, with which pictures of any size look alike: H.264 with a quantizer
/// between 20 and 26 hardly differs from its source. These are the fastest such settings.
constexpr Encoder kVideo[] = {
    {"x264enc", "x264enc speed-preset=veryfast pass=qual quantizer=22"},
    {"openh264enc", "openh264enc name=encoder rate-control=off complexity=low ! h264parse"},
};
constexpr const char* kNoVideo =
    "GStreamer has no encoder of H.264: install gstreamer1.0-plugins-ugly (x264enc)";

/// Returns the elements from raw pictures to the file, with a muxer "mux".
std::string to_file(const PartFile& part) {
  const char* const encoder = first_installed(kVideo);
  if (!encoder) throw std::runtime_error(kNoVideo);
  // H.264 of 4:2:0 has even sizes.
  return "videoconvert ! videoscale ! video/x-raw,format=I420,width=(int)[2,16384,2],"
         "height=(int)[2,16384,2] ! " +
         std::string(encoder) + " ! " +
         (ends_with(part.target(), ".mkv") ? "matroskamux" : "mp4mux") +
         " name=mux ! fdsink sync=false fd=" + std::to_string(part.descriptor());
}

/// A buffer probe that delays a frame with the time of the last frame (the user data) to the end of
/// that frame. Some decoders give two frames one time, such as that of MPEG-4 in AVI for frames
/// stored in another order; MP4 does not allow that.
GstPadProbeReturn order_frame(GstPad*, GstPadProbeInfo* info, gpointer user) {
  GstClockTime& last = *static_cast<GstClockTime*>(user);
  auto* frame = GST_PAD_PROBE_INFO_BUFFER(info);
  if (GST_CLOCK_TIME_IS_VALID(last) && GST_BUFFER_PTS(frame) <= last) {
    const GstClockTime duration =
        GST_BUFFER_DURATION_IS_VALID(frame) ? GST_BUFFER_DURATION(frame) : GST_MSECOND;
    info->data = frame = gst_buffer_make_writable(frame);
    GST_BUFFER_PTS(frame) = last + duration;
  }
  last = GST_BUFFER_PTS(frame);
  return GST_PAD_PROBE_OK;
}

constexpr Encoder kSound[] = {
    {"avenc_aac", "audioconvert ! audioresample ! avenc_aac"},
    {"voaacenc", "audioconvert ! audioresample ! voaacenc"},
};
constexpr const char* kNoSound =
    "its sound is left out: GStreamer has no encoder of AAC; install gstreamer1.0-libav "
    "(avenc_aac)";

/// Sound that is copied into the container without encoding.
constexpr const char* kCopied =
    "audio/mpeg,mpegversion=(int)4,stream-format=(string)raw,framed=(boolean)true; "
    "audio/mpeg,mpegversion=(int)1,layer=(int)3,parsed=(boolean)true";
/// Text as it is written into containers.
constexpr const char* kPlainText = "text/x-raw,format=(string)utf8";

std::string format_of(const GstCaps* caps) {
  return gst_structure_get_name(gst_caps_get_structure(caps, 0));
}

/// Whether the text may contain Pango markup.
bool is_marked(GstCaps* caps) {
  const Ref<GstCaps> plain(gst_caps_from_string(kPlainText));
  return format_of(caps) == "text/x-raw" && !gst_caps_is_subset(caps, plain.get());
}

/// Removes Pango markup, such as `<i>` and `&amp;`. A parser would fail: GStreamer passes text from
/// Matroska on unchanged, with "<i>" and with a plain "&".
std::string without_marks(const std::string& marked) {
  static const std::regex mark("</?[A-Za-z][^<>]*>");
  std::string plain = std::regex_replace(marked, mark, "");
  constexpr std::pair<const char*, const char*> kNames[] = {{"&lt;", "<"},    {"&gt;", ">"},
                                                            {"&quot;", "\""}, {"&apos;", "'"},
                                                            {"&#39;", "'"},   {"&amp;", "&"}};
  for (const auto& [name, letter] : kNames) {
    for (size_t at = plain.find(name); at != std::string::npos; at = plain.find(name, at + 1)) {
      plain.replace(at, std::strlen(name), letter);
    }
  }
  return plain;
}

/// Escapes each ampersand that does not begin an entity. matroskademux declares any text as Pango
/// markup, and Pango rejects a plain ampersand.
std::string with_names(const std::string& marked) {
  static const std::regex kAlone("&(?!(amp|lt|gt|quot|apos|#[0-9]+|#x[0-9a-fA-F]+);)");
  return std::regex_replace(marked, kAlone, "&amp;");
}

/// A probe for subtitles, which replaces their text by the result of `kChange`.
template <std::string (*kChange)(const std::string&)>
GstPadProbeReturn replace_text(GstPad*, GstPadProbeInfo* info, gpointer) {
  GstBuffer* const old = GST_PAD_PROBE_INFO_BUFFER(info);
  GstMapInfo map;
  if (!gst_buffer_map(old, &map, GST_MAP_READ)) return GST_PAD_PROBE_OK;
  std::string text(reinterpret_cast<const char*>(map.data), map.size);
  gst_buffer_unmap(old, &map);
  text = kChange(text.c_str());  // some texts end with a zero
  GstBuffer* const changed = gst_buffer_new_memdup(text.data(), text.size());
  constexpr auto kRest =
      static_cast<GstBufferCopyFlags>(GST_BUFFER_COPY_FLAGS | GST_BUFFER_COPY_TIMESTAMPS);
  gst_buffer_copy_into(changed, old, kRest, 0, static_cast<gsize>(-1));
  info->data = changed;
  gst_buffer_unref(old);
  return GST_PAD_PROBE_OK;
}

/// Keeps every sound and all subtitles of a film that is re-encoded. AAC and MP3 are copied,
/// other sound becomes AAC; text subtitles stay text, without styles. Outlives the pipeline.
class KeptStreams {
 public:
  KeptStreams() = default;
  KeptStreams(const KeptStreams&) = delete;
  KeptStreams& operator=(const KeptStreams&) = delete;

  /// `pipeline` has a decodebin "decode" and a muxer "mux", and has not started. If it has a
  /// subtitleoverlay "subtitles", that draws the first subtitles, and no others are kept.
  void begin(GstElement* pipeline) {
    pipeline_ = pipeline;
    const Ref<GstElement> decoder(gst_bin_get_by_name(GST_BIN(pipeline), "decode"));
    GstCaps* caps = nullptr;
    g_object_get(decoder.get(), "caps", &caps, nullptr);
    caps = gst_caps_make_writable(caps);
    gst_caps_append(caps, gst_caps_from_string(kCopied));
    g_object_set(decoder.get(), "caps", caps, nullptr);
    gst_caps_unref(caps);
    g_signal_connect(decoder.get(), "unknown-type", G_CALLBACK(on_unknown_type), this);
    g_signal_connect(decoder.get(), "no-more-pads", G_CALLBACK(choose), this);
  }

  /// After the end: what is missing, and why, as sentences; empty if nothing is.
  const std::string& missing() const { return missing_; }

 private:
  void miss(const std::string& what) {
    if (missing_.find(what) == std::string::npos) missing_ += (missing_.empty() ? "" : "; ") + what;
  }

  static void on_unknown_type(GstElement*, GstPad*, GstCaps* caps, gpointer user) {
    auto& self = *static_cast<KeptStreams*>(user);
    const StreamContent content = content_of(caps);
    if (content != StreamContent::kSound && content != StreamContent::kSubtitles) return;
    const bool is_sound = content == StreamContent::kSound;
    self.miss(std::string(is_sound ? "a sound of it is" : "subtitles of it are") +
              " left out: GStreamer has no decoder of " + format_of(caps));
  }

  /// Called at no-more-pads: all streams are known, and none of them flows yet.
  static void choose(GstElement* decoder, gpointer user) {
    auto& self = *static_cast<KeptStreams*>(user);
    const Ref<GstElement> overlay(gst_bin_get_by_name(GST_BIN(self.pipeline_), "subtitles"));
    bool is_drawn = false;
    for (GList* i = decoder->srcpads; i; i = i->next) {
      auto* const pad = static_cast<GstPad*>(i->data);
      const StreamContent content = content_of(pad);
      if (content == StreamContent::kSound) self.copy_sound(pad);
      if (content != StreamContent::kSubtitles || is_drawn) continue;
      if (overlay) {
        if (is_marked(Ref<GstCaps>(caps_of(pad)).get())) {
          gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, replace_text<with_names>, nullptr,
                            nullptr);
        }
        is_drawn =
            gst_element_link_pads(decoder, GST_OBJECT_NAME(pad), overlay.get(), "subtitle_sink");
      } else {
        self.copy_subtitles(pad);
      }
    }
    if (overlay && !is_drawn) self.miss("it has no subtitles to draw");
  }

  void copy_sound(GstPad* sound) {
    const Ref<GstCaps> caps(caps_of(sound));
    const char* const encoder =
        format_of(caps.get()) == "audio/x-raw" ? first_installed(kSound) : "identity";
    if (!encoder) return miss(kNoSound);
    lead_to_muxer(sound, encoder, "audio_%u");
  }

  void copy_subtitles(GstPad* subtitles) {
    const Ref<GstCaps> caps(caps_of(subtitles));
    if (format_of(caps.get()) != "text/x-raw") {
      return miss("subtitles of it are left out, because they are pictures (" +
                  format_of(caps.get()) +
                  "); spidartrack show --subtitles draws them into its film");
    }
    if (is_marked(caps.get())) {
      gst_pad_add_probe(subtitles, GST_PAD_PROBE_TYPE_BUFFER, replace_text<without_marks>, nullptr,
                        nullptr);
    }
    const std::string plain = std::string("capssetter caps=\"") + kPlainText + '"';
    lead_to_muxer(subtitles, plain.c_str(), "subtitle_%u");
  }

  void lead_to_muxer(GstPad* stream, const char* elements, const char* into) {
    // The queue holds the sound while the encoder of the pictures looks ahead.
    const std::string line =
        std::string("queue max-size-time=0 max-size-buffers=0 ! ") + elements + " ! identity";
    GstElement* const branch = gst_parse_bin_from_description(line.c_str(), TRUE, nullptr);
    if (!branch) return;
    gst_bin_add(GST_BIN(pipeline_), branch);
    const Ref<GstElement> mux(gst_bin_get_by_name(GST_BIN(pipeline_), "mux"));
    const Ref<GstPad> to(gst_element_request_pad_simple(mux.get(), into));
    const Ref<GstPad> from(gst_element_get_static_pad(branch, "src"));
    const Ref<GstPad> first(gst_element_get_static_pad(branch, "sink"));
    gst_pad_link(from.get(), to.get());
    gst_element_sync_state_with_parent(branch);
    gst_pad_link_full(stream, first.get(), GST_PAD_LINK_CHECK_NOTHING);
  }

  GstElement* pipeline_ = nullptr;
  std::string missing_;
};

/// Discards the standard error while GStreamer requests the last pictures of OpenH264, which then
/// prints "Error: cmInitParaError" although nothing is wrong. Outlives the pipeline.
class MutedStderr {
 public:
  MutedStderr() = default;
  ~MutedStderr() { unmute(); }
  MutedStderr(const MutedStderr&) = delete;
  MutedStderr& operator=(const MutedStderr&) = delete;

  /// `pipeline` has the elements of to_file(), and has not started.
  void begin(GstElement* pipeline) {
    const Ref<GstElement> encoder(gst_bin_get_by_name(GST_BIN(pipeline), "encoder"));
    if (!encoder) return;
    for (const char* const name : {"sink", "src"}) {
      const Ref<GstPad> pad(gst_element_get_static_pad(encoder.get(), name));
      gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, pass, this, nullptr);
    }
  }

 private:
  static GstPadProbeReturn pass(GstPad* pad, GstPadProbeInfo* info, gpointer user) {
    auto& self = *static_cast<MutedStderr*>(user);
    if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) != GST_EVENT_EOS) return GST_PAD_PROBE_OK;
    self.unmute();
    if (GST_PAD_IS_SRC(pad)) return GST_PAD_PROBE_OK;
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return GST_PAD_PROBE_OK;
    self.errors_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (self.errors_ >= 0) dup2(nowhere, STDERR_FILENO);
    close(nowhere);
    return GST_PAD_PROBE_OK;
  }
  void unmute() {
    if (errors_ < 0) return;
    dup2(errors_, STDERR_FILENO);
    close(std::exchange(errors_, -1));
  }

  int errors_ = -1;  ///< the standard error while it is discarded, else −1
};

/// What all browsers decode, in MP4 and in WebM: H.264 only with 8 bits and 4:2:0.
constexpr const char* kPlayed =
    "video/x-h264,profile=(string){constrained-baseline,baseline,main,high,constrained-high,"
    "progressive-high}; "
    "audio/mpeg,mpegversion=(int){2,4}; audio/mpeg,mpegversion=(int)1,layer=(int)3; audio/x-opus; "
    "audio/x-vorbis";
constexpr const char* kPlayedInWebm = "video/x-vp8; video/x-vp9,profile=(string)0";
/// Safari decodes AV1 where the device does (iPhone 15 Pro, M3, later), VP8 and VP9 in WebM only.
constexpr const char* kMostlyPlayed = "video/x-av1; video/x-vp8; video/x-vp9,profile=(string)0";

constexpr size_t kHead_bytes = 64;

bool is_mp4(const std::string& film) {
  return has_at(FileBytes(film).read(0, kHead_bytes), 4, "ftyp");
}

bool is_one_of(const GstCaps* caps, const char* text) {
  const Ref<GstCaps> others(gst_caps_from_string(text));
  return gst_caps_can_intersect(caps, others.get()) != FALSE;
}

/// Why some browser does not play one stream of a film; empty if all do.
std::string why_not_played(GstPad* pad, bool in_webm) {
  const StreamContent content = content_of(pad);
  const Ref<GstCaps> caps(caps_of(pad));
  if (content != StreamContent::kVideo && content != StreamContent::kSound) return {};
  if (is_picture(caps.get()) || is_one_of(caps.get(), kPlayed) ||
      (in_webm && is_one_of(caps.get(), kPlayedInWebm))) {
    return {};
  }
  const GstStructure* const format = gst_caps_get_structure(caps.get(), 0);
  const char* const profile = gst_structure_get_string(format, "profile");
  return std::string(content == StreamContent::kVideo ? "its picture is " : "its sound is ") +
         gst_structure_get_name(format) + (profile ? std::string(" ") + profile : "") +
         (is_one_of(caps.get(), kMostlyPlayed) ? kNotEveryBrowser : "");
}

}  // namespace

bool is_webm(const std::string& film) {
  const std::string head = FileBytes(film).read(0, kHead_bytes);
  return has_at(head, 0, "\x1a\x45\xdf\xa3") && head.find("webm") != std::string::npos;
}

std::string why_no_browser(const std::string& film) {
  const bool in_webm = is_webm(film);
  if (!in_webm && !is_mp4(film)) return "it is neither MP4 nor WebM";
  // Subtitles may come late, and do not matter here.
  constexpr GstClockTime kLongest = 2 * GST_SECOND;
  std::mutex mutex;  // must outlive the pipeline
  std::string error;
  int known = 0;
  FilePipeline file("filesrc name=source ! parsebin name=parse", film);
  GstElement* const parser = file.find("parse");
  file.link_streams([&](GstPad* pad) -> GstElement* {
    const std::string why = why_not_played(pad, in_webm);
    const std::lock_guard<std::mutex> lock(mutex);
    if (!why.empty()) error = why;
    if (++known == parser->numsrcpads || !why.empty()) {
      gst_element_post_message(parser, gst_message_new_application(
                                           GST_OBJECT(parser), gst_structure_new_empty("known")));
    }
    return nullptr;
  });
  // A demuxer that adds its streams one by one may add more after this message.
  while (file.play_until(GST_MESSAGE_APPLICATION, kLongest) == GST_MESSAGE_APPLICATION) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (!error.empty()) break;
  }
  file.stop();
  return error;
}

EncodedFilm encode_film(const std::string& film, const std::string& elements, const char* last,
                        const RecordProperties& properties, const PartFile& part,
                        const std::function<void(int percent)>& report) {
  FilmProgress progress(report);
  FilmWatch watch;
  KeptStreams others;
  MutedStderr muted;
  GstClockTime last_frame = GST_CLOCK_TIME_NONE;  // must outlive the pipeline
  const FilePipeline file(
      "filesrc name=source ! decodebin name=decode videoconvert name=convert ! "
      "videoflip name=flip video-direction=auto ! " +
          elements + to_file(part),
      film, nullptr, kShareTimeout);
  GstElement* const pictures = file.find(last);
  set_properties(pictures, properties);
  watch.begin(file.pipeline(), film);
  others.begin(file.pipeline());
  muted.begin(file.pipeline());
  progress.watch(pictures);
  const Ref<GstPad> frames(gst_element_get_static_pad(pictures, "src"));
  gst_pad_add_probe(frames.get(), GST_PAD_PROBE_TYPE_BUFFER, order_frame, &last_frame, nullptr);
  watch.play(file);
  return {watch.felt(), watch.remark(), others.missing()};
}

}  // namespace spidar::tools
