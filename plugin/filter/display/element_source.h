// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <memory>
#include <string>

#include <gst/gst.h>

#include "plugin/device/haptic_output.h"
#include "plugin/filter/choice/motion_choice.h"
#include "plugin/gobject/unread_messages.h"
#include "plugin/reasons/no_force.h"
#include "plugin/window/window.h"

namespace spidar::filter {

/// Returns why nothing is felt, for a window, which knows whether the film is paused: in a pause,
/// no frame came in the last second, whatever is in the film.
inline std::string sentence_in_window(NoForceReason reason, bool is_playing) {
  if (!is_playing && reason != NoForceReason::kEnded) return "The video is paused.";
  if (reason == NoForceReason::kNotPlaying) {
    return "The video is seeking, or its clock stands still.";
  }
  return sentence(reason);
}

/// Returns an element as a window sees it, without a reference: the element may be destroyed while
/// the window is open. The other arguments belong to `element` and live as long.
std::shared_ptr<window::Source> make_element_source(GstElement* element, HapticOutput& output,
                                                    const NoForceWatch& no_force,
                                                    MotionChoice& choice, UnreadMessages& unread);

}  // namespace spidar::filter
