// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/tracer/small_copy.h"

#include <algorithm>
#include <sstream>

#include <gst/video/video.h>

#include "plugin/gobject/ref.h"

namespace spidar {
namespace {

/// The height of a copy: the analysis halves larger frames until they have about this many lines.
constexpr int kCopyHeight_px = 480;

/// How a small copy is made of one kind of memory.
struct Copier {
  const char* feature;
  const char* element;   ///< required for this copier
  const char* reduce;    ///< in the language of gst-launch-1.0, before the caps of the copy
  const char* memory;    ///< of the copy
  const char* download;  ///< moves frames to the processor's memory
};
constexpr Copier kCopiers[] = {
    {"memory:GLMemory", "glcolorscale", "glcolorconvert ! glcolorscale",
     "video/x-raw(memory:GLMemory),format=RGBA", "gldownload"},
    // vapostproc downloads by itself.
    {"memory:VAMemory", "vapostproc", "vapostproc", "video/x-raw", "identity"},
};

bool is_installed(const Copier& copier) {
  const Ref<GstElementFactory> factory(gst_element_factory_find(copier.element));
  return bool(factory);
}

const Copier* copier_of(const GstCaps* caps) {
  if (gst_caps_is_empty(caps)) return nullptr;
  const GstCapsFeatures* const features = gst_caps_get_features(caps, 0);
  const auto* const found =
      std::find_if(std::begin(kCopiers), std::end(kCopiers), [features](const Copier& copier) {
        return gst_caps_features_contains(features, copier.feature);
      });
  return found == std::end(kCopiers) ? nullptr : found;
}

}  // namespace

GstCaps* gpu_caps() {
  GstCaps* const caps = gst_caps_new_empty();
  for (const Copier& copier : kCopiers) {
    if (!is_installed(copier)) continue;
    gst_caps_append_structure_full(caps, gst_structure_new_empty("video/x-raw"),
                                   gst_caps_features_new(copier.feature, nullptr));
  }
  return caps;
}

bool is_in_gpu(const GstCaps* caps) {
  return copier_of(caps) != nullptr;
}

GstElement* small_copy_bin_new(const GstCaps* caps, GstElement* motion) {
  GstVideoInfo info;
  const Copier* const copier = copier_of(caps);
  if (!copier || !gst_video_info_from_caps(&info, caps)) return nullptr;
  const int height = std::min(info.height, kCopyHeight_px);
  const auto width = static_cast<int>(gst_util_uint64_scale_round(info.width, height, info.height));
  // The copy is pushed first, because the frame may wait for its time downstream. The fakesink
  // takes no part in preroll.
  std::ostringstream elements;
  elements << "tee name=frames frames. ! queue max-size-buffers=2 max-size-bytes=0 max-size-time=0 "
           << "! " << copier->reduce << " ! " << copier->memory << ",width=" << std::max(width, 1)
           << ",height=" << height << " ! " << copier->download
           << " name=small  fakesink name=end sync=false async=false";
  GstElement* const bin = gst_parse_bin_from_description(elements.str().c_str(), FALSE, nullptr);
  if (!bin) return nullptr;
  // Otherwise the player would take the bin for a sink, and send seeks to it.
  gst_bin_set_suppressed_flags(GST_BIN(bin), GST_ELEMENT_FLAG_SINK);
  const auto part = [bin](const char* name) {
    return Ref<GstElement>(gst_bin_get_by_name(GST_BIN(bin), name));
  };
  const Ref<GstElement> frames = part("frames"), small = part("small"), end = part("end");
  gst_bin_add(GST_BIN(bin), motion);
  gst_element_link_many(small.get(), motion, end.get(), nullptr);
  const Ref<GstPad> in(gst_element_get_static_pad(frames.get(), "sink"));
  const Ref<GstPad> out(gst_element_request_pad_simple(frames.get(), "src_%u"));
  gst_element_add_pad(bin, gst_ghost_pad_new("sink", in.get()));
  gst_element_add_pad(bin, gst_ghost_pad_new("src", out.get()));
  return bin;
}

}  // namespace spidar
