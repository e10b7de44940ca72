// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An element as a window sees it.
#pragma once

#include <memory>

#include <gst/gst.h>

#include "plugin/filter/choice/motion_choice.h"
#include "plugin/frame/no_force_watch.h"
#include "plugin/output/haptic_output.h"
#include "plugin/window/window.h"

namespace spidar {

/// Keeps no reference: the element may go while the window is open. The others are those of
/// `element`, and live as long.
std::shared_ptr<WindowSource> make_element_source(GstElement* element, HapticOutput& output,
                                                  const NoForceWatch& no_force,
                                                  MotionChoice& choice);

}  // namespace spidar
