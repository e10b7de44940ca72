// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The orientation in which the frames of a stream are shown, from its tags.
#pragma once

#include <optional>

#include <gst/gst.h>

#include "core/picture_turn.h"

namespace spidar {

/// Follows the tag `image-orientation` by the rules of videoflip: the tag of the stream counts, and
/// that of the whole film where the stream has none.
class StreamOrientation {
 public:
  /// Another stream begins, whose tags are not known yet.
  void begin_stream() { *this = {}; }
  void take(const GstTagList* tags);
  PictureTurn turn() const { return of_stream_.value_or(of_film_.value_or(PictureTurn())); }

 private:
  std::optional<PictureTurn> of_stream_, of_film_;
};

/// Whether an element before `sink` turns the picture by the tag. The videoflip of GStreamer 1.22
/// passes the tag on all the same, where newer ones replace it by "rotate-0".
bool follows_tag_upstream(GstPad* sink);

}  // namespace spidar
