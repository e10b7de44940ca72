// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/view/messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/touch/height_field.h"

namespace spidar::window {

namespace {

/// Every structure that goes through the socket, member by member, with the ranges of its values.
struct Members {
  static auto of(ImagePoint& p) { return std::tie(p.x_px, p.y_px); }
  static auto of(PicturePart& p) { return std::tie(p.x, p.y, p.width, p.height); }
  static auto of(FilmPlace& p) { return std::tie(p.area, p.picture_width, p.picture_height); }
  static auto of(Wrench& w) { return std::tie(w.force_N, w.torque_Nm); }

  static auto of(FrameStamp& s) {
    return std::tie(s.epoch, s.stream_ns, s.running_ns, s.length_ns, s.rate);
  }
  static auto of(FilmScene& f) { return std::tie(f.path, f.begin_ns, f.length_ns); }
  static auto of(OwnedPoint& p) {
    return std::tie(p.id, p.from, p.to, p.object, p.is_new, p.owner);
  }
  static auto of(MovingObject& o) {
    return std::tie(o.id, o.position_px, o.size_px, o.low_off_px, o.high_off_px, o.relative_px_s,
                    o.on_screen_px_s, o.growth_1_s, o.roll_rad_s, o.points, o.error_px_s,
                    o.area_px2, o.prominence);
  }
  static auto of(ControllerSettings& c) { return std::tie(c.law, c.max_force_N, c.alpha_s_px); }
  static auto of(TouchScene& t) {
    return std::tie(t.on, t.pointer, t.stiffness_N_m, t.motion_fraction, t.shading);
  }
  static auto of(DrawnFrame& r) {
    Frame& f = r.frame;
    return std::tie(r.stamp, f.place, f.interval_ns, f.objects, f.wrench, f.felt_object, r.film,
                    r.took_ns, r.visible, r.turn, r.points, r.lost, r.felt, r.motion, r.controller,
                    r.speed_px_s, r.click, r.touch, r.track);
  }

  static auto of(Pose& p) { return std::tie(p.position_m, p.orientation.coeffs()); }
  static auto of(touch::Contact& c) {
    return std::tie(c.has_surface, c.touching, c.depth_m, c.proxy_m, c.force_N);
  }
  static auto of(TickRecord& t) {
    return std::tie(t.monotonic_ns, t.lateness_ns, t.running_ns, t.wanted, t.delivered, t.tension_N,
                    t.pose, t.faulty_string, t.playing, t.max_force_N, t.contact, t.device);
  }
  static auto of(ForceTick& t) { return std::tie(t.monotonic_ns, t.wanted_N, t.delivered_N); }
  static auto of(StringGeometry& g) { return std::tie(g.count, g.exit_m, g.grip_m); }
  static auto of(DeviceView& d) {
    return std::tie(d.name, d.has_hand, d.has_strings, d.last, d.overruns, d.ticks, d.geometry,
                    d.min_tension_N, d.max_tension_N);
  }
  static auto of(Setting::Choice& c) { return std::tie(c.value, c.name); }
  static auto of(Setting& s) {
    return std::tie(s.name, s.help, s.value, s.low, s.high, s.choices, s.usual, s.kind);
  }

  static auto of(PictureMemory& m) { return std::tie(m.id, m.caps, m.slots, m.slot_bytes); }
  static auto of(FrameShown& f) { return std::tie(f.memory, f.slot, f.report); }
  static auto of(ElementState& s) {
    return std::tie(s.name, s.is_playing, s.has_ended, s.device, s.settings, s.presets, s.no_force,
                    s.rules);
  }
  static auto of(ChoicesSaved& s) { return std::tie(s.is_done, s.what); }
  static auto of(TakePicture& t) { return std::tie(t.path); }
  static auto of(Mouse& m) { return std::tie(m.at_px, m.down, m.shift, m.wheel, m.taken); }
  static auto of(UserInput& i) { return std::tie(i.key, i.mouse, i.size_px); }
  static auto of(Close&) { return std::tie(); }
  static auto of(RequestFrames&) { return std::tie(); }
  static auto of(SlotFree& s) { return std::tie(s.memory, s.slot); }
  static auto of(ChangeSetting& c) { return std::tie(c.name, c.value); }
  static auto of(LoadPreset& p) { return std::tie(p.name); }
  static auto of(LeadHand& l) { return std::tie(l.to_m); }
  static auto of(ChooseObject& c) { return std::tie(c.position); }
  static auto of(FeelEdit& e) { return std::tie(e.from_ns, e.to_ns, e.position); }
  static auto of(SaveChoices& s) { return std::tie(s.film, s.edits); }
  static auto of(PlayFilm& p) { return std::tie(p.plays); }
  static auto of(SeekFilm& s) { return std::tie(s.to_ns); }
  static auto of(PictureTaken& t) { return std::tie(t.error); }
  static auto of(CannotOpen& c) { return std::tie(c.what, c.advice); }

  /// The largest value of an enumeration.
  static constexpr auto last(PointOwner) { return PointOwner::kObject; }
  static constexpr auto last(ControlLaw) { return ControlLaw::kAdaptive; }
  static constexpr auto last(MotionKind) { return MotionKind::kCamera; }
  static constexpr auto last(DeviceState) { return DeviceState::kLost; }
  static constexpr auto last(Setting::Kind) { return Setting::Kind::kNumber; }

  /// Whether the sizes in a structure are in their range.
  template <typename Value>
  static bool are_fitting(const Value&) {
    return true;
  }
  static bool are_fitting(const PictureMemory& m) { return m.slots <= PictureMemory::kMaxSlots; }
  static bool are_fitting(const StringGeometry& g) {
    return g.count >= 0 && g.count <= kMaxStrings;
  }
  static bool are_fitting(const TouchScene& t) {
    return t.shading.empty() || t.shading.size() == touch::HeightField::kCells;
  }
};

/// Writes values, or reads values that were written. Writing does not change the values.
///
/// Any bytes can be read safely: after a value that does not fit into the rest of the bytes, or
/// into its own range, ok() is false and the values are meaningless.
template <bool kReads>
class Wire {
 public:
  Wire() = default;
  Wire(const uint8_t* bytes, size_t count) : next_(bytes), left_(count) {}

  template <typename Value>
  void one(Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      raw(&value, sizeof value);
    } else if constexpr (std::is_enum_v<Value>) {
      auto number = static_cast<int32_t>(value);
      one(number);
      if (number < 0 || number > static_cast<int32_t>(Members::last(value))) return fail();
      if constexpr (kReads) value = static_cast<Value>(number);
    } else {
      std::apply([&](auto&... members) { (one(members), ...); }, Members::of(value));
      if (!Members::are_fitting(value)) fail();
    }
  }
  bool ok() const { return ok_; }
  bool is_at_end() const { return left_ == 0; }
  std::vector<uint8_t>& bytes() { return written_; }

 private:
  void fail() { ok_ = false; }
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
  /// The number of following values. Each takes a byte or more, so the size of the message bounds
  /// the memory that a reader reserves.
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
  /// An empty string stands for null.
  void one(std::shared_ptr<const std::string>& path) {
    std::string text = path ? *path : "";
    one(text);
    if constexpr (kReads) {
      path = text.empty() ? nullptr : std::make_shared<const std::string>(std::move(text));
    }
  }
  void one(std::shared_ptr<const FeelRules>& rules) {
    std::string text = rules ? rules->text() : "";
    one(text);
    if constexpr (kReads) {
      rules.reset();
      if (!ok_ || text.empty()) return;
      try {
        rules = std::make_shared<const FeelRules>(text);
      } catch (const FeelRulesError&) {
        fail();
      }
    }
  }
  /// This needs a function of its own, or GCC 12 warns that a missing value may be used.
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
  template <typename Value, size_t kCount>
  void one(std::array<Value, kCount>& values) {
    for (Value& value : values) one(value);
  }
  template <int kRows, int kColumns, int kOptions>
  void one(Eigen::Matrix<double, kRows, kColumns, kOptions>& matrix) {
    raw(matrix.data(), sizeof(double) * static_cast<size_t>(matrix.size()));
  }
  /// Encodes one of the eight ways in which a picture can be turned.
  void one(Orientation& turn) {
    constexpr int kQuarters = 4;
    const auto way = [](int n) { return Orientation(n % kQuarters, n >= kQuarters); };
    const auto is_same = [&](const Orientation& other) {
      return other.to_displayed(Eigen::Vector2d(1, 2)) == turn.to_displayed(Eigen::Vector2d(1, 2));
    };
    int32_t number = 0;
    while (!kReads && number < 2 * kQuarters - 1 && !is_same(way(number))) ++number;
    one(number);
    if (number < 0 || number >= 2 * kQuarters) return fail();
    if constexpr (kReads) turn = way(number);
  }
  void one(GripPointer& pointer) {
    Eigen::Vector2d half_size_m = pointer.half_size_m();
    Orientation turn = pointer.turn();
    one(half_size_m);
    one(turn);
    if constexpr (kReads) pointer = {half_size_m, turn};
  }

  std::vector<uint8_t> written_;
  const uint8_t* next_ = nullptr;
  size_t left_ = 0;
  bool ok_ = true;
};

template <typename Message>
std::vector<uint8_t> write(const Message& message) {
  Wire<false> wire;
  auto kind = static_cast<uint8_t>(message.index());
  wire.one(kind);
  // The cast is safe, because a writer does not change the message.
  std::visit([&](auto& content) { wire.one(content); }, const_cast<Message&>(message));
  return std::move(wire.bytes());
}

/// Reads a message of the kind `kind`, searching from the kind `kKind` on. Returns nothing if there
/// is no such kind, or the bytes are not exactly one such message.
template <typename Message, size_t kKind = 0>
std::optional<Message> read_kind(Wire<true>& wire, size_t kind) {
  if constexpr (kKind < std::variant_size_v<Message>) {
    if (kind != kKind) return read_kind<Message, kKind + 1>(wire, kind);
    std::variant_alternative_t<kKind, Message> part;
    wire.one(part);
    if (wire.ok() && wire.is_at_end()) return Message(std::move(part));
  }
  return std::nullopt;
}

template <typename Message>
std::optional<Message> read(const std::vector<uint8_t>& bytes) {
  Wire<true> wire(bytes.data(), bytes.size());
  uint8_t kind = 0;
  wire.one(kind);
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
