// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/programs/typed_property.h"

#include <locale>
#include <sstream>
#include <vector>

#include "core/number_text.h"
#include "plugin/gobject/ref.h"
#include "spidar/text.h"

namespace spidar {
namespace {

constexpr int kDigits = 15;  // decimal digits that every double keeps

template <typename Number>
std::string range(const char* kind, Number least, Number most) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(kDigits);
  text << kind << " from " << least << " to " << most;
  return text.str();
}

std::string one_of(GEnumClass* known) {
  std::string names;
  for (guint i = 0; i < known->n_values; ++i) {
    names += (i == 0 ? "" : ", ") + std::string(known->values[i].value_nick);
  }
  return "one of " + names;
}

std::string values_of(GParamSpec* property) {
  if (G_IS_PARAM_SPEC_DOUBLE(property)) {
    const GParamSpecDouble* spec = G_PARAM_SPEC_DOUBLE(property);
    return range("a number", spec->minimum, spec->maximum);
  }
  if (G_IS_PARAM_SPEC_INT64(property)) {
    const GParamSpecInt64* spec = G_PARAM_SPEC_INT64(property);
    return range("a whole number", spec->minimum, spec->maximum);
  }
  if (G_IS_PARAM_SPEC_ENUM(property)) return one_of(G_PARAM_SPEC_ENUM(property)->enum_class);
  if (G_IS_PARAM_SPEC_BOOLEAN(property)) return "true or false";
  if (G_IS_PARAM_SPEC_STRING(property)) return "a text";
  return "one of those that gst-inspect-1.0 spidarmotion lists";
}

/// Returns the description of a numeric property, which contains its unit.
std::string unit(GParamSpec* property) {
  const GType type = G_PARAM_SPEC_VALUE_TYPE(property);
  const bool number = type == G_TYPE_DOUBLE || type == G_TYPE_INT64;
  const char* blurb = number ? g_param_spec_get_blurb(property) : nullptr;
  return blurb ? std::string(". ") + blurb : std::string();
}

std::vector<std::string> names_of_properties(GObject* element) {
  guint count = 0;
  g_autofree GParamSpec** all = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
  std::vector<std::string> names;
  for (guint i = 0; i < count; ++i) {
    if (all[i]->flags & G_PARAM_WRITABLE) names.emplace_back(all[i]->name);
  }
  return names;
}

}  // namespace

TypedProperty::TypedProperty(GObject* element, const std::string& text) {
  const size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  property_ = g_object_class_find_property(G_OBJECT_GET_CLASS(element), name.c_str());
  const bool is_property = property_ && (property_->flags & G_PARAM_WRITABLE);
  if (!is_property && equals == std::string::npos) {
    throw tools::UsageError(text + ": is not PROPERTY=VALUE, such as max-force=2");
  }
  if (!is_property) {
    throw tools::UsageError("spidarmotion has no property \"" + name + "\" that can be set" +
                            meant(name, names_of_properties(element)) +
                            "; gst-inspect-1.0 spidarmotion lists them");
  }
  if (equals == std::string::npos) {
    throw tools::UsageError(name + ": has no value; type " + name + "=VALUE, where VALUE is " +
                            values_of(property_) + unit(property_));
  }
  const std::string value = text.substr(equals + 1);
  if (value.find('\n') != std::string::npos) {
    throw tools::UsageError(name + ": a value is one line");
  }
  g_value_init(&value_, property_->value_type);
  const bool understood = gst_value_deserialize_with_pspec(&value_, value.c_str(), property_);
  // GLib clamps values that are out of range.
  if (understood && !g_param_value_validate(property_, &value_)) return;
  g_value_unset(&value_);
  throw tools::UsageError(name + ": \"" + value + "\" is not " + values_of(property_) +
                          unit(property_));
}

std::string TypedProperty::canonical_value() const {
  if (G_VALUE_HOLDS_DOUBLE(&value_)) {
    return std::string(NumberText(g_value_get_double(&value_)));
  }
  return taken(gst_value_serialize(&value_));
}

std::optional<std::string> preset_of(const std::string& text) {
  const std::string begin = "preset=";
  if (text.compare(0, begin.size(), begin) != 0) return std::nullopt;
  return text.substr(begin.size());
}

void set_typed(GstElement* element, const std::string& text) {
  if (const auto preset = preset_of(text)) return load_preset(element, *preset);
  const TypedProperty property(G_OBJECT(element), text);
  g_object_set_property(G_OBJECT(element), property.name().c_str(), property.value());
}

void load_preset(GstElement* element, const std::string& name) {
  if (gst_preset_load_preset(GST_PRESET(element), name.c_str())) return;
  g_auto(GStrv) names = gst_preset_get_preset_names(GST_PRESET(element));
  const std::string list = taken(names ? g_strjoinv(", ", names) : nullptr);
  throw tools::UsageError("there is no preset \"" + name + "\"; " +
                          (list.empty() ? "none is found: GST_PRESET_PATH names the folder of "
                                          "GstSpidarMotion.prs"
                                        : "known are " + list));
}

}  // namespace spidar
