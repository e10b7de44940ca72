# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""SPIDARs in the list of GstDeviceMonitor, while boards are plugged into an emulated USB."""

import unittest

import bus_case
import gst_case  # initialises GStreamer
from bus_case import Evdev, Usb, bus
from gst_case import Gst


def field(device, name):
    return device.get_properties().get_value(name)


class DeviceProvider(bus_case.BusCase):
    def setUp(self):
        super().setUp()
        self.monitor = Gst.DeviceMonitor.new()
        self.assertTrue(self.monitor.add_filter("Haptic/SPIDAR"))
        self.addCleanup(lambda: self.assertEqual([bus.bus_updates(port) for port in range(4)], [0] * 4,
                                                 "a board was sent something"))

    def devices(self):
        return {field(device, "device"): device for device in self.monitor.get_devices()}

    def next_change(self):
        """The next event as "+usb:1-1" or "-usb:1-1"; waits for it."""
        while True:  # the monitor has messages of itself, since 1.28
            message = self.monitor.get_bus().timed_pop(Gst.CLOCK_TIME_NONE)
            if message.type == Gst.MessageType.DEVICE_ADDED:
                return "+" + field(message.parse_device_added(), "device")
            if message.type == Gst.MessageType.DEVICE_REMOVED:
                return "-" + field(message.parse_device_removed(), "device")

    def expect_changes(self, *changes):
        for change in changes:
            self.assertEqual(self.next_change(), change)

    def test_boards_and_the_simulated_one_are_listed(self):
        bus.bus_plug_named(0, Usb.SH4, b"A1")
        for port, kind in ((1, Usb.SIMPLE), (2, Usb.MOUSE), (3, Usb.FALCON)):
            bus.bus_plug(port, kind)
        bus.bus_forbid(1, True)
        found = self.devices()
        self.assertEqual(set(found), {"usb:1-1", "usb:1-2", "mouse:1-3", "falcon:1-4", "sim"})
        sh4 = found["usb:1-1"]
        self.assertEqual([field(sh4, name) for name in ("board", "evidence", "bus-path", "serial", "usb-id")],
                         ["CyVerse USB 2.0 SH4", "emulated", "1-1", "A1", "0cec:0205"])
        self.assertEqual(field(found["mouse:1-3"], "evidence"), "inferred")
        self.assertIn("udev rule", field(found["usb:1-2"], "note"))
        self.assertIs(field(found["usb:1-2"], "accessible"), False)
        self.assertTrue(sh4.has_classes("Haptic/SPIDAR") and sh4.has_classes("Sink/Haptic"))
        self.assertEqual(sh4.get_display_name(), "CyVerse USB 2.0 SH4 (usb:1-1)")

    def test_force_feedback_devices_are_listed(self):
        for number, kind in ((0, Evdev.KEYBOARD), (1, Evdev.PAD), (2, Evdev.STICK)):
            bus.evdev_plug(number, kind)
        found = self.devices()
        self.assertEqual(set(found), {"ff:/dev/input/event1", "ff:/dev/input/event2", "sim"})
        stick = found["ff:/dev/input/event2"]
        self.assertEqual([field(stick, name) for name in ("board", "evidence", "bus-path", "usb-id")],
                         ["Emulated Stick", "emulated", "/dev/input/event2", "1209:0001"])
        self.assertEqual(field(found["ff:/dev/input/event1"], "note"), "rumble only: strength without direction")
        self.assertTrue(stick.has_classes("Haptic/SPIDAR"))
        self.assertEqual(stick.create_element(None).get_property("device"), "ff:/dev/input/event2")
        self.monitor.start()
        self.addCleanup(self.monitor.stop)
        self.expect_changes("+ff:/dev/input/event2", "+ff:/dev/input/event1", "+sim")
        bus.evdev_plug(3, Evdev.WHEEL)
        self.expect_changes("+ff:/dev/input/event3")
        bus.evdev_unplug(2)
        self.expect_changes("-ff:/dev/input/event2")
        self.assertEqual([bus.evdev_uploads(number) for number in range(4)], [0] * 4)

    def test_each_makes_an_element_that_opens_it(self):
        bus.bus_plug(0, Usb.SH4)
        for spec, device in self.devices().items():
            element = device.create_element("feel")
            # Nobody has named a profile for the board, whose motors therefore get no force.
            self.assertEqual((element.get_property("device"), element.get_property("profile"), element.get_name()),
                             (spec, "spidar-gcc" if spec == "sim" else None, "feel"))

    def test_an_element_is_reconfigured_unless_it_is_open(self):
        bus.bus_plug(0, Usb.SH4)
        found = self.devices()
        element = found["sim"].create_element(None)
        self.assertTrue(found["usb:1-1"].reconfigure_element(element))
        self.assertEqual(element.get_property("device"), "usb:1-1")
        self.assertTrue(found["sim"].reconfigure_element(element))
        self.assertEqual(element.set_state(Gst.State.READY), Gst.StateChangeReturn.SUCCESS)
        self.assertFalse(found["usb:1-1"].reconfigure_element(element))
        self.assertEqual(element.get_property("device"), "sim")
        element.set_state(Gst.State.NULL)
        self.assertFalse(found["sim"].reconfigure_element(Gst.Bin.new(None)))

    def test_what_comes_and_goes_is_told(self):
        bus.bus_plug(0, Usb.SH4)
        self.monitor.start()
        self.expect_changes("+usb:1-1", "+sim")
        bus.bus_plug(3, Usb.SIMPLE)
        self.expect_changes("+usb:1-4")
        bus.bus_unplug(0, 0)
        self.expect_changes("-usb:1-1")
        # udev gives the permission some time after the board is there.
        bus.bus_forbid(3, True)
        self.expect_changes("-usb:1-4", "+usb:1-4")
        found = self.devices()
        self.assertEqual(len(found), 2)
        self.assertNotEqual(field(found["usb:1-4"], "note"), "endpoints and D/A range are inferred")
        self.monitor.stop()
        # A second time, from the beginning.
        self.assertTrue(self.monitor.start())
        self.monitor.stop()


if __name__ == "__main__":
    unittest.main()
