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

/// Returns why nothing is felt, for display in a window. In a pause, `reason` only says that no
/// frame came in the last second, so the sentence names the pause instead.
inline std::string sentence_in_window(NoForceReason reason, bool is_playing) {
  if (!is_playing && reason != NoForceReason::kEnded) return "The video is paused.";
  if (reason == NoForceReason::kNotPlaying) {
    return "The video is seeking, or its clock stands still.";
  }
  return sentence(reason);
}

/// Returns `element` as a source of the debug window. The source holds only a weak reference: the
/// element may be destroyed first. The other arguments belong to `element` and live as long.
std::shared_ptr<window::Source> make_element_source(GstElement* element, HapticOutput& output,
                                                    const NoForceWatch& no_force,
                                                    MotionChoice& choice, UnreadMessages& unread);

}  // namespace spidar::filter
