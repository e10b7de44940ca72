// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What streams a film consists of.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "plugin/track/film_streams.h"

namespace spidar {

struct FilmStream {
  std::string id;  ///< of its stream-start event, the same whenever the film is read
  StreamKind kind = StreamKind::kOther;
  std::shared_ptr<GstCaps> caps;  ///< as a parser gives them
  std::string orientation;        ///< GST_TAG_IMAGE_ORIENTATION; empty when the film has none
  bool has_cover = false;         ///< the film has cover art, GST_TAG_IMAGE
};

/// The streams of `film` that have anything in them, pictures first, then sound. Reads the whole
/// film, because a stream may begin at any time. Throws std::runtime_error when it cannot be read.
std::vector<FilmStream> list_streams(const std::string& film);

/// Of a pad of a parsebin; empty when it has none yet.
std::string stream_id(GstPad* pad);

}  // namespace spidar
