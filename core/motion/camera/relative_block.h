// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A block compared with the background.
#pragma once

namespace spidar {

/// Properties of a block in addition to its motion. Lengths are in pixels of the field's picture.
struct RelativeBlock {
  float x_px = 0;  ///< motion relative to the background
  float y_px = 0;
  float background_x_px = 0;  ///< motion of the background at this place
  float background_y_px = 0;
  bool shows_motion = false;  ///< its texture, or its pixels, tell how it moves
  bool was_outside = false;   ///< most of it was outside of the film in the previous picture
  bool is_covered = false;    ///< something burned in hides the film here, see BurnedIn::covers()
  bool lasts = false;         ///< has stood out for so long that it moves without any neighbour
  float probability = 0;      ///< that it moves by itself; 0 where no network was asked
  bool moves = false;         ///< moves by itself, taking its neighbours into account
};

}  // namespace spidar
