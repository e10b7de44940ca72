// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/stored_sound.h"

#include <stdexcept>

#include "plugin/tools/track_samples.h"

namespace spidar {

void StoredSound::watch(GstElement* pipeline, const char* name) {
  GstElement* const element = gst_bin_get_by_name(GST_BIN(pipeline), name);
  GstPad* const pad = gst_element_get_static_pad(element, "sink");
  gst_pad_add_probe(
      pad,
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM),
      flows, this, nullptr);
  gst_object_unref(pad);
  gst_object_unref(element);
}

GstPadProbeReturn StoredSound::flows(GstPad*, GstPadProbeInfo* info, gpointer user) {
  auto& self = *static_cast<StoredSound*>(user);
  if (info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) {
    GstEvent* const event = GST_PAD_PROBE_INFO_EVENT(info);
    if (GST_EVENT_TYPE(event) != GST_EVENT_CAPS) return GST_PAD_PROBE_OK;
    GstCaps* caps = nullptr;
    gst_event_parse_caps(event, &caps);
    const char* const format = gst_structure_get_string(gst_caps_get_structure(caps, 0), "format");
    self.format_ = format ? format : "";
    return GST_PAD_PROBE_OK;
  }
  GstMapInfo map;
  if (!gst_buffer_map(GST_PAD_PROBE_INFO_BUFFER(info), &map, GST_MAP_READ)) return GST_PAD_PROBE_OK;
  for (size_t i = 0; i < map.size; ++i) self.sum_ = (self.sum_ ^ map.data[i]) * 0x100000001b3;
  self.bytes_ += map.size;
  gst_buffer_unmap(GST_PAD_PROBE_INFO_BUFFER(info), &map);
  return GST_PAD_PROBE_OK;
}

void StoredSound::check(const PartFile& part) const {
  part.check_in_place();
  StoredSound read;
  std::string why;
  try {
    run_pipeline(
        "filesrc name=file ! decodebin ! audioconvert dithering=none noise-shaping=none ! "
        "audio/x-raw,layout=interleaved,format=" +
            format_ + " ! fakesink name=read sync=false",
        [&](GstElement* pipeline) {
          set_location(pipeline, "file", part.path());
          read.watch(pipeline, "read");
        });
  } catch (const std::runtime_error& error) {
    why = std::string(": ") + error.what();
  }
  if (why.empty() && read.bytes_ == bytes_ && read.sum_ == sum_) return;
  throw std::runtime_error(part.target() + ": what is read back is not what was written" + why);
}

}  // namespace spidar
