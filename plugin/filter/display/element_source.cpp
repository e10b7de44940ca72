// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/display/element_source.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "plugin/filter/choice/feel_file.h"
#include "plugin/gobject/category.h"
#include "plugin/gobject/ref.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(held.get())

namespace spidar::filter {
namespace {

/// Returns a strong reference, null if the element is gone. Do not keep it while drawing.
Ref<GstElement> hold(GWeakRef& weak) {
  return Ref<GstElement>(static_cast<GstElement*>(g_weak_ref_get(&weak)));
}

std::vector<window::Setting::Choice> choices_of(const GParamSpecEnum* spec) {
  std::vector<window::Setting::Choice> choices;
  for (guint i = 0; i < spec->enum_class->n_values; ++i) {
    const GEnumValue& value = spec->enum_class->values[i];
    choices.push_back({value.value, value.value_nick});
  }
  return choices;
}

double number_of(const GValue* value) {
  if (G_VALUE_HOLDS_BOOLEAN(value)) return g_value_get_boolean(value) ? 1 : 0;
  if (G_VALUE_HOLDS_ENUM(value)) return g_value_get_enum(value);
  g_auto(GValue) number = G_VALUE_INIT;
  g_value_init(&number, G_TYPE_DOUBLE);
  return g_value_transform(value, &number) ? g_value_get_double(&number) : 0;
}

/// Returns false for a property that the element inherits, that cannot be changed while playing, or
/// that is not a number.
bool describe(GstElement* element, const GParamSpec* spec, window::Setting& setting) {
  if (spec->owner_type != G_OBJECT_TYPE(element)) return false;
  if ((spec->flags & GST_PARAM_MUTABLE_PLAYING) == 0) return false;
  if ((spec->flags & G_PARAM_READWRITE) != G_PARAM_READWRITE) return false;
  setting.name = g_param_spec_get_name(const_cast<GParamSpec*>(spec));
  setting.help = g_param_spec_get_blurb(const_cast<GParamSpec*>(spec));
  if (G_IS_PARAM_SPEC_BOOLEAN(spec)) {
    setting.kind = window::Setting::Kind::kSwitch;
    setting.high = 1;
  } else if (G_IS_PARAM_SPEC_ENUM(spec)) {
    setting.kind = window::Setting::Kind::kChoice;
    setting.choices = choices_of(G_PARAM_SPEC_ENUM(spec));
  } else if (G_IS_PARAM_SPEC_DOUBLE(spec)) {
    setting.kind = window::Setting::Kind::kNumber;
    setting.low = G_PARAM_SPEC_DOUBLE(spec)->minimum;
    setting.high = G_PARAM_SPEC_DOUBLE(spec)->maximum;
    setting.usual = G_PARAM_SPEC_DOUBLE(spec)->default_value;
  } else if (G_IS_PARAM_SPEC_INT64(spec)) {
    setting.kind = window::Setting::Kind::kWhole;
    setting.low = static_cast<double>(G_PARAM_SPEC_INT64(spec)->minimum);
    setting.high = static_cast<double>(G_PARAM_SPEC_INT64(spec)->maximum);
  } else {
    return false;
  }
  return true;
}

/// Returns false for properties that serve programs, and for the one that closes the window.
bool is_offered(const std::string& setting) {
  constexpr std::array<const char*, 4> kOfPrograms{"debug-window", "post-messages", "attach-meta",
                                                   "on-device-error"};
  return std::find(kOfPrograms.begin(), kOfPrograms.end(), setting) == kOfPrograms.end();
}

double get_value(GObject* object, const window::Setting& setting) {
  g_auto(GValue) value = G_VALUE_INIT;
  g_object_get_property(object, setting.name.c_str(), &value);
  return number_of(&value);
}

class ElementSource final : public window::Source {
 public:
  ElementSource(GstElement* element, HapticOutput& output, const NoForceWatch& no_force,
                MotionChoice& choice, UnreadMessages& unread)
      : output_(output), no_force_(no_force), choice_(choice), unread_(unread) {
    g_weak_ref_init(&element_, element);
  }
  ~ElementSource() override { g_weak_ref_clear(&element_); }

  void read(window::ElementState& state) override {
    const Ref<GstElement> held = hold(element_);
    if (!held) return;
    state = {};
    state.name = GST_OBJECT_NAME(held.get());
    state.is_playing = GST_STATE(held.get()) == GST_STATE_PLAYING;
    if (settings_.empty()) {
      list_settings(held.get(), settings_);
      list_presets(held.get(), presets_);
    }
    state.settings = settings_;
    state.presets = presets_;
    for (window::Setting& setting : state.settings) {
      setting.value = get_value(G_OBJECT(held.get()), setting);
    }
    state.rules = choice_.rules();
    const NoForceReason reason = no_force_.first(output_.snapshot());
    state.has_ended = reason == NoForceReason::kEnded;
    state.no_force = sentence_in_window(reason, state.is_playing);
    DeviceView device;
    if (output_.read_device(device)) state.device = std::move(device);
  }

  void set(const std::string& name, double wanted) override {
    const Ref<GstElement> held = hold(element_);
    if (!held) return;
    const GParamSpec* spec =
        g_object_class_find_property(G_OBJECT_GET_CLASS(held.get()), name.c_str());
    window::Setting setting;
    if (!spec || !describe(held.get(), spec, setting)) return;
    const bool is_choice = setting.kind == window::Setting::Kind::kChoice;
    const auto is_one = [&](const auto& choice) { return choice.value == wanted; };
    const auto& choices = setting.choices;
    if (is_choice && std::none_of(choices.begin(), choices.end(), is_one)) return;
    const double value = is_choice ? wanted : std::clamp(wanted, setting.low, setting.high);
    const char* property = setting.name.c_str();
    switch (G_PARAM_SPEC_VALUE_TYPE(spec)) {
      case G_TYPE_DOUBLE:
        g_object_set(held.get(), property, value, nullptr);
        break;
      case G_TYPE_INT64:
        g_object_set(held.get(), property, static_cast<gint64>(std::llround(value)), nullptr);
        break;
      default:  // booleans, enumerations, and unsigned numbers in the range of an int
        g_object_set(held.get(), property, static_cast<gint>(std::lround(value)), nullptr);
    }
  }

  void load_preset(const std::string& name) override {
    const Ref<GstElement> held = hold(element_);
    if (held) gst_preset_load_preset(GST_PRESET(held.get()), name.c_str());
  }

  void lead_hand(const std::optional<Eigen::Vector3d>& to_m) override {
    const Ref<GstElement> held = hold(element_);
    if (!held) return;
    output_.lead_hand(to_m);
  }

  void choose(const std::optional<Eigen::Vector2d>& position) override {
    const Ref<GstElement> held = hold(element_);
    if (held) choice_.mouse().keep(position);
  }

  window::ChoicesSaved save(const std::string& film, const std::vector<FeelEdit>& edits) override {
    const Ref<GstElement> held = hold(element_);
    if (!held) return {false, "Not saved: the element is gone."};
    gchar* property = nullptr;
    g_object_get(held.get(), "feel", &property, nullptr);
    const std::string feel = taken(property);
    try {
      std::string done = save_feel(feel, film, edits);
      if (!feel.empty() && feel != "auto" && !is_feel_file(feel)) done += " feel=auto reads it.";
      // Setting the property makes the element read the file again.
      g_object_set(held.get(), "feel", feel.empty() ? "auto" : feel.c_str(), nullptr);
      return {true, done};
    } catch (const std::runtime_error& error) {
      // A small window has no space for the folder.
      std::string why = error.what();
      const std::string folder = film.substr(0, film.rfind('/') + 1);
      if (!folder.empty() && why.rfind(folder, 0) == 0) why.erase(0, folder.size());
      return {false, "Not saved: " + why + "."};
    }
  }

  /// Only the application may change the state of its pipeline.
  void play(bool plays) override {
    const Ref<GstElement> held = hold(element_);
    if (!held) return;
    unread_.post(held.get(), [&] {
      return gst_message_new_request_state(GST_OBJECT(held.get()),
                                           plays ? GST_STATE_PLAYING : GST_STATE_PAUSED);
    });
  }

  /// Sends a seek upstream, as a sink does, so that the demuxer seeks in all streams. Uses a thread
  /// of GStreamer, because a seek may take long and waits for a state change, which may wait for
  /// the thread of the window. Of several pending seeks, only the last is executed.
  void seek(int64_t to_ns) override {
    const Ref<GstElement> held = hold(element_);
    if (!held || sought_ns_->exchange(to_ns) != kNone_ns) return;
    using Sought = std::shared_ptr<std::atomic<int64_t>>;
    gst_element_call_async(
        held.get(),
        [](GstElement* element, gpointer sought) {
          const auto flags =
              static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_KEY_UNIT);
          gst_element_seek_simple(element, GST_FORMAT_TIME, flags,
                                  (*static_cast<Sought*>(sought))->exchange(kNone_ns));
        },
        new Sought(sought_ns_), [](gpointer sought) { delete static_cast<Sought*>(sought); });
  }

  void warn(const std::string& what, const std::string& advice) override {
    const Ref<GstElement> held = hold(element_);
    if (!held) return;
    GST_ELEMENT_WARNING(held.get(), RESOURCE, NOT_FOUND, ("%s", what.c_str()),
                        ("%s The video continues without it.", advice.c_str()));
  }

  void closed() override {
    const Ref<GstElement> held = hold(element_);
    if (held) g_object_set(held.get(), "debug-window", FALSE, nullptr);
  }

 private:
  static constexpr int64_t kNone_ns = -1;

  static void list_settings(GstElement* element, std::vector<window::Setting>& settings) {
    guint count = 0;
    g_autofree GParamSpec** specs =
        g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
    for (guint i = 0; i < count; ++i) {
      window::Setting setting;
      if (describe(element, specs[i], setting) && is_offered(setting.name)) {
        settings.push_back(std::move(setting));
      }
    }
  }

  static void list_presets(GstElement* element, std::vector<std::string>& presets) {
    g_auto(GStrv) names = gst_preset_get_preset_names(GST_PRESET(element));
    for (gchar** name = names; name && *name; ++name) presets.emplace_back(*name);
  }

  GWeakRef element_;
  // Valid only while the element is held.
  HapticOutput& output_;
  const NoForceWatch& no_force_;
  MotionChoice& choice_;
  UnreadMessages& unread_;
  std::vector<window::Setting> settings_;  ///< without their values
  std::vector<std::string> presets_;
  const std::shared_ptr<std::atomic<int64_t>> sought_ns_ =
      std::make_shared<std::atomic<int64_t>>(kNone_ns);  ///< the target until the seek begins
};

}  // namespace

std::shared_ptr<window::Source> make_element_source(GstElement* element, HapticOutput& output,
                                                    const NoForceWatch& no_force,
                                                    MotionChoice& choice, UnreadMessages& unread) {
  return std::make_shared<ElementSource>(element, output, no_force, choice, unread);
}

}  // namespace spidar::filter
