// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/view/messages.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/touch/height_field.h"

namespace spidar::window {

/// Writes values, or reads what was written. A structure is passed by one function, `template
/// <typename Wire> void transfer(Wire&, T&)`, which calls wire(…) for each of its members. Writing
/// does not change it.
///
/// Reading survives all other bytes: once a value does not fit into what is left or into its own
/// range, ok() is false, and the values are of no use.
template <bool kIsReader>
class Wire {
 public:
  static constexpr bool kReads = kIsReader;

  Wire() = default;
  Wire(const uint8_t* bytes, size_t count) : next_(bytes), left_(count) {}

  template <typename... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }
  /// `last`: the largest value of the enumeration.
  template <typename Enum>
  void choice(Enum& value, Enum last) {
    auto number = static_cast<int32_t>(value);
    one(number);
    if (number < 0 || number > static_cast<int32_t>(last)) return fail();
    if constexpr (kReads) value = static_cast<Enum>(number);
  }
  void fail() { ok_ = false; }
  bool ok() const { return ok_; }
  bool is_at_end() const { return left_ == 0; }
  std::vector<uint8_t>& bytes() { return written_; }

 private:
  bool has(size_t count) {
    if (count > left_) fail();
    return ok_;
  }
  void raw(void* bytes, size_t count) {
    if (count == 0) return;
    if constexpr (kReads) {
      if (!has(count)) return;
      std::memcpy(bytes, next_, count);
      next_ += count;
      left_ -= count;
    } else {
      const auto* const first = static_cast<const uint8_t*>(bytes);
      written_.insert(written_.end(), first, first + count);
    }
  }
  /// How many values follow. Each takes a byte or more, so that what is reserved when it is read is
  /// bounded by what was sent.
  size_t count_of(size_t size) {
    auto count = static_cast<uint32_t>(size);
    one(count);
    return kReads && !has(count) ? 0 : count;
  }
  void one(bool& value) {
    auto byte = static_cast<uint8_t>(value ? 1 : 0);
    one(byte);
    if (byte > 1) return fail();
    if constexpr (kReads) value = byte == 1;
  }
  void one(std::string& text) {
    const size_t count = count_of(text.size());
    if constexpr (kReads) text.resize(count);
    raw(text.data(), count);
  }
  /// A function of its own, or GCC 12 warns that a value that is not there may be used.
  template <typename Value>
  [[gnu::noinline]] void one(std::optional<Value>& value) {
    bool is_there = value.has_value();
    one(is_there);
    if (kReads) value.reset();
    if (!ok_ || !is_there) return;
    if (kReads) value.emplace();
    one(*value);
  }
  template <typename Value>
  void one(std::vector<Value>& values) {
    const size_t count = count_of(values.size());
    if (kReads) values.clear();
    for (size_t i = 0; i < count && ok_; ++i) {
      if (kReads) values.emplace_back();
      one(values[i]);
    }
  }
  template <int kRows, int kColumns, int kOptions>
  void one(Eigen::Matrix<double, kRows, kColumns, kOptions>& matrix) {
    raw(matrix.data(), sizeof(double) * static_cast<size_t>(matrix.size()));
  }
  template <typename Value>
  void one(Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      raw(&value, sizeof value);
    } else {
      transfer(*this, value);
    }
  }

  std::vector<uint8_t> written_;
  const uint8_t* next_ = nullptr;
  size_t left_ = 0;
  bool ok_ = true;
};

// Every structure that goes through the socket, member by member; see Wire.

template <typename Wire>
void transfer(Wire& wire, ImagePoint& point) {
  wire(point.x_px, point.y_px);
}

template <typename Wire>
void transfer(Wire& wire, PicturePart& part) {
  wire(part.x, part.y, part.width, part.height);
}

template <typename Wire>
void transfer(Wire& wire, FilmPlace& place) {
  wire(place.area, place.picture_width, place.picture_height);
}

template <typename Wire>
void transfer(Wire& wire, Wrench& wrench) {
  wire(wrench.force_N, wrench.torque_Nm);
}

/// As one of the eight ways in which a picture can be turned.
template <typename Wire>
void transfer(Wire& wire, Orientation& turn) {
  constexpr int kQuarters = 4;
  const auto way = [](int number) { return Orientation(number % kQuarters, number >= kQuarters); };
  const auto is_same = [&](const Orientation& other) {
    return other.to_displayed(Eigen::Vector2d(1, 2)) == turn.to_displayed(Eigen::Vector2d(1, 2));
  };
  int32_t number = 0;
  while (!Wire::kReads && number < 2 * kQuarters - 1 && !is_same(way(number))) ++number;
  wire(number);
  if (number < 0 || number >= 2 * kQuarters) return wire.fail();
  if constexpr (Wire::kReads) turn = way(number);
}

// --- the frame

template <typename Wire>
void transfer(Wire& wire, FrameStamp& stamp) {
  wire(stamp.epoch, stamp.stream_ns, stamp.running_ns, stamp.length_ns, stamp.rate);
}

template <typename Wire>
void transfer(Wire& wire, FilmScene& film) {
  std::string path = film.name();
  wire(path, film.begin_ns, film.length_ns);
  if constexpr (Wire::kReads) film.path = std::make_shared<const std::string>(std::move(path));
}

template <typename Wire>
void transfer(Wire& wire, OwnedPoint& point) {
  wire(point.id, point.from, point.to, point.object, point.is_new);
  wire.choice(point.owner, PointOwner::kObject);
}

template <typename Wire>
void transfer(Wire& wire, MovingObject& object) {
  wire(object.id, object.position_px, object.size_px, object.low_off_px, object.high_off_px,
       object.relative_px_s, object.on_screen_px_s, object.growth_1_s, object.roll_rad_s,
       object.points, object.error_px_s, object.area_px2, object.prominence);
}

template <typename Wire>
void transfer(Wire& wire, ControllerSettings& controller) {
  wire.choice(controller.law, ControlLaw::kAdaptive);
  wire(controller.max_force_N, controller.alpha_s_px);
}

template <typename Wire>
void transfer(Wire& wire, TouchScene& touch) {
  Eigen::Vector2d half_size_m = touch.pointer.half_size_m();
  Orientation turn = touch.pointer.turn();
  wire(touch.on, half_size_m, turn, touch.stiffness_N_m, touch.motion_fraction, touch.shading);
  if (!touch.shading.empty() && touch.shading.size() != touch::HeightField::kCells) {
    return wire.fail();
  }
  if constexpr (Wire::kReads) touch.pointer = {half_size_m, turn};
}

/// What is shown of it.
template <typename Wire>
void transfer(Wire& wire, DrawnFrame& report) {
  Frame& frame = report.frame;
  wire(frame.stamp, frame.place, frame.interval_ns, frame.objects, frame.wrench, frame.felt_object);
  wire(report.film, report.took_ns, report.visible, report.turn, report.points, report.lost,
       report.felt);
  wire.choice(report.motion, MotionKind::kCamera);
  wire(report.controller, report.speed_px_s, report.click, report.touch);
  std::string track = report.track ? *report.track : "";
  wire(track);
  if constexpr (Wire::kReads) {
    report.track = track.empty() ? nullptr : std::make_shared<const std::string>(std::move(track));
  }
}

// --- the element

template <typename Wire>
void transfer(Wire& wire, Pose& pose) {
  wire(pose.position_m, pose.orientation.coeffs());
}

template <typename Wire>
void transfer(Wire& wire, touch::Contact& contact) {
  wire(contact.has_surface, contact.touching, contact.depth_m, contact.proxy_m, contact.force_N);
}

/// Of a tick, what is drawn.
template <typename Wire>
void transfer(Wire& wire, TickRecord& tick) {
  wire(tick.monotonic_ns, tick.lateness_ns, tick.running_ns, tick.wanted, tick.delivered,
       tick.tension_N, tick.pose, tick.faulty_string, tick.playing, tick.max_force_N, tick.contact);
  wire.choice(tick.device, DeviceState::kLost);
}

template <typename Wire>
void transfer(Wire& wire, ForceTick& tick) {
  wire(tick.monotonic_ns, tick.wanted_N, tick.delivered_N);
}

template <typename Wire>
void transfer(Wire& wire, StringGeometry& geometry) {
  wire(geometry.count);
  if (geometry.count < 0 || geometry.count > kMaxStrings) return wire.fail();
  for (Eigen::Vector3d& exit_m : geometry.exit_m) wire(exit_m);
  for (Eigen::Vector3d& grip_m : geometry.grip_m) wire(grip_m);
}

template <typename Wire>
void transfer(Wire& wire, DeviceView& device) {
  wire(device.name, device.has_hand, device.has_strings, device.last, device.overruns, device.ticks,
       device.geometry, device.min_tension_N, device.max_tension_N);
}

template <typename Wire>
void transfer(Wire& wire, Setting::Choice& choice) {
  wire(choice.value, choice.name);
}

template <typename Wire>
void transfer(Wire& wire, Setting& setting) {
  wire(setting.name, setting.help, setting.value, setting.low, setting.high, setting.choices,
       setting.usual);
  wire.choice(setting.kind, Setting::Kind::kNumber);
}

template <typename Wire>
void transfer(Wire& wire, std::shared_ptr<const FeelRules>& rules) {
  std::string text = rules ? rules->text() : "";
  wire(text);
  if constexpr (Wire::kReads) {
    rules.reset();
    if (!wire.ok() || text.empty()) return;
    try {
      rules = std::make_shared<const FeelRules>(text);
    } catch (const FeelRulesError&) {
      wire.fail();
    }
  }
}

// --- the messages

template <typename Wire>
void transfer(Wire& wire, PictureMemory& memory) {
  wire(memory.id, memory.caps, memory.slots, memory.slot_bytes);
  if (memory.slots > PictureMemory::kMaxSlots) wire.fail();
}

template <typename Wire>
void transfer(Wire& wire, FrameShown& frame) {
  wire(frame.memory, frame.slot, frame.report);
}

template <typename Wire>
void transfer(Wire& wire, ElementState& state) {
  wire(state.name, state.is_playing, state.has_ended, state.device, state.settings, state.presets,
       state.no_force, state.rules);
}

template <typename Wire>
void transfer(Wire& wire, ChoicesSaved& saved) {
  wire(saved.is_done, saved.what);
}

template <typename Wire>
void transfer(Wire& wire, TakePicture& take) {
  wire(take.path);
}

template <typename Wire>
void transfer(Wire& wire, Mouse& mouse) {
  wire(mouse.at_px, mouse.down, mouse.shift, mouse.wheel, mouse.taken);
}

template <typename Wire>
void transfer(Wire& wire, UserInput& input) {
  wire(input.key, input.mouse, input.size_px);
}

template <typename Wire>
void transfer(Wire&, Close&) {}

template <typename Wire>
void transfer(Wire&, Ask&) {}

template <typename Wire>
void transfer(Wire& wire, SlotFree& free) {
  wire(free.memory, free.slot);
}

template <typename Wire>
void transfer(Wire& wire, ChangeSetting& change) {
  wire(change.name, change.value);
}

template <typename Wire>
void transfer(Wire& wire, LoadPreset& preset) {
  wire(preset.name);
}

template <typename Wire>
void transfer(Wire& wire, LeadHand& lead) {
  wire(lead.to_m);
}

template <typename Wire>
void transfer(Wire& wire, ChooseObject& choose) {
  wire(choose.position);
}

template <typename Wire>
void transfer(Wire& wire, FeelEdit& edit) {
  wire(edit.from_ns, edit.to_ns, edit.position);
}

template <typename Wire>
void transfer(Wire& wire, SaveChoices& save) {
  wire(save.film, save.edits);
}

template <typename Wire>
void transfer(Wire& wire, PlayFilm& play) {
  wire(play.plays);
}

template <typename Wire>
void transfer(Wire& wire, SeekFilm& seek) {
  wire(seek.to_ns);
}

template <typename Wire>
void transfer(Wire& wire, PictureTaken& taken) {
  wire(taken.error);
}

template <typename Wire>
void transfer(Wire& wire, CannotOpen& failed) {
  wire(failed.what, failed.advice);
}

namespace {

template <typename Message>
std::vector<uint8_t> write(const Message& message) {
  Wire<false> wire;
  auto kind = static_cast<uint8_t>(message.index());
  // A writer changes nothing of what it is given; only a reader does.
  auto& written = const_cast<Message&>(message);
  std::visit([&](auto& content) { wire(kind, content); }, written);
  return std::move(wire.bytes());
}

/// The kind whose number is `kKind`, or one after it; nothing when there is no such kind, or its
/// bytes are not those of one.
template <typename Message, size_t kKind = 0>
std::optional<Message> read_kind(Wire<true>& wire, size_t kind) {
  if constexpr (kKind < std::variant_size_v<Message>) {
    if (kind != kKind) return read_kind<Message, kKind + 1>(wire, kind);
    std::variant_alternative_t<kKind, Message> part;
    wire(part);
    if (wire.ok() && wire.is_at_end()) return Message(std::move(part));
  }
  return std::nullopt;
}

template <typename Message>
std::optional<Message> read(const std::vector<uint8_t>& bytes) {
  Wire<true> wire(bytes.data(), bytes.size());
  uint8_t kind = 0;
  wire(kind);
  return wire.ok() ? read_kind<Message>(wire, kind) : std::nullopt;
}

}  // namespace

std::vector<uint8_t> to_bytes(const ToWindow& message) {
  return write(message);
}

std::vector<uint8_t> to_bytes(const FromWindow& message) {
  return write(message);
}

std::optional<ToWindow> to_window(const std::vector<uint8_t>& bytes) {
  return read<ToWindow>(bytes);
}

std::optional<FromWindow> from_window(const std::vector<uint8_t>& bytes) {
  return read<FromWindow>(bytes);
}

bool is_possible(const FromWindow& request) {
  const auto is_in_picture = [](const std::optional<Eigen::Vector2d>& position) {
    return !position || (position->array() >= 0 && position->array() <= 1).all();
  };
  if (const auto* change = std::get_if<ChangeSetting>(&request)) {
    return std::isfinite(change->value);
  }
  if (const auto* lead = std::get_if<LeadHand>(&request)) {
    return !lead->to_m || lead->to_m->allFinite();
  }
  if (const auto* choose = std::get_if<ChooseObject>(&request)) {
    return is_in_picture(choose->position);
  }
  if (const auto* seek = std::get_if<SeekFilm>(&request)) return seek->to_ns >= 0;
  if (const auto* save = std::get_if<SaveChoices>(&request)) {
    return std::all_of(save->edits.begin(), save->edits.end(), [&](const FeelEdit& edit) {
      return edit.from_ns >= 0 && is_in_picture(edit.position);
    });
  }
  return true;
}

}  // namespace spidar::window
