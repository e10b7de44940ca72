// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a grip renders, in words.
#pragma once

#include <string>

#include "spidar/grip/grip.h"

namespace spidar {

/// "force to the sides, up and down, up to 3 N, no torque"
std::string rendered_text(const GripAbilities& can);

}  // namespace spidar
