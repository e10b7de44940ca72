// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/kept_streams.h"

#include <cstring>
#include <regex>
#include <utility>

#include "plugin/films/stream_content.h"

namespace spidar::tools {
namespace {

constexpr Encoder kSound[] = {
    {"avenc_aac", "audioconvert ! audioresample ! avenc_aac"},
    {"voaacenc", "audioconvert ! audioresample ! voaacenc"},
};
constexpr const char* kNoSound =
    "its sound is left out: GStreamer has no encoder of AAC; install gstreamer1.0-libav "
    "(avenc_aac)";

/// Sound that containers take without encoding.
constexpr const char* kCopied =
    "audio/mpeg,mpegversion=(int)4,stream-format=(string)raw,framed=(boolean)true; "
    "audio/mpeg,mpegversion=(int)1,layer=(int)3,parsed=(boolean)true";
/// Text as containers take it.
constexpr const char* kPlainText = "text/x-raw,format=(string)utf8";

std::string format_of(const GstCaps* caps) {
  return gst_structure_get_name(gst_caps_get_structure(caps, 0));
}

/// Whether the text may have Pango's marks.
bool is_marked(GstCaps* caps) {
  const Ref<GstCaps> plain(gst_caps_from_string(kPlainText));
  return format_of(caps) == "text/x-raw" && !gst_caps_is_subset(caps, plain.get());
}

/// Removes Pango's marks, such as `<i>` and `&amp;`. A parser does not serve: GStreamer passes a
/// text of Matroska on unchanged, with "<i>" and with a plain "&".
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

/// Writes each ampersand that begins no name as one. Matroska's demuxer says of any text that it
/// has Pango's marks, and Pango refuses a plain ampersand.
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

}  // namespace

void KeptStreams::begin(GstElement* pipeline) {
  pipeline_ = pipeline;
  const Ref<GstElement> decoder(gst_bin_get_by_name(GST_BIN(pipeline), "decode"));
  GstCaps* caps = nullptr;
  g_object_get(decoder.get(), "caps", &caps, nullptr);
  caps = gst_caps_make_writable(caps);
  gst_caps_append(caps, gst_caps_from_string(kCopied));
  g_object_set(decoder.get(), "caps", caps, nullptr);
  gst_caps_unref(caps);
  g_signal_connect(decoder.get(), "unknown-type", G_CALLBACK(hear_unknown), this);
  g_signal_connect(decoder.get(), "no-more-pads", G_CALLBACK(choose), this);
}

void KeptStreams::miss(const std::string& what) {
  if (missing_.find(what) == std::string::npos) missing_ += (missing_.empty() ? "" : "; ") + what;
}

void KeptStreams::hear_unknown(GstElement*, GstPad*, GstCaps* caps, gpointer user) {
  auto& self = *static_cast<KeptStreams*>(user);
  const StreamContent content = content_of(caps);
  if (content != StreamContent::kSound && content != StreamContent::kSubtitles) return;
  const bool is_sound = content == StreamContent::kSound;
  self.miss(std::string(is_sound ? "a sound of it is" : "subtitles of it are") +
            " left out: GStreamer has no decoder of " + format_of(caps));
}

/// This signal means that all streams are known, and none of them flows yet.
void KeptStreams::choose(GstElement* decoder, gpointer user) {
  auto& self = *static_cast<KeptStreams*>(user);
  const Ref<GstElement> overlay(gst_bin_get_by_name(GST_BIN(self.pipeline_), "subtitles"));
  bool is_drawn = false;
  for (GList* i = decoder->srcpads; i; i = i->next) {
    auto* const pad = static_cast<GstPad*>(i->data);
    const StreamContent content = content_of(pad);
    if (content == StreamContent::kSound) self.keep_sound(pad);
    if (content != StreamContent::kSubtitles || is_drawn) continue;
    if (overlay) {
      if (is_marked(Ref<GstCaps>(caps_of(pad)).get())) {
        gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, replace_text<with_names>, nullptr,
                          nullptr);
      }
      is_drawn =
          gst_element_link_pads(decoder, GST_OBJECT_NAME(pad), overlay.get(), "subtitle_sink");
    } else {
      self.keep_subtitles(pad);
    }
  }
  if (overlay && !is_drawn) self.miss("it has no subtitles to draw");
}

void KeptStreams::keep_sound(GstPad* sound) {
  const Ref<GstCaps> caps(caps_of(sound));
  const char* const encoder =
      format_of(caps.get()) == "audio/x-raw" ? first_installed(kSound) : "identity";
  if (!encoder) return miss(kNoSound);
  lead_to_muxer(sound, encoder, "audio_%u");
}

void KeptStreams::keep_subtitles(GstPad* subtitles) {
  const Ref<GstCaps> caps(caps_of(subtitles));
  if (format_of(caps.get()) != "text/x-raw") {
    return miss("subtitles of it are left out, because they are pictures (" +
                format_of(caps.get()) + "); spidartrack show --subtitles draws them into its film");
  }
  if (is_marked(caps.get())) {
    gst_pad_add_probe(subtitles, GST_PAD_PROBE_TYPE_BUFFER, replace_text<without_marks>, nullptr,
                      nullptr);
  }
  const std::string plain = std::string("capssetter caps=\"") + kPlainText + '"';
  lead_to_muxer(subtitles, plain.c_str(), "subtitle_%u");
}

void KeptStreams::lead_to_muxer(GstPad* stream, const char* elements, const char* into) {
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

}  // namespace spidar::tools
