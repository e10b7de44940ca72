// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/inverse3/packets.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "core/json_text.h"

namespace spidar::inverse3 {
namespace {

/// The middle of the workspace from the foot of the device, in the device's own axes.
const Eigen::Vector3d kMiddle_m(0, -0.1, 0.18);
/// The longest accepted identifier. The published ones are hexadecimal.
constexpr size_t kIdLength = 64;

Eigen::Vector3d to_device(const Eigen::Vector3d& haply) noexcept {
  return {haply.x(), haply.z(), 0 - haply.y()};
}

Eigen::Vector3d to_haply(const Eigen::Vector3d& device) noexcept {
  return {device.x(), -device.z(), device.y()};
}

/// Returns a discarded value when the text is not JSON.
ReadJson parse(ByteView text) {
  std::string why;
  return parse_json({reinterpret_cast<const char*>(text.data), text.size}, why);
}

/// Returns null when there is no such field.
const ReadJson* field(const ReadJson* of, const char* name) {
  if (!of || !of->is_object()) return nullptr;
  const auto found = of->find(name);
  return found == of->end() ? nullptr : &*found;
}

bool read_vector(const ReadJson* from, Eigen::Vector3d& vector) {
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const ReadJson* number = field(from, kAxes[static_cast<size_t>(axis)]);
    if (!number || !number->is_number()) return false;
    vector[axis] = number->get<double>();
  }
  return vector.allFinite();
}

bool is_true(const ReadJson* flag, bool otherwise) {
  return flag && flag->is_boolean() ? flag->get<bool>() : otherwise;
}

/// Messages contain the id without escapes, so it must have plain characters only.
bool is_id(const ReadJson* id) {
  if (!id || !id->is_string()) return false;
  const auto& text = id->get_ref<const std::string&>();
  return !text.empty() && text.size() <= kIdLength &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.';
         });
}

/// Finds the device in the list of Inverse3s of a message, or of commands; null if it is absent.
const ReadJson* device_in(const ReadJson& message, std::string_view id) {
  const ReadJson* devices = field(&message, "inverse3");
  if (!devices || !devices->is_array()) return nullptr;
  for (const ReadJson& device : *devices) {
    const ReadJson* found = field(&device, "device_id");
    if (id.empty() || (is_id(found) && found->get_ref<const std::string&>() == id)) return &device;
  }
  return nullptr;
}

/// The buttons of the first handle that has any: a wireless handle has three, the other has one.
uint32_t buttons_in(const ReadJson& message) {
  for (const char* kind : {"wireless_verse_grip", "verse_grip", "custom_verse_grip"}) {
    const ReadJson* handles = field(&message, kind);
    if (!handles || !handles->is_array() || handles->empty()) continue;
    const ReadJson* state = field(&handles->front(), "state");
    const ReadJson* buttons = field(state, "buttons");
    return (is_true(field(state, "button"), false) || is_true(field(buttons, "a"), false) ? 1U
                                                                                          : 0U) |
           (is_true(field(buttons, "b"), false) ? 2U : 0U) |
           (is_true(field(buttons, "c"), false) ? 4U : 0U);
  }
  return 0;
}

Answer read_state(const ReadJson& message, std::string_view id, State& state) {
  if (!message.is_object()) return Answer::kBroken;
  const ReadJson* device = device_in(message, id);
  if (!device) return Answer::kAbsent;
  const ReadJson* name = field(device, "device_id");
  const ReadJson* now = field(device, "state");
  const ReadJson* status = field(device, "status");
  Eigen::Vector3d position_m;
  if (!is_id(name) || !read_vector(field(now, "cursor_position"), position_m)) {
    return Answer::kBroken;
  }
  if (position_m.norm() > kFarthest_m) return Answer::kBroken;
  state.id = name->get_ref<const std::string&>();
  state.version = field(now, "current_cursor_force") ? Version::k35 : Version::k31;
  if (state.version == Version::k31) position_m -= kMiddle_m;
  state.position_m = to_device(position_m);
  state.buttons = buttons_in(message);
  state.calibrated = is_true(field(status, "calibrated"), true);
  state.powered = is_true(field(status, "power_supply"), true);
  return Answer::kState;
}

/// Appends texts and numbers; a message that does not fit has the length 0.
class Writer {
 public:
  explicit Writer(MutableBytes bytes) : bytes_(bytes) {}

  Writer& text(std::string_view text) noexcept {
    fits_ = fits_ && text.size() <= bytes_.size - length_;
    if (fits_) {
      length_ = static_cast<size_t>(std::copy(text.begin(), text.end(), bytes_.data + length_) -
                                    bytes_.data);
    }
    return *this;
  }
  /// Appends numbers with six decimals, and with a decimal point in every locale.
  Writer& vector(const Eigen::Vector3d& vector) noexcept {
    return text("{\"x\":")
        .number(vector.x())
        .text(",\"y\":")
        .number(vector.y())
        .text(",\"z\":")
        .number(vector.z())
        .text("}");
  }
  size_t length() const noexcept { return fits_ ? length_ : 0; }

 private:
  Writer& number(double number) noexcept {
    std::array<char, 32> digits{};
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(),
                                            number + 0.0, std::chars_format::fixed, 6);
    // JSON has no infinity, and no valid number has so many digits.
    if (error != std::errc() || !std::isfinite(number)) fits_ = false;
    return text({digits.data(), static_cast<size_t>(end - digits.data())});
  }

  const MutableBytes bytes_;
  size_t length_ = 0;
  bool fits_ = true;
};

Writer& begin_device(Writer& writer, const State& device) noexcept {
  return writer.text("\"inverse3\":[{\"device_id\":\"").text(device.id).text("\",");
}

Writer& write_force(Writer& writer, const State& device, const Eigen::Vector3d& haply_N) noexcept {
  return writer.text("\"commands\":{\"set_cursor_force\":{\"")
      .text(device.version == Version::k35 ? "vector" : "values")
      .text("\":")
      .vector(haply_N)
      .text("}}}]}");
}

}  // namespace

Answer decode_state(ByteView message, std::string_view id, State& state) noexcept {
  return read_state(parse(message), id, state);
}

size_t encode_query(MutableBytes bytes) noexcept {
  return Writer(bytes).text("{\"session\":{\"force_render_full_state\":{}}}").length();
}

size_t encode_start(const State& device, MutableBytes bytes) noexcept {
  Writer writer(bytes);
  writer.text("{\"session\":{\"configure\":{\"profile\":{\"name\":\"gst-spidar\"}}},");
  begin_device(writer, device);
  if (device.version == Version::k35) {
    writer.text("\"configure\":{\"preset\":{\"preset\":\"arm_front_centered\"},")
        .text("\"basis\":{\"permutation\":\"XYZ\"}},");
  }
  return write_force(writer, device, Eigen::Vector3d::Zero()).length();
}

size_t encode_force(const State& device, const Eigen::Vector3d& force_N,
                    MutableBytes bytes) noexcept {
  Eigen::Vector3d limited_N = Eigen::Vector3d::Zero();
  if (force_N.allFinite()) limited_N = force_N;
  // Limiting each axis first keeps the length finite.
  limited_N = limited_N.cwiseMax(-1e6).cwiseMin(1e6);
  if (limited_N.norm() > kLargestForce_N) limited_N *= kLargestForce_N / limited_N.norm();
  Writer writer(bytes);
  writer.text("{");
  return write_force(begin_device(writer, device), device, to_haply(limited_N)).length();
}

bool decode_force(ByteView message, std::string_view id, Eigen::Vector3d& force_N) noexcept {
  const ReadJson read = parse(message);
  const ReadJson* command = field(field(device_in(read, id), "commands"), "set_cursor_force");
  Eigen::Vector3d haply_N;
  if (!read_vector(field(command, "vector"), haply_N) &&
      !read_vector(field(command, "values"), haply_N)) {
    return false;
  }
  force_N = to_device(haply_N);
  return true;
}

size_t encode_state(const State& state, MutableBytes bytes) noexcept {
  Eigen::Vector3d position_m = to_haply(state.position_m);
  if (state.version == Version::k31) position_m += kMiddle_m;
  const auto flag = [](bool value) { return value ? "true" : "false"; };
  Writer writer(bytes);
  writer.text("{\"session_id\":1,");
  begin_device(writer, state).text("\"state\":{\"cursor_position\":").vector(position_m);
  if (state.version == Version::k35) {
    writer.text(",\"current_cursor_force\":").vector(Eigen::Vector3d::Zero());
  }
  writer.text("},\"status\":{\"calibrated\":").text(flag(state.calibrated));
  writer.text(",\"power_supply\":").text(flag(state.powered)).text("}}],");
  writer.text("\"wireless_verse_grip\":[{\"device_id\":\"0\",\"state\":{\"buttons\":{\"a\":")
      .text(flag(state.buttons & 1))
      .text(",\"b\":")
      .text(flag(state.buttons & 2))
      .text(",\"c\":")
      .text(flag(state.buttons & 4))
      .text("}}}]}");
  return writer.length();
}

size_t encode_frame(ByteView text, MutableBytes frame) noexcept {
  constexpr uint8_t kFinalText = 0x81, kMasked = 0x80, kTwoBytes = 126;
  if (text.size == 0 || text.size > kCommandSize) return 0;
  const bool is_long = text.size >= kTwoBytes;
  const size_t head = is_long ? kFrameHead : kFrameHead - 2;
  if (frame.size < head + text.size) return 0;
  frame.fill(0);
  frame.put_u8(0, kFinalText);
  frame.put_u8(1, static_cast<uint8_t>(kMasked | (is_long ? kTwoBytes : text.size)));
  if (is_long) {
    frame.put_u8(2, static_cast<uint8_t>(text.size >> 8));
    frame.put_u8(3, static_cast<uint8_t>(text.size & 0xFF));
  }
  std::copy_n(text.data, text.size, frame.data + head);
  return head + text.size;
}

}  // namespace spidar::inverse3
