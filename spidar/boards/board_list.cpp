#include "spidar/boards/board_list.h"

#include "spidar/device.h"
#include "spidar/protocols/sh4.h"
#include "spidar/protocols/spidar_mouse.h"
#include "spidar/protocols/usb_simple.h"
#include "spidar/transports/usb_bus.h"

namespace spidar {
namespace {

struct Known {
  uint16_t vendor;
  uint16_t product;
  const char* usb_id;
  const char* device;  // without what names one of several
  const char* name;
  Trial trial;
  const char* note;
};

constexpr Known kKnown[] = {
    {sh4::kVendor, sh4::kProduct, "0cec:0205", "usb", "CyVerse USB 2.0 SH4", Trial::kEmulated,
     "endpoints and D/A range are inferred"},
    {usb_simple::kVendor, usb_simple::kProduct, "0cec:0203", "usb", "CyVerse USB 2.0 Simple",
     Trial::kEmulated, "endpoints and D/A range are inferred"},
    {mouse::kVendor, mouse::kProduct, "04d8:003f", "mouse", "SPIDAR-mouse", Trial::kInferred,
     "other devices have this id; asked when it is opened"},
};

constexpr const char* kSimulated[][2] = {
    {"sim", "simulated SPIDAR"},
    {"sim:sh4", "simulated SPIDAR behind the SH4 board's packets"},
    {"sim:simple", "simulated SPIDAR behind the Simple board's packets"},
    {"sim:uart", "simulated SPIDAR behind the UART boards' packets"},
    {"sim:mouse", "simulated SPIDAR-mouse"},
};

}  // namespace

const char* to_string(Trial trial) noexcept {
  switch (trial) {
    case Trial::kHardware:
      return "tried on hardware";
    case Trial::kEmulated:
      return "emulated";
    case Trial::kInferred:
      return "inferred";
  }
  return "unknown";
}

std::vector<BoardInfo> list_boards() {
  std::vector<BoardInfo> boards;
  for (const Known& known : kKnown) {
    std::vector<UsbDeviceInfo> devices;
    try {
      devices = list_usb_devices(known.vendor, known.product);
    } catch (const DeviceError&) {
      break;  // no USB
    }
    for (const UsbDeviceInfo& device : devices) {
      const std::string spec = std::string(known.device) + ":" + device.path;
      boards.push_back({spec, known.name, device.path, device.serial, known.usb_id, known.trial,
                        device.accessible ? known.note : "no permission: udev rule 70-spidar.rules",
                        device.accessible});
    }
  }
  for (const auto& simulated : kSimulated)
    boards.push_back({simulated[0], simulated[1], "", "", "", Trial::kEmulated, "", true});
  return boards;
}

}  // namespace spidar
