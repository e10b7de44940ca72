# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Pipelines with boards and joysticks on an emulated bus, which are pulled out and put back while a film plays."""

import errno
import os
import re
import signal
import subprocess
import unittest
import unittest.mock

import bus_case
import gst_case
from bus_case import PROFILE, Evdev, bus, wait_for
from gst_case import Gst

BALL = "videotestsrc pattern=ball motion=sweep ! video/x-raw,width=160,height=120 ! spidarmotion name=m device="
SHORT = "videotestsrc num-buffers=3 ! video/x-raw,width=160,height=120 ! "


class Pipelines(bus_case.BusCase):
    def start(self, line):
        pipeline = Gst.parse_launch(line)
        self.addCleanup(pipeline.set_state, Gst.State.NULL)
        self.assertNotEqual(pipeline.set_state(Gst.State.PLAYING), Gst.StateChangeReturn.FAILURE)
        return pipeline

    @staticmethod
    def next_device(pipeline):
        """State and name of the next message about the device, and whether it says why."""
        while True:
            message = pipeline.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, Gst.MessageType.ELEMENT).get_structure()
            if message.get_name() == "spidar-device":
                return message.get_value("state"), message.get_value("device"), message.get_value("reason") != ""

    def next_warning(self, pipeline):
        """The text of the next warning; "eos" at the end."""
        message = pipeline.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, gst_case.ENDS | Gst.MessageType.WARNING)
        self.assertNotEqual(message.type, Gst.MessageType.ERROR)
        return "eos" if message.type == Gst.MessageType.EOS else message.parse_warning()[0].message

    @staticmethod
    def wait_for_frames(pipeline, frames):
        """From now on."""
        pipeline.bus.set_flushing(True)
        pipeline.bus.set_flushing(False)
        while frames:
            message = pipeline.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, Gst.MessageType.ELEMENT)
            frames -= message.get_structure().get_name() == "spidar-motion"


class Refused(Pipelines):
    """What a program is told of a device that cannot be opened."""

    def refusal(self, element):
        """Of spidarmotion or spidarsink in READY: code, text and debug text of the warning, and the message."""
        element.set_bus(Gst.Bus.new())
        self.assertEqual(element.set_state(Gst.State.READY), Gst.StateChangeReturn.SUCCESS)
        element.set_state(Gst.State.NULL)
        message = element.get_bus().pop_filtered(Gst.MessageType.ELEMENT).get_structure()
        error, debug = element.get_bus().pop_filtered(Gst.MessageType.WARNING).parse_warning()
        self.assertEqual(error.domain, "gst-resource-error-quark")
        self.assertEqual((message.get_name(), message.get_value("state"), message.get_value("reason")),
                         ("spidar-device", "refused", error.message))
        self.assertEqual(message.get_value("device"), element.get_property("device"))
        return error.code, error.message, debug

    def test_kinds_of_trouble_have_codes_of_their_own_and_their_place(self):
        absent, settings = Gst.ResourceError.NOT_FOUND, Gst.ResourceError.SETTINGS
        no_board = "usb: no CyVerse USB 2.0 SH4 (0cec:0205) or "
        for device, code, said, place in (
                ("ff", absent, "is plugged in", "evdev_transport.cpp"),
                ("ff:/dev/input/event99", absent, "No such file", "evdev_transport.cpp"),
                ("ff:/dev/null", settings, "it is no input device", "evdev_transport.cpp"),
                ("falcon", absent, "is plugged in", "usb_search.cpp"), ("mouse", absent, "is plugged in", "usb_search.cpp"),
                ("usb", absent, no_board, "usb_search.cpp"), ("usb:7", absent, "is plugged in", "usb_search.cpp"),
                ("inverse3:1,port=1", absent, "no service answers", "websocket_transport.cpp"),
                ("uart:/dev/ttyUSB9", absent, "uart:/dev/ttyUSB9: /dev/ttyUSB9: No such file", "profile_choice.cpp"),
                ("telepathy", settings, "known are", "device_factory.cpp"), ("ff:", settings, "known are", "device_factory.cpp")):
            for name in ("spidarmotion", "spidarsink"):
                with self.subTest(device=device, element=name):
                    element = Gst.ElementFactory.make(name)
                    element.set_property("device", device)
                    found, text, debug = self.refusal(element)
                    if "-Dwebsockets=enabled" in text:
                        continue
                    self.assertEqual(found, code, text)
                    self.assertIn(said, text)
                    self.assertNotIn("Profiles that fit", text)
                    self.assertIn(place, debug.split("(")[0])

    def test_boards_that_are_there_are_told_from_those_that_are_not(self):
        bus.bus_plug(0, b"sh4")
        element = Gst.parse_launch(f"spidarmotion device=usb {PROFILE}")
        holder = Gst.parse_launch(f"spidarmotion device=usb {PROFILE}")
        self.assertEqual(holder.set_state(Gst.State.READY), Gst.StateChangeReturn.SUCCESS)
        self.assertEqual(self.refusal(element)[0], Gst.ResourceError.BUSY)
        holder.set_state(Gst.State.NULL)
        bus.bus_forbid(0, True)
        self.assertEqual(self.refusal(element)[0], Gst.ResourceError.NOT_AUTHORIZED)
        bus.bus_forbid(0, False)
        self.assertEqual(self.refusal(Gst.parse_launch("spidarmotion device=usb"))[0], Gst.ResourceError.SETTINGS)
        bus.bus_plug(1, b"simple")
        code, text, _ = self.refusal(Gst.parse_launch("spidarmotion device=usb"))
        self.assertEqual(code, Gst.ResourceError.SETTINGS)
        self.assertIn("there are several boards, name one of usb:1-1 usb:1-2", text)
        self.assertEqual(bus.bus_updates(1), 0)


class Auto(Pipelines):
    """The first that gives a force."""

    def chosen(self, line=""):
        """Device and reason of the message that it is opened; the information message says the same."""
        element = Gst.parse_launch("spidarmotion device=auto " + line)
        element.set_bus(Gst.Bus.new())
        self.assertEqual(element.set_state(Gst.State.READY), Gst.StateChangeReturn.SUCCESS)
        name = element.get_property("stats").get_value("device")
        element.set_state(Gst.State.NULL)
        told = element.get_bus().pop_filtered(Gst.MessageType.ELEMENT).get_structure()
        self.assertEqual((told.get_value("state"), told.get_value("device")), ("opened", name))
        self.assertEqual(told.get_value("simulated"), name.startswith("sim"))
        information, debug = element.get_bus().pop_filtered(Gst.MessageType.INFO).parse_info()
        self.assertIsNone(element.get_bus().pop_filtered(Gst.MessageType.INFO))
        begin = f"{name}: {told.get_value('reason')}. "
        self.assertTrue(information.message.startswith(begin), information.message)
        # What it renders. gst-launch-1.0 prints nothing but the debug text.
        self.renders = information.message[len(begin):]
        self.assertIn(information.message, debug)
        self.assertEqual(element.get_property("device"), "auto")
        return name, told.get_value("reason")

    def test_without_anything_it_is_simulated(self):
        self.assertEqual(self.chosen(),
                         ("sim", "simulated, because nothing that gives a force can be used (device=auto)"))
        renders = r"^It renders force in every direction, up to (\d+\.\d) N \(3 N by max-force\), and torque\.$"
        self.assertRegex(self.renders, renders)
        # What is said is accepted.
        element = Gst.parse_launch(f"spidarmotion device=sim max-force={re.search(renders, self.renders)[1]}")
        element.set_bus(Gst.Bus.new())
        element.set_state(Gst.State.READY)
        self.assertIsNone(element.get_bus().pop_filtered(Gst.MessageType.WARNING))
        element.set_state(Gst.State.NULL)

    def test_what_has_a_direction_comes_before_what_rumbles(self):
        bus.evdev_plug(0, Evdev.KEYBOARD)
        bus.evdev_plug(1, Evdev.PAD)
        self.assertEqual(self.chosen(), ("ff:/dev/input/event1", "a gamepad that rumbles (device=auto)"))
        self.assertEqual(self.renders, "Emulated Pad, rumble only: the strength of the force is felt, not its direction.")
        # A Falcon comes before it, but this one has no firmware.
        bus.bus_plug(0, b"falcon")
        device, why = self.chosen()
        self.assertEqual(device, "ff:/dev/input/event1")
        self.assertIn("a gamepad that rumbles (device=auto); not falcon:1-1: has not got its firmware", why)
        bus.evdev_plug(2, Evdev.WHEEL)
        self.assertEqual(self.chosen(),
                         ("ff:/dev/input/event2", "a joystick or wheel with directional force (device=auto)"))

    def test_a_board_is_driven_only_with_a_profile_that_was_confirmed(self):
        bus.bus_plug_named(0, b"sh4", b"A1")
        bus.bus_plug(1, b"mouse")
        with unittest.mock.patch.dict(os.environ, XDG_CONFIG_HOME=str(self.folder)):
            device, why = self.chosen()
            self.assertEqual(device, "sim")
            self.assertEqual(bus.bus_updates(0), 0)
            self.assertIn("; not usb:1-1: this CyVerse USB 2.0 SH4 has no confirmed profile, without which its motors get no "
                          "force; confirm it: spidarctl choose usb:1-1 --profile NAME (Profiles that fit it: spidar-g", why)
            self.assertIn("; not mouse:1-2: a SPIDAR-mouse is used only with device=mouse", why)
            bus.bus_plug(2, b"sh4")  # has no serial number
            self.assertIn("name it each time: device=usb:1-3 profile=NAME", self.chosen()[1])
            self.path("gst-spidar").mkdir()
            self.path("gst-spidar/boards.toml").write_text('"0cec:0205 A1" = "spidar-g6x3-v2-l"\n')
            bus.evdev_plug(0, Evdev.STICK)
            self.assertEqual(self.chosen(), ("usb:1-1", "a SPIDAR whose profile was confirmed (device=auto)"))

    def test_a_profile_that_is_named_is_for_its_board(self):
        bus.bus_plug_named(0, b"sh4", b"A1")
        bus.evdev_plug(0, Evdev.STICK)
        with unittest.mock.patch.dict(os.environ, XDG_CONFIG_HOME=str(self.folder)):
            self.assertEqual(self.chosen(PROFILE), ("usb:1-1", "the SPIDAR that is plugged in, with " + PROFILE + " (device=auto)"))
            # It would not say for which of two.
            bus.bus_plug_named(1, b"sh4", b"A2")
            device, why = self.chosen(PROFILE)
            self.assertEqual(device, "ff:/dev/input/event0")
            self.assertIn("; not usb:1-2: this CyVerse USB 2.0 SH4 has no confirmed profile", why)
            self.path("gst-spidar").mkdir()
            self.path("gst-spidar/boards.toml").write_text(
                '"0cec:0205 A1" = "spidar-g6x3-v2-l"\n"0cec:0205 A2" = "spidar-g6x3-v2-r"\n')
            self.assertEqual(self.chosen(PROFILE), ("usb:1-2", "a SPIDAR whose profile was confirmed (device=auto)"))
            self.assertIn("; not usb:1-1: its confirmed profile is spidar-g6x3-v2-l, and not spidar-g; device=usb:1-1 "
                          "profile=spidar-g uses this one once", self.chosen("profile=spidar-g")[1])
            # One that does not fit is passed over, and why is said.
            bus.bus_unplug(1, errno.ENODEV)
            self.path("gst-spidar/boards.toml").unlink()
            device, why = self.chosen("profile=spidar-g6c")
            self.assertEqual(device, "ff:/dev/input/event0")
            self.assertIn('not usb:1-1: profile "spidar-g6c" is for boards of the kind usb-simple', why)

    def test_a_board_that_was_named_is_said_too(self):
        bus.bus_plug(0, b"sh4")
        said = self.run_in_folder(f"gst-launch-1.0 videotestsrc num-buffers=3 ! spidarmotion device=usb {PROFILE} ! fakesink")
        self.assertRegex(said, r"usb: at 1-1: CyVerse USB 2.0 SH4, rotary switch 0. It renders force in every direction, up to \d+\.\d N \(3 N by max-force\), and torque\.")

    def test_another_profile_than_the_confirmed_one_is_warned_of(self):
        bus.bus_plug_named(0, b"sh4", b"A1")
        self.path("gst-spidar").mkdir()
        with unittest.mock.patch.dict(os.environ, XDG_CONFIG_HOME=str(self.folder)):
            play = lambda profile: self.run_in_folder(
                f"gst-launch-1.0 videotestsrc num-buffers=3 ! spidarmotion device=usb {profile} max-force=0.5 ! fakesink")
            self.assertNotIn("was confirmed", play(PROFILE))
            self.path("gst-spidar/boards.toml").write_text('"0cec:0205 A1" = "spidar-g6x3-v2-l"\n')
            said = play("profile=spidar-g645")
            self.assertIn("profile=spidar-g645 drives usb, for which profile spidar-g6x3-v2-l was confirmed", said)
            self.assertIn("N (0.5 N by max-force), and torque", said)
            for same in "profile=spidar-g6x3-v2-l", "":
                self.assertNotIn("was confirmed:", play(same))

    def test_what_cannot_be_opened_is_passed_over_and_named(self):
        bus.evdev_plug(0, Evdev.STICK)
        bus.evdev_plug(1, Evdev.PAD)
        holder = Gst.parse_launch("spidarmotion device=ff:/dev/input/event0")
        self.assertEqual(holder.set_state(Gst.State.READY), Gst.StateChangeReturn.SUCCESS)
        device, why = self.chosen()
        holder.set_state(Gst.State.NULL)
        self.assertEqual(device, "ff:/dev/input/event1")
        self.assertRegex(why, r"^a gamepad that rumbles \(device=auto\); not ff:/dev/input/event0: .*another program uses it")


class Boards(Pipelines):
    LINE = f"{BALL}usb profile=spidar-g645 ! fakesink sync=true"  # its source names no board: it is for each

    def play(self):
        bus.bus_plug(0, b"sh4")
        pipeline = self.start(self.LINE)
        wait_for(lambda: not bus.bus_at_rest(0))
        return pipeline

    def test_the_second_to_ask_for_one_has_none_and_the_first_plays_on(self):
        first = self.play()
        second = Gst.parse_launch(self.LINE)
        second.get_by_name("m").set_property("on-device-error", "error")
        self.assertEqual(second.set_state(Gst.State.PLAYING), Gst.StateChangeReturn.FAILURE)
        self.assertIn("another element", second.bus.pop_filtered(Gst.MessageType.ERROR).parse_error()[0].message)
        second.set_state(Gst.State.NULL)
        second = self.start(self.LINE)
        self.assertIn("another element", self.next_warning(second))
        self.wait_for_frames(second, 3)
        second.set_state(Gst.State.NULL)
        self.wait_for_frames(first, 5)
        wait_for(lambda: not bus.bus_at_rest(0))  # again, where a busy machine had it set to rest
        first.set_state(Gst.State.NULL)
        self.assertTrue(bus.bus_at_rest(0))

    def test_one_that_cannot_be_opened_gets_no_force_and_the_video_goes_on(self):
        """A wrong profile pulls with other forces than wanted, and where it should let go."""
        bus.bus_plug(0, b"simple")
        for device, said in (("usb", "usb:1-1: the motors get no force: no profile is named.* spidar-g6c, "),
                             (f"usb:7 {PROFILE}", "usb:7")):
            for sink in (f"spidarmotion device={device} ! fakesink", "fakesink audiotestsrc wave=silence num-buffers=3 ! "
                         f"audio/x-raw,rate=1000,channels=6,channel-mask=(bitmask)0 ! spidarsink accept-unmarked=true device={device}"):
                pipeline = self.start(SHORT + sink)
                self.assertRegex(self.next_warning(pipeline), said)
                self.assertEqual(self.next_warning(pipeline), "eos")
                pipeline.set_state(Gst.State.NULL)
        self.assertEqual(bus.bus_updates(0), 0)

    def test_one_whose_lag_nobody_measured_is_touched_gently(self):
        """A simulated one has exactly the lag of its profile."""
        bus.bus_plug(0, b"sh4")
        for device, said, stiffness in (("usb", "touch-stiffness is 500 N/m, but the lag of this device", 200),
                                        ("sim:sh4", "eos", 500)):
            pipeline = self.start(f"{SHORT} spidarmotion name=m {PROFILE} touch=luma device={device} ! fakesink")
            self.assertTrue(self.next_warning(pipeline).startswith(said))
            self.assertEqual(pipeline.get_by_name("m").get_property("stats").get_value("touch-stiffness"), stiffness)
            pipeline.set_state(Gst.State.NULL)



class Joysticks(Pipelines):
    def play(self):
        bus.evdev_plug_at(0, Evdev.STICK, b"port 1")
        pipeline = self.start(BALL + "ff ! fakesink sync=true")
        wait_for(lambda: not bus.evdev_at_rest(0))
        return pipeline

    def test_no_frame_waits_for_a_driver_that_hangs(self):
        """No limit of time: if the streaming thread waited for the device, no frame would pass until the driver returns,
        which is after 30 frames have passed. Lateness is measured in the suite `kernel`, whose time does not depend on
        the machine."""
        pipeline = self.play()
        bus.evdev_hang(0, True)
        wait_for(lambda: bus.evdev_hanging(0) == 1)
        uploads = bus.evdev_uploads(0)
        self.wait_for_frames(pipeline, 30)
        # Nor does the application wait when it pauses the film.
        pipeline.set_state(Gst.State.PAUSED)
        self.assertEqual(pipeline.get_state(Gst.CLOCK_TIME_NONE)[0], Gst.StateChangeReturn.SUCCESS)
        self.assertEqual((bus.evdev_hanging(0), bus.evdev_uploads(0)), (1, uploads), "all that time, one upload")
        bus.evdev_hang(0, False)
        wait_for(lambda: bus.evdev_at_rest(0))

    def test_messages_say_that_it_is_opened_lost_and_back(self):
        pipeline = self.play()
        self.assertEqual(self.next_device(pipeline), ("opened", "ff", True))
        bus.evdev_unplug(0)
        self.assertEqual(self.next_device(pipeline), ("lost", "ff", True))
        # Its number goes to another device, which gets no force.
        bus.evdev_plug_at(0, Evdev.WHEEL, b"port 2")
        self.assertEqual(self.next_device(pipeline), ("refused", "ff", True))
        self.assertTrue(bus.evdev_at_rest(0))
        bus.evdev_plug_at(1, Evdev.STICK, b"port 1")
        self.assertEqual(self.next_device(pipeline), ("back", "ff", False))

    def test_what_is_not_felt_is_said_once(self):
        strength = "Emulated {} at 20 % of its strength, force feedback on {}"
        for kind, said in ((Evdev.PAD, "Emulated Pad, rumble only: the strength of the force is felt, not its direction."),
                           (Evdev.WHEEL, strength.format("Racing Wheel", "one axis: forces up and down are not felt.")),
                           (Evdev.STICK, strength.format("Stick", "two axes."))):
            for name in ("spidarmotion", "spidarsink"):
                bus.evdev_plug(0, kind)
                element = Gst.ElementFactory.make(name)
                element.set_property("device", "ff")
                element.set_bus(Gst.Bus.new())
                self.assertEqual(element.set_state(Gst.State.READY), Gst.StateChangeReturn.SUCCESS)
                element.set_state(Gst.State.NULL)
                infos = []
                while message := element.get_bus().pop_filtered(Gst.MessageType.INFO):
                    infos.append(message.parse_info()[0].message)
                self.assertEqual(infos, [said], name)
                bus.bus_clear()

    def test_that_the_player_stood_still_is_said(self):
        bus.evdev_plug(0, Evdev.STICK)
        with open(self.path("log"), "wb") as log:
            running = subprocess.Popen(["gst-launch-1.0", *(BALL + "ff ! fakesink sync=true").split()], stdout=log,
                                       stderr=subprocess.STDOUT)
        said = ""
        # Again if the device was back before a frame was due, which a busy machine can delay.
        while "WARNING" not in said:
            wait_for(lambda: not bus.evdev_at_rest(0) or running.poll() is not None)
            self.assertIsNone(running.poll())
            running.send_signal(signal.SIGSTOP)
            wait_for(lambda: not bus.evdev_plays(0))  # stopped by the guardian
            running.send_signal(signal.SIGCONT)
            wait_for(lambda: bus.evdev_plays(0) or running.poll() is not None)
            said = self.path("log").read_text()
        running.send_signal(signal.SIGINT)
        running.wait()
        self.assertIn("The haptic device was set to rest, because the player stood still. The video continues "
                      "without it.", said)


if __name__ == "__main__":
    unittest.main()
