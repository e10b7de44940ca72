// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Records the haptic track of one film.
#pragma once

#include <functional>
#include <string>

#include "plugin/tools/record_properties.h"

namespace spidar {

/// Analyses `film` as fast as it can be decoded and writes its haptic track into the file `track`,
/// whose format follows from the end of its name (`encoder_of()`). `tell` is
/// called with the percentage that is done, in steps of ten, in another thread. Returns what is to
/// be known of the track; usually nothing. Throws std::runtime_error; what has been written of
/// `track` is left there.
std::string record_film(const std::string& film, const std::string& track,
                        const RecordProperties& properties,
                        const std::function<void(int percent)>& tell);

}  // namespace spidar
