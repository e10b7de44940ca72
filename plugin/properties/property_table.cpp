// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/property_table.h"

#include "plugin/gobject/category.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element)

namespace spidar {

bool is_too_late(GstElement* element, const GParamSpec* spec) {
  if (spec->flags & GST_PARAM_MUTABLE_PLAYING) return false;
  const GstState last = spec->flags & GST_PARAM_MUTABLE_READY ? GST_STATE_READY : GST_STATE_NULL;
  return GST_STATE(element) > last || GST_STATE_NEXT(element) > last;
}

void warn_of_late(GstElement* element, const GParamSpec* spec) {
  const bool is_ready = spec->flags & GST_PARAM_MUTABLE_READY;
  GST_ELEMENT_WARNING(element, RESOURCE, SETTINGS,
                      ("%s is set too late, and stays as it was: it can be changed in %s only.",
                       spec->name, is_ready ? "NULL and READY" : "NULL"),
                      ("The element has read it already."));
}

}  // namespace spidar
