// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// SPIDARs in the list of GstDeviceMonitor, while boards are plugged into an emulated USB.
#include <map>
#include <string>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "plugin/provider/device_provider.h"
#include "spidar/session/device_factory.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/support/element_harness.h"

namespace spidar::test::device_provider_test {
namespace {

std::string text_in(GstDevice* device, const char* field) {
  GstStructure* properties = gst_device_get_properties(device);
  const char* text = gst_structure_get_string(properties, field);
  std::string copy = text ? text : "";
  gst_structure_free(properties);
  return copy;
}

std::string property_of(GstElement* element, const char* name) {
  char* text = nullptr;
  g_object_get(element, name, &text, nullptr);
  std::string copy = text ? text : "";
  g_free(text);
  return copy;
}

class DeviceProvider : public testing::Test {
 protected:
  DeviceProvider() {
    clear_bus();
    init_gstreamer();
    static const bool registered = GST_DEVICE_PROVIDER_REGISTER(spidardeviceprovider, nullptr);
    EXPECT_TRUE(registered);
    monitor_ = gst_device_monitor_new();
    EXPECT_NE(gst_device_monitor_add_filter(monitor_, "Haptic/SPIDAR", nullptr), 0u);
  }
  ~DeviceProvider() override {
    gst_object_unref(monitor_);
    // No board has ever been sent anything.
    for (const UsbPort& port : bus().port) EXPECT_EQ(port.updates, 0u);
    clear_bus();
  }

  /// The listed devices by the value of the property `device`. Release them with forget().
  using Devices = std::map<std::string, GstDevice*>;
  Devices devices() {
    Devices found;
    GList* list = gst_device_monitor_get_devices(monitor_);
    for (GList* item = list; item; item = item->next)
      found[text_in(GST_DEVICE(item->data), "device")] = GST_DEVICE(item->data);
    g_list_free(list);
    return found;
  }
  static void forget(Devices& devices) {
    for (const auto& [name, device] : devices) gst_object_unref(device);
    devices.clear();
  }

  /// The next event as "+usb:1-1" or "-usb:1-1"; waits for it.
  std::string next_change() {
    GstBus* bus = gst_device_monitor_get_bus(monitor_);
    std::string change;
    while (change.empty()) {
      GstMessage* message = gst_bus_timed_pop(bus, GST_CLOCK_TIME_NONE);
      GstDevice* device = nullptr;
      if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_DEVICE_ADDED) {
        gst_message_parse_device_added(message, &device);
        change = "+";
      } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_DEVICE_REMOVED) {
        gst_message_parse_device_removed(message, &device);
        change = "-";
      }  // else of the monitor itself, since 1.28
      if (device) change += text_in(device, "device");
      gst_clear_object(&device);
      gst_message_unref(message);
    }
    gst_object_unref(bus);
    return change;
  }

  GstDeviceMonitor* monitor_;
};

TEST_F(DeviceProvider, ListsBoardsAndTheSimulatedOne) {
  plug(0, UsbKind::kSh4, "A1");
  plug(1, UsbKind::kSimple).forbidden = true;
  plug(2, UsbKind::kMouse);
  plug(3, UsbKind::kFalcon);
  Devices found = devices();
  EXPECT_EQ(found.size(), 5u);
  ASSERT_EQ(found.count("usb:1-1"), 1u);
  ASSERT_EQ(found.count("usb:1-2"), 1u);
  ASSERT_EQ(found.count("mouse:1-3"), 1u);
  ASSERT_EQ(found.count("falcon:1-4"), 1u);
  ASSERT_EQ(found.count("sim"), 1u);
  GstDevice* sh4 = found["usb:1-1"];
  EXPECT_EQ(text_in(sh4, "board"), "CyVerse USB 2.0 SH4");
  EXPECT_EQ(text_in(sh4, "evidence"), "emulated");
  EXPECT_EQ(text_in(sh4, "bus-path"), "1-1");
  EXPECT_EQ(text_in(sh4, "serial"), "A1");
  EXPECT_EQ(text_in(sh4, "usb-id"), "0cec:0205");
  EXPECT_EQ(text_in(found["mouse:1-3"], "evidence"), "inferred");
  EXPECT_NE(text_in(found["usb:1-2"], "note").find("udev rule"), std::string::npos);
  gboolean accessible = TRUE;
  GstStructure* properties = gst_device_get_properties(found["usb:1-2"]);
  EXPECT_TRUE(gst_structure_get_boolean(properties, "accessible", &accessible));
  EXPECT_FALSE(accessible);
  gst_structure_free(properties);
  EXPECT_TRUE(gst_device_has_classes(sh4, "Haptic/SPIDAR"));
  EXPECT_TRUE(gst_device_has_classes(sh4, "Sink/Haptic"));
  char* name = gst_device_get_display_name(sh4);
  EXPECT_STREQ(name, "CyVerse USB 2.0 SH4 (usb:1-1)");
  g_free(name);
  forget(found);
}

TEST_F(DeviceProvider, ListsForceFeedbackDevices) {
  plug_evdev(0, EvdevKind::kKeyboard);
  plug_evdev(1, EvdevKind::kPad);
  plug_evdev(2, EvdevKind::kStick);
  Devices found = devices();
  EXPECT_EQ(found.size(), 3u);
  ASSERT_EQ(found.count("ff:/dev/input/event1"), 1u);
  ASSERT_EQ(found.count("ff:/dev/input/event2"), 1u);
  GstDevice* stick = found["ff:/dev/input/event2"];
  EXPECT_EQ(text_in(stick, "board"), "Emulated Stick");
  EXPECT_EQ(text_in(stick, "evidence"), "emulated");
  EXPECT_EQ(text_in(stick, "bus-path"), "/dev/input/event2");
  EXPECT_EQ(text_in(stick, "usb-id"), "1209:0001");
  EXPECT_EQ(text_in(found["ff:/dev/input/event1"], "note"),
            "rumble only: strength without direction");
  EXPECT_TRUE(gst_device_has_classes(stick, "Haptic/SPIDAR"));
  GstElement* element = gst_device_create_element(stick, nullptr);
  ASSERT_NE(element, nullptr);
  gst_object_ref_sink(element);
  EXPECT_EQ(property_of(element, "device"), "ff:/dev/input/event2");
  gst_object_unref(element);
  for (const EvdevPort& port : bus().evdev) EXPECT_EQ(port.uploads, 0u);
  forget(found);

  ASSERT_TRUE(gst_device_monitor_start(monitor_));
  EXPECT_EQ(next_change(), "+ff:/dev/input/event2");
  EXPECT_EQ(next_change(), "+ff:/dev/input/event1");
  EXPECT_EQ(next_change(), "+sim");
  plug_evdev(3, EvdevKind::kWheel);
  EXPECT_EQ(next_change(), "+ff:/dev/input/event3");
  unplug_evdev(2);
  EXPECT_EQ(next_change(), "-ff:/dev/input/event2");
  gst_device_monitor_stop(monitor_);
}

TEST_F(DeviceProvider, MakesAnElementThatOpensTheDevice) {
  plug(0, UsbKind::kSh4);
  Devices found = devices();
  for (const auto& [spec, device] : found) {
    SCOPED_TRACE(spec);
    GstElement* element = gst_device_create_element(device, "feel");
    ASSERT_NE(element, nullptr);
    gst_object_ref_sink(element);
    EXPECT_EQ(property_of(element, "device"), spec);
    // Nobody has named one for the board, whose motors therefore get no force.
    EXPECT_EQ(property_of(element, "profile"), spec == "sim" ? "spidar-gcc" : "");
    EXPECT_STREQ(GST_OBJECT_NAME(element), "feel");
    gst_object_unref(element);
  }
  forget(found);
}

TEST_F(DeviceProvider, ReconfiguresAnElementThatIsNotOpen) {
  plug(0, UsbKind::kSh4);
  Devices found = devices();
  GstElement* element = gst_device_create_element(found["sim"], nullptr);
  gst_object_ref_sink(element);
  EXPECT_TRUE(gst_device_reconfigure_element(found["usb:1-1"], element));
  EXPECT_EQ(property_of(element, "device"), "usb:1-1");
  EXPECT_TRUE(gst_device_reconfigure_element(found["sim"], element));
  ASSERT_NE(gst_element_set_state(element, GST_STATE_READY), GST_STATE_CHANGE_FAILURE);
  EXPECT_FALSE(gst_device_reconfigure_element(found["usb:1-1"], element));
  EXPECT_EQ(property_of(element, "device"), "sim");
  gst_element_set_state(element, GST_STATE_NULL);
  gst_object_unref(element);
  GstElement* other = gst_bin_new(nullptr);
  gst_object_ref_sink(other);
  EXPECT_FALSE(gst_device_reconfigure_element(found["sim"], other));
  gst_object_unref(other);
  forget(found);
}

TEST_F(DeviceProvider, TellsWhatComesAndGoes) {
  plug(0, UsbKind::kSh4);
  ASSERT_TRUE(gst_device_monitor_start(monitor_));
  EXPECT_EQ(next_change(), "+usb:1-1");
  EXPECT_EQ(next_change(), "+sim");
  plug(3, UsbKind::kSimple);
  EXPECT_EQ(next_change(), "+usb:1-4");
  unplug(0);
  EXPECT_EQ(next_change(), "-usb:1-1");
  // udev gives the permission some time after the board is there.
  bus().port[3].forbidden = true;
  EXPECT_EQ(next_change(), "-usb:1-4");
  EXPECT_EQ(next_change(), "+usb:1-4");
  Devices found = devices();
  EXPECT_EQ(found.size(), 2u);
  EXPECT_NE(text_in(found["usb:1-4"], "note"), "endpoints and D/A range are inferred");
  forget(found);
  gst_device_monitor_stop(monitor_);
  // A second time, from the beginning.
  ASSERT_TRUE(gst_device_monitor_start(monitor_));
  gst_device_monitor_stop(monitor_);
}

}  // namespace
}  // namespace spidar::test::device_provider_test
