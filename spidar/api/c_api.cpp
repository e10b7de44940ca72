// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The interface in C: types of the same layout as those in C++, and exceptions as errors.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <gst-spidar/c-api.h>
#include <gst-spidar/device.h>
#include <gst-spidar/motion.h>

struct GstSpidarDevice {
  gst_spidar::Device device;
};

struct GstSpidarMotion {
  gst_spidar::MotionToWrench motion;
};

namespace gst_spidar {
inline namespace v0 {
namespace {

/// Copies `from` into a type of the other language that has the same members in the same order.
/// Unlike a cast, this may be given an enum of C that has none of its values.
template <typename To, typename From>
To same(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  static_assert(std::is_trivially_copyable_v<To> && std::is_trivially_copyable_v<From>);
  To to;
  std::memcpy(static_cast<void*>(&to), &from, sizeof to);
  return to;
}

/// Writes `text` as snprintf() does, but never half a character of UTF-8. Returns its length.
size_t write_text(const std::string& text, char* to, size_t size) noexcept {
  if (size == 0) return text.size();
  size_t length = std::min(size - 1, text.size());
  const auto continues = [&](size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
  };
  while (length > 0 && length < text.size() && continues(length)) --length;
  std::memcpy(to, text.data(), length);
  to[length] = '\0';
  return text.size();
}

void set_error(GstSpidarError* error, GstSpidarErrorKind kind,
               const std::string& message) noexcept {
  if (error == nullptr) return;
  error->kind = kind;
  write_text(message, error->message, sizeof error->message);
}

/// Returns what `call` returns, or `failed` and the error when `call` throws.
template <typename Result, typename Call>
Result guarded(GstSpidarError* error, Result failed, const Call& call) noexcept {
  set_error(error, GST_SPIDAR_OK, {});
  try {
    return call();
  } catch (const std::invalid_argument& wrong) {
    set_error(error, GST_SPIDAR_ERROR_ARGUMENT, wrong.what());
  } catch (const std::exception& other) {
    set_error(error, GST_SPIDAR_ERROR_FAILED, other.what());
  }
  return failed;
}

template <typename Call>
bool done(GstSpidarError* error, const Call& call) noexcept {
  return guarded(error, false, [&] {
    call();
    return true;
  });
}

std::string text_of(const char* text) {
  return text == nullptr ? "" : text;
}

Device::Callback callback_of(GstSpidarCallback callback, void* user_data) {
  if (callback == nullptr) return {};
  return [=](const GripState& state) {
    const auto grip = same<GstSpidarGripState>(state);
    GstSpidarWrench wrench{};
    if (!callback(&grip, &wrench, user_data)) throw std::runtime_error("it has returned false");
    return same<Wrench>(wrench);
  };
}

Energy energy_of(const GstSpidarEnergy& energy) {
  const int value = same<int>(energy);
  if (value == GST_SPIDAR_PASSIVE) return Energy::kPassive;
  if (value == GST_SPIDAR_ANY) return Energy::kAny;
  throw std::invalid_argument("energy must be GST_SPIDAR_PASSIVE or GST_SPIDAR_ANY");
}

/// Puts the pointers and, behind them, the names into one piece of memory.
char** list_of(const std::vector<std::string>& names) {
  size_t size = (names.size() + 1) * sizeof(char*);
  for (const std::string& name : names) size += name.size() + 1;
  char** const list = static_cast<char**>(std::malloc(size));
  if (list == nullptr) throw std::bad_alloc();
  char* to = reinterpret_cast<char*>(list + names.size() + 1);
  for (size_t i = 0; i < names.size(); ++i) {
    list[i] = to;
    to = std::copy_n(names[i].c_str(), names[i].size() + 1, to);
  }
  list[names.size()] = nullptr;
  return list;
}

/// Returns whether the device accepts what `take` passes to it; a lost device accepts nothing.
template <typename Take>
bool taken(GstSpidarDevice* device, GstSpidarError* error, const char* what, const Take& take) {
  return guarded(error, false, [&] {
    if (take(device->device)) return true;
    const std::string fault = device->device.last_fault();
    set_error(error, GST_SPIDAR_ERROR_LOST,
              std::string("the device takes no ") + what + " at present" +
                  (fault.empty() ? "" : ": " + fault) +
                  "; try again later, it is opened again as soon as it answers");
    return false;
  });
}

/// Writes `from` to `to` if there is a value. Returns whether there is one.
template <typename To, typename From>
bool found(const std::optional<From>& from, To* to) {
  if (from) *to = same<To>(*from);
  return from.has_value();
}

}  // namespace
}  // namespace v0
}  // namespace gst_spidar

using namespace gst_spidar;

GstSpidarDevice* gst_spidar_device_open(const char* name, const char* profile,
                                        GstSpidarError* error) {
  return guarded<GstSpidarDevice*>(
      error, nullptr, [&] { return new GstSpidarDevice{Device(text_of(name), text_of(profile))}; });
}

void gst_spidar_device_close(GstSpidarDevice* device) {
  delete device;
}

bool gst_spidar_device_push(GstSpidarDevice* device, const GstSpidarWrench* wrench,
                            GstSpidarError* error) {
  return taken(device, error, "wrench",
               [&](Device& open) { return open.push(same<Wrench>(*wrench)); });
}

void gst_spidar_device_rest(GstSpidarDevice* device) {
  device->device.rest();
}

bool gst_spidar_device_set_callback(GstSpidarDevice* device, GstSpidarCallback callback,
                                    void* user_data, GstSpidarEnergy energy,
                                    GstSpidarError* error) {
  return done(error, [&] {
    device->device.set_callback(callback_of(callback, user_data), energy_of(energy));
  });
}

size_t gst_spidar_device_callback_error(const GstSpidarDevice* device, char* text, size_t size) {
  return write_text(device->device.callback_error(), text, size);
}

bool gst_spidar_device_set_limits(GstSpidarDevice* device, double max_force_N, double max_torque_Nm,
                                  GstSpidarError* error) {
  return done(error, [&] { device->device.set_limits(max_force_N, max_torque_Nm); });
}

bool gst_spidar_device_set_surface(GstSpidarDevice* device, const GstSpidarSurface* surface,
                                   GstSpidarError* error) {
  return taken(device, error, "surface",
               [&](Device& open) { return open.set_surface(same<Surface>(*surface)); });
}

void gst_spidar_device_clear_surface(GstSpidarDevice* device) {
  device->device.clear_surface();
}

bool gst_spidar_device_pose(const GstSpidarDevice* device, GstSpidarPose* pose) {
  return found(device->device.pose(), pose);
}

bool gst_spidar_device_velocity(const GstSpidarDevice* device, GstSpidarVector3* velocity_m_s) {
  return found(device->device.velocity(), velocity_m_s);
}

uint32_t gst_spidar_device_buttons(const GstSpidarDevice* device) {
  return device->device.buttons();
}

bool gst_spidar_device_held(const GstSpidarDevice* device) {
  return device->device.held();
}

double gst_spidar_device_vibration_fraction(const GstSpidarDevice* device) {
  return device->device.vibration_fraction();
}

void gst_spidar_device_felt(const GstSpidarDevice* device, GstSpidarWrench* wrench) {
  *wrench = same<GstSpidarWrench>(device->device.felt());
}

GstSpidarState gst_spidar_device_state(const GstSpidarDevice* device) {
  return static_cast<GstSpidarState>(device->device.state());
}

bool gst_spidar_device_wait_until_running(const GstSpidarDevice* device, int64_t timeout_ms) {
  return guarded(nullptr, false, [&] {
    return device->device.wait_until_running(std::chrono::milliseconds(timeout_ms));
  });
}

size_t gst_spidar_device_last_fault(const GstSpidarDevice* device, char* text, size_t size) {
  return write_text(device->device.last_fault(), text, size);
}

size_t gst_spidar_device_warning(const GstSpidarDevice* device, char* text, size_t size) {
  return write_text(device->device.warning(), text, size);
}

void gst_spidar_device_capabilities(const GstSpidarDevice* device,
                                    GstSpidarCapabilities* capabilities) {
  *capabilities = same<GstSpidarCapabilities>(device->device.capabilities());
}

const char* gst_spidar_device_name(const GstSpidarDevice* device) {
  return device->device.name().c_str();
}

char** gst_spidar_list_devices(GstSpidarError* error) {
  return guarded<char**>(error, nullptr, [] { return list_of(list_devices()); });
}

char** gst_spidar_list_profiles(GstSpidarError* error) {
  return guarded<char**>(error, nullptr, [] { return list_of(list_profiles()); });
}

void gst_spidar_free_list(char** list) {
  std::free(list);
}

GstSpidarMotion* gst_spidar_motion_new(GstSpidarError* error) {
  return guarded<GstSpidarMotion*>(error, nullptr, [] { return new GstSpidarMotion; });
}

void gst_spidar_motion_free(GstSpidarMotion* motion) {
  delete motion;
}

bool gst_spidar_motion_analyze(GstSpidarMotion* motion, const GstSpidarPicture* picture,
                               int64_t time_ns, GstSpidarMotionResult* result,
                               GstSpidarError* error) {
  return done(error, [&] {
    *result = same<GstSpidarMotionResult>(
        motion->motion.analyze(same<GreyPicture>(*picture), std::chrono::nanoseconds(time_ns)));
  });
}

void gst_spidar_motion_reset(GstSpidarMotion* motion) {
  motion->motion.reset();
}

void gst_spidar_motion_settings_init(GstSpidarMotionSettings* settings) {
  *settings = same<GstSpidarMotionSettings>(MotionSettings{});
}

bool gst_spidar_motion_configure(GstSpidarMotion* motion, const GstSpidarMotionSettings* settings,
                                 GstSpidarError* error) {
  return done(error, [&] { motion->motion.configure(same<MotionSettings>(*settings)); });
}
