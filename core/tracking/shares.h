// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What counts as most of a whole, as nearly all of it, as confirmed, and as lasting.
#pragma once

namespace spidar {

constexpr double kMost = 0.5;
constexpr double kNearlyAll = 0.8;
/// What a single block, frame or picture shows is more often an error than what so many show.
constexpr int kConfirmed = 2;
/// What shows in so many pictures, or pairs of them, is no error: in one or two, an object may look
/// like a bar, and a layer like an object.
constexpr int kLastingPictures = 3;

}  // namespace spidar
