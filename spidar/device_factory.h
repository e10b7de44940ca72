/// Devices by name.
#pragma once

#include <memory>
#include <string>

#include "core/api.h"
#include "spidar/device.h"
#include "spidar/profile.h"

namespace spidar {

/// `spec`: "sim". Throws DeviceError that lists what can be named. Nothing is opened.
/// ("none" is not a device: who asks for it needs no loop.)
SPIDAR_API std::unique_ptr<Device> make_device(const std::string& spec, const Profile& profile);

}  // namespace spidar
