// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/emulated_bus/evdev_driver.h"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <vector>

#include "spidar/realtime/monotonic.h"
#include "tests/emulated_bus/evdev_kinds.h"

namespace spidar::test {
namespace {

void erase_effect(EvdevPort::Effect& effect) {
  effect.plays = effect.used = false;
  effect.right = effect.up = effect.rumble = 0;
}

/// As the kernel answers when it is asked for a text. Returns its length, or −errno.
int put_text(const char* text, void* argument, size_t size) {
  if (*text == '\0') return -ENOENT;
  std::snprintf(static_cast<char*>(argument), size, "%s", text);
  return static_cast<int>(std::strlen(static_cast<char*>(argument)) + 1);
}

std::vector<unsigned> pressed(const EvdevPort& port) {
  std::vector<unsigned> codes;
  const std::vector<unsigned> keys = key_bits(port.kind);
  for (size_t i = 0; i < keys.size(); ++i)
    if (port.pressed >> i & 1) codes.push_back(keys[i]);
  return codes;
}

}  // namespace

bool is_playing(const EvdevPort& port, const EvdevPort::Effect& effect) {
  const int64_t end_ns = effect.began_ns + effect.length_ms * kSecond_ns / 1000;
  const bool ended = port.expires && effect.length_ms > 0 && monotonic_now_ns() > end_ns;
  return effect.plays && !ended;
}

void erase_effects(EvdevPort& port) {
  for (EvdevPort::Effect& effect : port.effect) erase_effect(effect);
}

void reset(EvdevPort& port) {
  erase_effects(port);
  port.uploads = port.unchanged = port.plays = port.settings = 0;
  port.shortest_ns = 0;
  for (auto& axis : port.axis) axis = 0;
  port.axis_end = 1000;
  port.pressed = 0;
  port.gain = port.autocentre = 0;
  port.upload_ms = port.upload_error = 0;
  port.query_error = port.event_error = port.setting_error = 0;
  port.failing = -1;
  port.keeps_spring = false;
  port.expires = port.hangs = port.cuts_events = port.signals = port.refuses_stops = false;
  port.gain_with_force = 0;
}

bool EvdevDriver::is_interrupted() {
  return port_.signals && !port_.interrupted.exchange(!port_.interrupted);
}

int EvdevDriver::call(unsigned long request, void* argument) {
  if (is_interrupted()) return -EINTR;
  if (request == EVIOCSFF) return upload(*static_cast<ff_effect*>(argument));
  if (request == EVIOCRMFF) return erase(reinterpret_cast<size_t>(argument));
  return query(request, argument);
}

bool EvdevDriver::write_fails(const EvdevPort& port, size_t length, long& result) {
  const int error = port.event_error;
  if (error == 0 && !port.cuts_events) return false;
  errno = error;
  result = error == 0 ? static_cast<long>(length / 2) : -1;
  return true;
}

int EvdevDriver::upload(ff_effect& wanted) {
  if (port_.hangs) {
    ++port_.hanging;
    while (port_.hangs && port_.kind != EvdevKind::kNone)
      sleep_until_ns(monotonic_now_ns() + kSecond_ns / 1000);
    --port_.hanging;
  }
  if (port_.kind == EvdevKind::kNone) return -ENODEV;
  const int64_t now_ns = monotonic_now_ns();
  const int64_t passed_ns = now_ns - port_.last_upload_ns.exchange(now_ns);
  if (port_.shortest_ns == 0 || passed_ns < port_.shortest_ns) port_.shortest_ns = passed_ns;
  while (monotonic_now_ns() < now_ns + port_.upload_ms * kSecond_ns / 1000)
    sleep_until_ns(monotonic_now_ns() + kSecond_ns / 1000);
  if (port_.upload_error != 0 && port_.failing != 0) {
    if (port_.failing > 0) --port_.failing;
    return -port_.upload_error;
  }
  const bool fits = is_constant(port_.kind) ? wanted.type == FF_CONSTANT : wanted.type == FF_RUMBLE;
  if (!fits) return -EINVAL;
  auto at = static_cast<size_t>(wanted.id);
  if (wanted.id == -1) {
    at = 0;
    while (at < port_.effect.size() && port_.effect[at].used) ++at;
    if (at == port_.effect.size()) return -ENOSPC;
  }
  if (at >= port_.effect.size() || (wanted.id != -1 && !port_.effect[at].used)) return -EINVAL;
  wanted.id = static_cast<int16_t>(at);
  if (port_.kind == EvdevKind::kWheelBase)
    wanted.direction = static_cast<uint16_t>(ff::Direction::kLeft);
  const auto effect = ff::decode_effect({reinterpret_cast<const uint8_t*>(&wanted), sizeof wanted});
  EvdevPort::Effect& kept = port_.effect[at];
  const auto rounded = [](double fraction, int full) {
    return static_cast<int>(std::lround(fraction * full));
  };
  const int right = rounded(effect->right, ff::kFullLevel);
  const int up = rounded(effect->up, ff::kFullLevel);
  const int rumble = rounded(effect->rumble, ff::kFullStrength);
  if (kept.used && kept.right == right && kept.up == up && kept.rumble == rumble) ++port_.unchanged;
  kept.length_ms = effect->length_ms;
  kept.right = right;
  kept.up = up;
  kept.rumble = rumble;
  kept.used = true;
  ++port_.uploads;
  return 0;
}

int EvdevDriver::erase(size_t number) {
  if (number >= port_.effect.size() || !port_.effect[number].used) return -EINVAL;
  erase_effect(port_.effect[number]);
  return 0;
}

int EvdevDriver::query(unsigned long request, void* argument) {
  const bool of_position = request == EVIOCGEFFECTS || _IOC_NR(request) >= _IOC_NR(EVIOCGABS(0));
  if (of_position && port_.query_error != 0) return -port_.query_error;
  const unsigned number = _IOC_NR(request);
  const size_t size = _IOC_SIZE(request);
  if (request == EVIOCGVERSION) {
    *static_cast<int*>(argument) = EV_VERSION;
    return 0;
  }
  if (request == EVIOCGEFFECTS) {
    *static_cast<int*>(argument) = static_cast<int>(port_.effect.size());
    return 0;
  }
  if (request == EVIOCGID) {
    const UsbId id = usb_id_of(port_.kind);
    *static_cast<input_id*>(argument) = {BUS_USB, id.vendor, id.product, 1};
    return 0;
  }
  if (number == _IOC_NR(EVIOCGNAME(0))) return put_text(port_.name.data(), argument, size);
  if (number == _IOC_NR(EVIOCGUNIQ(0))) return put_text(port_.serial.data(), argument, size);
  if (number == _IOC_NR(EVIOCGPHYS(0))) return put_text(port_.place.data(), argument, size);
  if (number == _IOC_NR(EVIOCGBIT(EV_FF, 0))) return put_bits(ff_bits(port_.kind), argument, size);
  if (number == _IOC_NR(EVIOCGBIT(EV_ABS, 0)))
    return put_bits(abs_bits(port_.kind), argument, size);
  if (number == _IOC_NR(EVIOCGBIT(EV_KEY, 0)))
    return put_bits(key_bits(port_.kind), argument, size);
  if (number == _IOC_NR(EVIOCGKEY(0))) return put_bits(pressed(port_), argument, size);
  if (number >= _IOC_NR(EVIOCGABS(0))) {
    const size_t axis = number - _IOC_NR(EVIOCGABS(0));
    if (axis >= port_.axis.size()) return -EINVAL;
    auto& info = *static_cast<input_absinfo*>(argument);
    info = {};
    info.value = port_.axis[axis];
    info.minimum = -port_.axis_end;
    info.maximum = port_.axis_end;
    return 0;
  }
  return -EINVAL;
}

int EvdevDriver::event(const ff::Event& event) {
  if (is_interrupted()) return -EINTR;
  if (port_.setting_error != 0 && (event.code == FF_GAIN || event.code == FF_AUTOCENTER))
    return -port_.setting_error;
  if (event.code == FF_GAIN) {
    for (const EvdevPort::Effect& effect : port_.effect)
      if (event.value == ff::kFullGain && is_playing(port_, effect)) ++port_.gain_with_force;
    port_.gain = event.value;
    ++port_.settings;
  } else if (event.code == FF_AUTOCENTER) {
    port_.autocentre = event.value;
    ++port_.settings;
  } else if (event.code < port_.effect.size() && port_.effect[event.code].used) {
    if (port_.refuses_stops && event.value == 0) return -EIO;
    port_.effect[event.code].plays = event.value > 0;
    port_.effect[event.code].began_ns = monotonic_now_ns();
    if (event.value > 0) ++port_.plays;
  }
  return 0;
}

}  // namespace spidar::test
