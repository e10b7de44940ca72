// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <gst/gst.h>

namespace spidar {

/// Gives the element the pad that the template describes and returns it. The element keeps it.
inline GstPad* add_pad(GstElement* element, GstStaticPadTemplate* pad_template) {
  GstPad* pad = gst_pad_new_from_static_template(pad_template, pad_template->name_template);
  gst_element_add_pad(element, pad);
  return pad;
}

}  // namespace spidar
