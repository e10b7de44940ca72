// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/films/video_choice.h"

#include "plugin/films/stream_content.h"
#include "plugin/gobject/ref.h"

namespace spidar {
namespace {

std::string id_of(GstPad* pad) {
  return taken(gst_pad_get_stream_id(pad));
}

/// 1 if the film marks the stream as default, −1 if it marks the stream as deselected, else 0.
int mark_of(GstPad* pad) {
  const Ref<GstEvent> start(gst_pad_get_sticky_event(pad, GST_EVENT_STREAM_START, 0));
  if (!start) return 0;
  auto flags = GST_STREAM_FLAG_NONE;
  gst_event_parse_stream_flags(start.get(), &flags);
  if ((flags & GST_STREAM_FLAG_SELECT) != 0) return 1;
  return (flags & GST_STREAM_FLAG_UNSELECT) != 0 ? -1 : 0;
}

}  // namespace

void VideoChoice::watch(GstElement* decoder) {
  g_signal_connect(decoder, "autoplug-continue", G_CALLBACK(may_continue), this);
}

gboolean VideoChoice::may_continue(GstElement*, GstPad* pad, GstCaps* caps, gpointer user) {
  auto& self = *static_cast<VideoChoice*>(user);
  if (!is_picture(caps)) return TRUE;
  const std::lock_guard<std::mutex> lock(self.mutex_);
  self.covers_.insert(id_of(pad));
  return TRUE;
}

int VideoChoice::rank(GstPad* pad) const {
  constexpr int kFilm = 10;  // above any mark
  return (covers_.count(id_of(pad)) > 0 ? 0 : kFilm) + (rule_ == Rule::kMarked ? mark_of(pad) : 0);
}

GstPad* VideoChoice::choose(GstElement* decoder) {
  const std::lock_guard<std::mutex> lock(mutex_);
  GstPad* chosen = nullptr;
  for (GList* i = decoder->srcpads; i; i = i->next) {
    auto* const pad = static_cast<GstPad*>(i->data);
    if (content_of(pad) != StreamContent::kVideo) continue;
    if (!chosen || rank(pad) > rank(chosen)) chosen = pad;
  }
  return chosen;
}

}  // namespace spidar
