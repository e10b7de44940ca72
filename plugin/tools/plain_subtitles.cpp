// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/plain_subtitles.h"

#include <string>
#include <utility>

namespace spidar {
namespace {

/// What the demuxer has escaped; it leaves text with tags as it is.
std::string unescaped(std::string text) {
  if (text.find('<') != std::string::npos) return text;
  constexpr std::pair<const char*, char> kEntities[] = {{"&lt;", '<'},    {"&gt;", '>'},
                                                        {"&apos;", '\''}, {"&#39;", '\''},
                                                        {"&quot;", '"'},  {"&amp;", '&'}};
  for (const auto& [entity, character] : kEntities) {
    const std::string name = entity;
    for (size_t at = 0; (at = text.find(name, at)) != std::string::npos; ++at) {
      text.replace(at, name.size(), 1, character);
    }
  }
  return text;
}

GstPadProbeReturn unescape(GstPad*, GstPadProbeInfo* info, gpointer) {
  GstBuffer* const buffer = GST_PAD_PROBE_INFO_BUFFER(info);
  std::string text(gst_buffer_get_size(buffer), '\0');
  gst_buffer_extract(buffer, 0, text.data(), text.size());
  text = unescaped(std::move(text));
  GstBuffer* const plain = gst_buffer_new_memdup(text.data(), text.size());
  gst_buffer_copy_into(plain, buffer, GST_BUFFER_COPY_METADATA, 0, static_cast<gsize>(-1));
  gst_buffer_unref(buffer);
  GST_PAD_PROBE_INFO_DATA(info) = plain;
  return GST_PAD_PROBE_OK;
}

}  // namespace

GstElement* add_plain_subtitles(GstElement* pipeline, const GstCaps* caps) {
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  const gchar* format = gst_structure_get_string(structure, "format");
  if (!gst_structure_has_name(structure, "text/x-raw") || g_strcmp0(format, "pango-markup") != 0) {
    return nullptr;
  }
  GstElement* plain = gst_element_factory_make("capssetter", nullptr);
  gst_util_set_object_arg(G_OBJECT(plain), "caps", "text/x-raw,format=utf8");
  gst_bin_add(GST_BIN(pipeline), plain);
  GstPad* pad = gst_element_get_static_pad(plain, "src");
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, unescape, nullptr, nullptr);
  gst_object_unref(pad);
  gst_element_sync_state_with_parent(plain);
  return plain;
}

}  // namespace spidar
