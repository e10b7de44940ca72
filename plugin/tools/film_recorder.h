// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Records the haptic track of one film.
#pragma once

#include <functional>
#include <string>

#include <gst/gst.h>

#include "plugin/tools/record_properties.h"
#include "plugin/track/part_file.h"
#include "plugin/track/track_notes.h"

namespace spidar {

/// Analyses `film` as fast as it can be decoded, writes its haptic track into `track`, whose format
/// follows from the end of the name that it will have (`encoder_of()`), and reads it back. `tell`
/// is called with the percentage that is done, in steps of ten, in another thread. Returns what is
/// to be known of the track; usually nothing. Throws std::runtime_error.
std::string record_film(const std::string& film, const PartFile& track,
                        const RecordProperties& properties,
                        const std::function<void(int percent)>& tell);

/// The part of a launch line behind spidarmotion that writes the file `track`, and what it needs
/// before it runs.
std::string sampling_elements(const std::string& track);
void take_samples(GstElement* pipeline, const std::string& track, const TrackNotes& notes);

}  // namespace spidar
