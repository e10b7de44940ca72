// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an application can set of which motion is felt, and how.
#pragma once

#include <gst/gst.h>

#include "plugin/properties/motion_properties.h"

namespace spidar {

/// From kPropController to kPropFilterBeta.
void install_feel_properties(GObjectClass* object_class);

/// False for an id that is none of these.
bool set_feel_property(MotionProperties& properties, guint id, const GValue* value);
bool get_feel_property(const MotionProperties& properties, guint id, GValue* value);

}  // namespace spidar
