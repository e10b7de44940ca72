// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A film with a haptic track in it.
#pragma once

#include <cstdint>
#include <string>

namespace spidar {

/// Writes the streams of `film`, none of them decoded, and the sound of the file `track`, which
/// lasts `track_ns`, into the Matroska file `out`. Throws std::runtime_error, which says what would
/// be right, when the film has no sound, has a haptic track already, is another one than that of
/// the track, or has a stream that Matroska does not take. `out` is then not complete.
void merge_film(const std::string& film, const std::string& track, int64_t track_ns,
                const std::string& out);

}  // namespace spidar
