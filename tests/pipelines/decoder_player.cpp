// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/pipelines/decoder_player.h"

namespace spidar::test {
namespace {

void link_video(GstElement*, GstPad* pad, gpointer data) {
  // decodebin3 adds its pads before they have caps.
  GstCaps* caps = gst_pad_query_caps(pad, nullptr);
  const bool video = !gst_caps_is_empty(caps) && !gst_caps_is_any(caps) &&
                     gst_structure_has_name(gst_caps_get_structure(caps, 0), "video/x-raw");
  gst_caps_unref(caps);
  if (!video) return;
  GstPad* sink = gst_element_get_static_pad(GST_ELEMENT(data), "sink");
  if (gst_pad_link(pad, sink) != GST_PAD_LINK_OK) g_error("the player cannot link its sink");
  gst_object_unref(sink);
}

GstPadProbeReturn refuse(GstPad*, GstPadProbeInfo* info, gpointer) {
  GstQuery* query = GST_PAD_PROBE_INFO_QUERY(info);
  if (GST_QUERY_TYPE(query) != GST_QUERY_CAPS) return GST_PAD_PROBE_OK;
  GstCaps* none = gst_caps_new_empty();
  gst_query_set_caps_result(query, none);
  gst_caps_unref(none);
  return GST_PAD_PROBE_HANDLED;
}

}  // namespace

GstElement* make_decoder_player(const std::string& decoder, const std::string& film,
                                GstElement** window) {
  gchar* uri = gst_filename_to_uri(film.c_str(), nullptr);
  const std::string source = decoder.rfind("uri", 0) == 0
                                 ? decoder + " name=decoder uri=" + uri
                                 : "filesrc location=" + film + " ! " + decoder + " name=decoder";
  g_free(uri);
  const std::string line =
      source + " identity name=video ! videoconvert name=convert ! fakevideosink name=screen";
  GstElement* player = gst_parse_launch(line.c_str(), nullptr);
  GstElement* video = gst_bin_get_by_name(GST_BIN(player), "video");
  GstElement* bin = gst_bin_get_by_name(GST_BIN(player), "decoder");
  g_signal_connect_object(bin, "pad-added", G_CALLBACK(link_video), video, GConnectFlags(0));
  GstElement* screen = gst_bin_get_by_name(GST_BIN(player), "screen");
  *window = GST_ELEMENT(GST_BIN_CHILDREN(screen)->data);
  for (GstElement* element : {video, bin, screen}) gst_object_unref(element);
  return player;
}

void add_own_motion(GstElement* player) {
  GstElement* convert = gst_bin_get_by_name(GST_BIN(player), "convert");
  GstElement* screen = gst_bin_get_by_name(GST_BIN(player), "screen");
  GstElement* motion = gst_element_factory_make("spidarmotion", nullptr);
  gst_util_set_object_arg(G_OBJECT(motion), "device", "none");
  gst_bin_add(GST_BIN(player), motion);
  gst_element_unlink(convert, screen);
  gst_element_link_many(convert, motion, screen, nullptr);
  gst_object_unref(convert);
  gst_object_unref(screen);
}

void refuse_caps(GstElement* player) {
  GstElement* video = gst_bin_get_by_name(GST_BIN(player), "video");
  GstPad* pad = gst_element_get_static_pad(video, "sink");
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_QUERY_DOWNSTREAM, refuse, nullptr, nullptr);
  gst_object_unref(pad);
  gst_object_unref(video);
}

void take_time_with_pads(GstElement* player) {
  GstElement* decoder = gst_bin_get_by_name(GST_BIN(player), "decoder");
  const auto wait = +[](GstElement*, GstPad*, gpointer) { g_usleep(200 * 1000); };
  g_signal_connect(decoder, "pad-added", G_CALLBACK(wait), nullptr);
  gst_object_unref(decoder);
}

}  // namespace spidar::test
