#include "spidar/device_factory.h"

#include <stdexcept>

#include "spidar/simulated_device.h"

namespace spidar {

std::unique_ptr<Device> make_device(const std::string& spec, const Profile& profile) {
  if (spec == "sim") {
    try {
      return std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kClock);
    } catch (const std::invalid_argument& error) {
      throw DeviceError("sim: cannot simulate profile \"" + profile.name + "\": " + error.what());
    }
  }
  throw DeviceError("unknown device \"" + spec + "\"; known are: sim");
}

}  // namespace spidar
