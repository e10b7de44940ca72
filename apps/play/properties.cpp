// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/play/properties.h"

#include <memory>
#include <sstream>
#include <stdexcept>

namespace {

using Pspecs = std::unique_ptr<GParamSpec*, decltype(&g_free)>;

/// The element's own properties, without those that every element has.
std::string own_properties(GstElement* element) {
  guint count = 0;
  const Pspecs pspecs(g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count), g_free);
  std::string names;
  for (guint i = 0; i < count; ++i) {
    const GParamSpec* const pspec = pspecs.get()[i];
    if (pspec->owner_type != G_OBJECT_TYPE(element) || !(pspec->flags & G_PARAM_WRITABLE)) continue;
    names += std::string(names.empty() ? "" : ", ") + pspec->name;
  }
  return names;
}

template <typename Pspec>
std::string range(const Pspec* pspec) {
  std::ostringstream text;
  text << pspec->minimum << " to " << pspec->maximum;
  return text.str();
}

std::string allowed_values(GParamSpec* pspec) {
  if (G_IS_PARAM_SPEC_BOOLEAN(pspec)) return "true or false";
  if (G_IS_PARAM_SPEC_ENUM(pspec)) {
    const GEnumClass* const values = G_PARAM_SPEC_ENUM(pspec)->enum_class;
    std::string nicks;
    for (guint i = 0; i < values->n_values; ++i) {
      nicks += std::string(i == 0 ? "" : ", ") + values->values[i].value_nick;
    }
    return nicks;
  }
  if (G_IS_PARAM_SPEC_INT(pspec)) return "a whole number, " + range(G_PARAM_SPEC_INT(pspec));
  if (G_IS_PARAM_SPEC_UINT(pspec)) return "a whole number, " + range(G_PARAM_SPEC_UINT(pspec));
  if (G_IS_PARAM_SPEC_INT64(pspec)) return "a whole number, " + range(G_PARAM_SPEC_INT64(pspec));
  if (G_IS_PARAM_SPEC_UINT64(pspec)) return "a whole number, " + range(G_PARAM_SPEC_UINT64(pspec));
  if (G_IS_PARAM_SPEC_FLOAT(pspec)) return "a number, " + range(G_PARAM_SPEC_FLOAT(pspec));
  if (G_IS_PARAM_SPEC_DOUBLE(pspec)) return "a number, " + range(G_PARAM_SPEC_DOUBLE(pspec));
  return g_type_name(pspec->value_type);
}

}  // namespace

void set_property(GstElement* element, const std::string& assignment) {
  const size_t equals = assignment.find('=');
  if (equals == 0 || equals == std::string::npos) {
    throw std::invalid_argument("'" + assignment +
                                "' sets no property: write name=value, as in controller=linear");
  }
  const std::string name = assignment.substr(0, equals);
  const std::string text = assignment.substr(equals + 1);

  GParamSpec* const pspec = g_object_class_find_property(G_OBJECT_GET_CLASS(element), name.c_str());
  if (pspec == nullptr || !(pspec->flags & G_PARAM_WRITABLE)) {
    throw std::invalid_argument(
        GST_OBJECT_NAME(gst_element_get_factory(element)) +
        std::string(pspec == nullptr ? " has no property '" : " has only for reading '") + name +
        "'; it has " + own_properties(element));
  }

  if (pspec->value_type == G_TYPE_STRING) {
    g_object_set(element, name.c_str(), text.c_str(), nullptr);
    return;
  }
  GValue value = G_VALUE_INIT;
  g_value_init(&value, pspec->value_type);
  // g_param_value_validate() clamps values that are out of range.
  const bool right = gst_value_deserialize_with_pspec(&value, text.c_str(), pspec) &&
                     !g_param_value_validate(pspec, &value);
  if (right) g_object_set_property(G_OBJECT(element), name.c_str(), &value);
  g_value_unset(&value);
  if (!right) {
    throw std::invalid_argument("'" + text + "' is no value for " + name + ": it takes " +
                                allowed_values(pspec));
  }
}
