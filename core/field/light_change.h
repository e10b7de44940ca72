// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Changes of the brightness of a whole picture, which are not motion.
#pragma once

#include "core/picture/padded_image.h"

namespace spidar {

/// When the brightness of the whole picture has changed (a flickering lamp, a fade, a shutter),
/// adapts the picture before to the new brightness, both `coarse_before`, in which it is seen in
/// comparison with `coarse_now`, and `before`. The change counts only if that makes the two
/// pictures more alike.
void compensate_light(PaddedImage& coarse_before, const PaddedImage& coarse_now,
                      PaddedImage& before);

}  // namespace spidar
