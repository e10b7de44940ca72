# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A session bus, and a player on it that tells by MPRIS exactly where it is."""

import shutil
import subprocess
import threading
import time

import gi

gi.require_version("Gio", "2.0")
from gi.repository import Gio, GLib

PLAYER = "org.mpris.MediaPlayer2.Player"
PATH = "/org/mpris/MediaPlayer2"


def interface(has_position=True):
    position = '<property name="Position" type="x" access="read"/>' if has_position else ""
    return Gio.DBusNodeInfo.new_for_xml(f"""<node><interface name="{PLAYER}">
      <property name="PlaybackStatus" type="s" access="read"/><property name="Rate" type="d" access="read"/>
      <property name="Metadata" type="a{{sv}}" access="read"/>{position}
      <method name="PlayPause"/><method name="Seek"><arg type="x" direction="in"/></method>
      <method name="SetPosition"><arg type="o" direction="in"/><arg type="x" direction="in"/></method>
      <signal name="Seeked"><arg name="Position" type="x"/></signal></interface></node>""").interfaces[0]


INTERFACE = interface()


class Bus:
    """Its address is `address`."""

    def __init__(self, settings="--session"):
        self.daemon = subprocess.Popen(["dbus-daemon", settings, "--nofork", "--print-address"], text=True,
                                       stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.address = self.daemon.stdout.readline().strip()

    @staticmethod
    def is_there():
        return bool(shutil.which("dbus-daemon"))

    def stop(self):
        self.daemon.kill()
        self.daemon.wait()
        self.daemon.stdout.close()


class MockPlayer:
    """Stopped at first. `delay` is how late it is in telling its position, in seconds."""
    interface = INTERFACE

    def __init__(self, bus, name):
        self.status, self.rate, self.uri, self.delay = "Stopped", 1.0, "", 0
        self.told_rate = None  # otherwise in place of the one at which it plays
        self.at_s, self.since_s = 0.0, time.monotonic()
        self.context = GLib.MainContext()
        self.loop = GLib.MainLoop(self.context)
        ready = threading.Event()
        self.thread = threading.Thread(target=self.run, args=(bus.address, name, ready), daemon=True)
        self.thread.start()
        ready.wait()

    def run(self, address, name, ready):
        self.context.push_thread_default()
        flags = Gio.DBusConnectionFlags.AUTHENTICATION_CLIENT | Gio.DBusConnectionFlags.MESSAGE_BUS_CONNECTION
        self.connection = Gio.DBusConnection.new_for_address_sync(address, flags)
        self.connection.register_object(PATH, self.interface, self.called, self.get, None)
        self.connection.call_sync("org.freedesktop.DBus", "/org/freedesktop/DBus", "org.freedesktop.DBus", "RequestName",
                                  GLib.Variant("(su)", ("org.mpris.MediaPlayer2." + name, 4)), None, 0, -1)
        ready.set()
        self.loop.run()

    def called(self, _connection, _sender, _path, _interface, method, _parameters, invocation):
        invocation.return_dbus_error("org.freedesktop.DBus.Error.NotSupported", method)

    def get(self, _connection, _sender, _path, _interface, name):
        rate = self.rate if self.told_rate is None else self.told_rate
        values = {"PlaybackStatus": ("s", self.status), "Rate": ("d", rate),
                  "Metadata": ("a{sv}", {"xesam:url": GLib.Variant("s", self.uri)}),
                  "Position": ("x", int(1e6 * self.position_s(time.monotonic() - self.delay)))}
        return GLib.Variant(*values[name])

    def position_s(self, now_s=None):
        """At a time of CLOCK_MONOTONIC."""
        passed = (time.monotonic() if now_s is None else now_s) - self.since_s
        return self.at_s + (self.rate * passed if self.status == "Playing" else 0)

    def change(self, status=None, rate=None, uri=None, position_s=None):
        """And tells of it, as players do."""
        now_s = time.monotonic()
        at_s = self.position_s(now_s) if position_s is None else position_s
        self.at_s, self.since_s = at_s, now_s
        self.status = status or self.status
        self.rate = rate or self.rate
        self.uri = self.uri if uri is None else uri
        changed = {name: self.get(None, None, None, None, name) for name in ("PlaybackStatus", "Rate", "Metadata")}
        self.emit("org.freedesktop.DBus.Properties", "PropertiesChanged", GLib.Variant("(sa{sv}as)", (PLAYER, changed, [])))
        if position_s is not None:
            self.emit(PLAYER, "Seeked", GLib.Variant("(x)", (int(1e6 * position_s),)))

    def emit(self, interface, signal, value):
        self.connection.emit_signal(None, PATH, interface, signal, value)
        self.connection.flush_sync()

    def die(self):
        """As a process that is killed: its connection ends."""
        self.connection.close_sync()
        self.loop.quit()
