// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/follow_state.h"

namespace spidar {

GstState state_of(GstElement* element) {
  GST_OBJECT_LOCK(element);
  const GstState pending = GST_STATE_PENDING(element);
  const GstState state = pending == GST_STATE_VOID_PENDING ? GST_STATE(element) : pending;
  GST_OBJECT_UNLOCK(element);
  return state;
}

void follow_state(GstElement* bin, GstElement* element) {
  GstState state;
  do {
    state = state_of(bin);
    gst_element_set_state(element, state);
  } while (state != state_of(bin));
}

}  // namespace spidar
