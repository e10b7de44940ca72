// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <memory>
#include <string>

#include <gst/gst.h>

namespace spidar {

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
  void operator()(GstBuffer* buffer) const { gst_buffer_unref(buffer); }
  void operator()(GstCaps* caps) const { gst_caps_unref(caps); }
  void operator()(GstEvent* event) const { gst_event_unref(event); }
  void operator()(GstQuery* query) const { gst_query_unref(query); }
  void operator()(GArray* array) const { g_array_unref(array); }
  void operator()(GVariant* value) const { g_variant_unref(value); }
};

/// A reference to a GObject, or to one of the types above, or none, with automatic release. The
/// constructor takes over the reference of a pointer: `const Ref<GstPad>
/// pad(gst_element_get_static_pad(…))`.
template <typename Object>
using Ref = std::unique_ptr<Object, Unref>;

/// Takes another reference to `object`, which may be null.
template <typename Object>
Ref<Object> new_ref(Object* object) {
  return Ref<Object>(object ? static_cast<Object*>(g_object_ref(object)) : nullptr);
}

/// Copies a text and frees it; empty for null.
inline std::string taken(gchar* text) {
  std::string copy = text ? text : "";
  g_free(text);
  return copy;
}

/// Takes ownership of a new object by sinking its floating reference.
template <typename Object>
Ref<Object> sunk(Object* object) {
  return Ref<Object>(object ? static_cast<Object*>(g_object_ref_sink(object)) : nullptr);
}

}  // namespace spidar
