// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Records the haptic track of one film.
#pragma once

#include <functional>
#include <string>

namespace spidar {

/// Analyses `film` as fast as it can be decoded and writes its haptic track into the file `track`,
/// whose format follows from the end of its name (`encoder_of()`). `properties` are those of
/// spidarmotion: " motion=camera …", empty, or beginning with a space. `tell` is called with the
/// percentage that is done, in steps of ten, in another thread. Throws std::runtime_error; what has
/// been written of `track` is left there.
void record_film(const std::string& film, const std::string& track, const std::string& properties,
                 const std::function<void(int percent)>& tell);

}  // namespace spidar
