// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Records the haptic track of one film.
#pragma once

#include <functional>
#include <string>

#include "plugin/tools/record_options.h"
#include "plugin/tracks/part_file.h"

namespace spidar {

struct FilmOutcome {
  std::string felt;    ///< how much of the film is felt, and why the rest is not
  std::string remark;  ///< what else is to be known of it; usually empty
};

/// Analyses `film` as fast as it can be decoded, writes its haptic track into `track`, whose format
/// follows from the end of the name that it will have (`encoder_of()`), and reads it back. `tell`
/// is called in another thread with the percentage that is done, whenever it rises. Throws
/// std::runtime_error.
FilmOutcome record_film(const std::string& film, const PartFile& track,
                        const RecordProperties& properties,
                        const std::function<void(int percent)>& tell);

}  // namespace spidar
