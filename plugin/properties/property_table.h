// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstring>
#include <functional>
#include <initializer_list>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <gst/gst.h>

namespace spidar {

constexpr auto kReadOnly = static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS);
/// Can be changed in NULL only, because the element reads such a property when it starts.
constexpr auto kNull = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS);
/// Can be changed in READY and below.
constexpr auto kReady =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);
/// Can be changed while playing.
constexpr auto kPlaying = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                   GST_PARAM_MUTABLE_PLAYING);
/// Can be changed while playing, and controlled by a GstController.
constexpr auto kControllable = static_cast<GParamFlags>(kPlaying | GST_PARAM_CONTROLLABLE);

/// Marks the properties that change the force of a film's frames, and with it a haptic track. The
/// others concern a device, a viewer or a pipeline.
inline GQuark analysis_mark() {
  return g_quark_from_static_string("spidar-analysis");
}

/// A function that returns the member of the settings in which a property is stored:
/// KEPT_IN(analyzer.axes.depth).
#define KEPT_IN(member)         \
  [](auto& settings) -> auto& { \
    return settings.member;     \
  }

template <typename Enum>
struct Choice {
  Enum value;
  const char* meaning;
  const char* nick;
};

/// Returns the type `name`, which the first call registers; several elements may share it. Only for
/// class initialisation, which GLib runs in one thread at a time.
template <typename Enum>
GType enum_type(const char* name, const std::vector<Choice<Enum>>& choices) {
  if (const GType type = g_type_from_name(name)) return type;
  auto* const values = g_new0(GEnumValue, choices.size() + 1);  // the type refers to them
  for (size_t i = 0; i < choices.size(); ++i) {
    values[i] = {static_cast<int>(choices[i].value), choices[i].meaning, choices[i].nick};
  }
  const GType type = g_enum_register_static(name, values);
  gst_type_mark_as_plugin_api(type, GST_PLUGIN_API_FLAG_IGNORE_ENUM_MEMBERS);
  return type;
}

/// The names of a property in its GParamSpec, which does not copy them.
struct PropertyNames {
  const char* name;
  const char* nick;
  const char* blurb;
};

/// A property of an element. `Settings` stores all properties; a new one has the defaults.
template <typename Settings>
struct Property {
  std::function<GParamSpec*(const Settings& defaults)> spec;
  /// Both are empty for a property that is not stored in the settings.
  std::function<void(Settings&, const GValue*)> set;
  std::function<void(const Settings&, GValue*)> get;

  template <typename Field>
  static Property on_off(PropertyNames n, GParamFlags flags, Field field) {
    return {[=](const Settings& defaults) {
              return g_param_spec_boolean(n.name, n.nick, n.blurb, field(defaults), flags);
            },
            [=](Settings& s, const GValue* v) { field(s) = g_value_get_boolean(v) != FALSE; },
            [=](const Settings& s, GValue* v) { g_value_set_boolean(v, field(s)); }};
  }

  template <typename Field>
  static Property number(PropertyNames n, double least, double most, GParamFlags flags,
                         Field field) {
    return {[=](const Settings& defaults) {
              return g_param_spec_double(n.name, n.nick, n.blurb, least, most, field(defaults),
                                         flags);
            },
            [=](Settings& s, const GValue* v) { field(s) = g_value_get_double(v); },
            [=](const Settings& s, GValue* v) { g_value_set_double(v, field(s)); }};
  }

  /// A time in ns that may be negative.
  template <typename Field>
  static Property offset(PropertyNames n, gint64 least, gint64 most, GParamFlags flags,
                         Field field) {
    return {[=](const Settings& defaults) {
              return g_param_spec_int64(n.name, n.nick, n.blurb, least, most, field(defaults),
                                        flags);
            },
            [=](Settings& s, const GValue* v) { field(s) = g_value_get_int64(v); },
            [=](const Settings& s, GValue* v) { g_value_set_int64(v, field(s)); }};
  }

  /// A time in ns, of any length.
  template <typename Field>
  static Property duration(PropertyNames n, GParamFlags flags, Field field) {
    return {[=](const Settings& defaults) {
              return g_param_spec_uint64(n.name, n.nick, n.blurb, 0, G_MAXUINT64, field(defaults),
                                         flags);
            },
            [=](Settings& s, const GValue* v) { field(s) = g_value_get_uint64(v); },
            [=](const Settings& s, GValue* v) { g_value_set_uint64(v, field(s)); }};
  }

  /// One of `choices`, whose type is registered as `type_name`.
  template <typename Enum, typename Field>
  static Property choice(PropertyNames n, const char* type_name,
                         const std::vector<Choice<Enum>>& choices, GParamFlags flags, Field field) {
    return {
        [=](const Settings& defaults) {
          return g_param_spec_enum(n.name, n.nick, n.blurb, enum_type(type_name, choices),
                                   static_cast<int>(field(defaults)), flags);
        },
        [=](Settings& s, const GValue* v) { field(s) = static_cast<Enum>(g_value_get_enum(v)); },
        [=](const Settings& s, GValue* v) { g_value_set_enum(v, static_cast<int>(field(s))); }};
  }

  /// A text. The element stores NULL as an empty text, and returns NULL for it.
  template <typename Field>
  static Property text(PropertyNames n, GParamFlags flags, Field field) {
    const auto or_null = [](const std::string& s) { return s.empty() ? nullptr : s.c_str(); };
    return {[=](const Settings& defaults) {
              return g_param_spec_string(n.name, n.nick, n.blurb, or_null(field(defaults)), flags);
            },
            [=](Settings& s, const GValue* v) {
              const char* const value = g_value_get_string(v);
              field(s) = value ? value : "";
            },
            [=](const Settings& s, GValue* v) { g_value_set_string(v, or_null(field(s))); }};
  }

  /// A structure that the element makes on request.
  static Property statistics(PropertyNames n) {
    return {[=](const Settings&) {
              return g_param_spec_boxed(n.name, n.nick, n.blurb, GST_TYPE_STRUCTURE, kReadOnly);
            },
            {},
            {}};
  }
};

/// All properties of an element, in the order in which tools show them.
template <typename Settings>
class PropertyTable {
 public:
  PropertyTable(std::initializer_list<std::vector<Property<Settings>>> parts) {
    for (const std::vector<Property<Settings>>& part : parts) {
      rows_.insert(rows_.end(), part.begin(), part.end());
    }
  }

  /// For class initialisation. The id of a property is its position in the table, counted from 1.
  void install(GObjectClass* object_class) const {
    const Settings defaults;
    guint id = 0;
    for (const Property<Settings>& row : rows_) {
      g_object_class_install_property(object_class, ++id, row.spec(defaults));
    }
  }

  /// set() and get() return false for an id whose property is not stored in the settings, and for
  /// an unknown id.
  bool set(Settings& settings, guint id, const GValue* value) const {
    if (id < 1 || id > rows_.size() || !rows_[id - 1].set) return false;
    rows_[id - 1].set(settings, value);
    return true;
  }
  bool get(const Settings& settings, guint id, GValue* value) const {
    if (id < 1 || id > rows_.size() || !rows_[id - 1].get) return false;
    rows_[id - 1].get(settings, value);
    return true;
  }

 private:
  std::vector<Property<Settings>> rows_;
};

/// What to do when a property has changed, for parts of the element that do not read the settings.
template <typename Element>
struct PropertyEffect {
  const char* property;
  void (*follow)(Element*, const GValue*);
};

template <typename Element, size_t kCount>
void follow_property(const PropertyEffect<Element> (&effects)[kCount], Element* element,
                     const GParamSpec* spec, const GValue* value) {
  for (const PropertyEffect<Element>& effect : effects) {
    if (std::strcmp(effect.property, spec->name) == 0) effect.follow(element, value);
  }
}

/// Whether the state of the element no longer allows a change. The caller holds the object lock.
bool is_too_late(GstElement* element, const GParamSpec* spec);
/// Posts a warning that the property keeps its value because the change came too late.
void warn_of_late(GstElement* element, const GParamSpec* spec);

/// Implements GObjectClass::set_property. `element->state` has `settings`, which the object lock
/// protects, and the mutex `setting`, which keeps the effects of several calls in the order of the
/// calls. A change that comes too late is refused with a warning.
template <typename Settings, typename Element, size_t kCount>
void set_property(const PropertyTable<Settings>& table, Element* element,
                  const PropertyEffect<Element> (&effects)[kCount], guint id, const GValue* value,
                  GParamSpec* spec) {
  g_auto(GValue) before = G_VALUE_INIT;
  g_value_init(&before, G_PARAM_SPEC_VALUE_TYPE(spec));
  std::unique_lock<std::mutex> in_order(element->state->setting);
  GST_OBJECT_LOCK(element);
  const bool late = is_too_late(GST_ELEMENT(element), spec);
  const bool known = late ? table.get(element->state->settings, id, &before)
                          : table.set(element->state->settings, id, value);
  GST_OBJECT_UNLOCK(element);
  if (!known) G_OBJECT_WARN_INVALID_PROPERTY_ID(element, id, spec);
  if (!late) follow_property(effects, element, spec, value);
  in_order.unlock();
  if (late && g_param_values_cmp(spec, &before, value) != 0) {
    warn_of_late(GST_ELEMENT(element), spec);
  }
}

/// Implements GObjectClass::get_property. `stats` makes the structure of a statistics property.
template <typename Settings, typename Element>
void get_property(const PropertyTable<Settings>& table, Element* element,
                  GstStructure* (*stats)(Element*), guint id, GValue* value, GParamSpec* spec) {
  if (G_PARAM_SPEC_VALUE_TYPE(spec) == GST_TYPE_STRUCTURE) {
    g_value_take_boxed(value, stats(element));
    return;
  }
  GST_OBJECT_LOCK(element);
  const bool known = table.get(element->state->settings, id, value);
  GST_OBJECT_UNLOCK(element);
  if (!known) G_OBJECT_WARN_INVALID_PROPERTY_ID(element, id, spec);
}

}  // namespace spidar
