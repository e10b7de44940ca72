// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Records the haptic track of one film.
#pragma once

#include <functional>
#include <string>

#include "plugin/tools/film_decoder.h"
#include "plugin/tools/record_properties.h"
#include "plugin/tracks/part_file.h"

namespace spidar {

/// Analyses `film` as fast as it can be decoded, writes its haptic track into `track`, whose format
/// follows from the end of the name that it will have (`encoder_of()`), and reads it back. `tell`
/// is called in another thread with the percentage that is done, whenever it rises. Throws
/// std::runtime_error.
FilmOutcome record_film(const std::string& film, const PartFile& track,
                        const RecordProperties& properties,
                        const std::function<void(int percent)>& tell);

}  // namespace spidar
