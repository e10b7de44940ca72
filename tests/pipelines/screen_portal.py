# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A stand-in for the desktop's portal that shares screens (org.freedesktop.portal.ScreenCast) on a session bus, and a real
PipeWire with a film, which it shares."""

import json
import os
import shutil
import socket
import subprocess
import threading
import time

import gi

gi.require_version("Gio", "2.0")
gi.require_version("Gst", "1.0")
from gi.repository import Gio, GLib, Gst

PATH = "/org/freedesktop/portal/desktop"
SESSION = PATH + "/session/stand_in"
ALLOWED, CANCELLED, FAILED = 0, 1, 2
WINDOW = 2
INTERFACE = Gio.DBusNodeInfo.new_for_xml("""<node><interface name="org.freedesktop.portal.ScreenCast">
  <property name="version" type="u" access="read"/>
  <method name="CreateSession"><arg type="a{sv}" direction="in"/><arg type="o" direction="out"/></method>
  <method name="SelectSources"><arg type="o" direction="in"/><arg type="a{sv}" direction="in"/>
    <arg type="o" direction="out"/></method>
  <method name="Start"><arg type="o" direction="in"/><arg type="s" direction="in"/><arg type="a{sv}" direction="in"/>
    <arg type="o" direction="out"/></method>
  <method name="OpenPipeWireRemote"><arg type="o" direction="in"/><arg type="a{sv}" direction="in"/>
    <arg type="h" direction="out"/></method></interface></node>""").interfaces[0]


class Portal:
    """`pipewire`: the path of its socket; `node`: what it shares."""

    def __init__(self, bus, pipewire="/nowhere", node=0, status=ALLOWED):
        self.pipewire, self.node, self.status = pipewire, node, status
        self.selected = []  # the options of each SelectSources
        self.void = ""  # the method that refuses a token; "response": Start answers that it failed
        self.lies = {}  # what it says to a method in place of an answer
        self.context = GLib.MainContext()
        self.loop = GLib.MainLoop(self.context)
        ready = threading.Event()
        self.thread = threading.Thread(target=self.run, args=(bus.address, ready), daemon=True)
        self.thread.start()
        ready.wait()

    def run(self, address, ready):
        self.context.push_thread_default()
        flags = Gio.DBusConnectionFlags.AUTHENTICATION_CLIENT | Gio.DBusConnectionFlags.MESSAGE_BUS_CONNECTION
        self.connection = Gio.DBusConnection.new_for_address_sync(address, flags)
        self.connection.register_object(PATH, INTERFACE, self.call, lambda *_: GLib.Variant("u", 5), None)
        self.connection.call_sync("org.freedesktop.DBus", "/org/freedesktop/DBus", "org.freedesktop.DBus", "RequestName",
                                  GLib.Variant("(su)", ("org.freedesktop.portal.Desktop", 4)), None, 0, -1)
        ready.set()
        self.loop.run()

    def call(self, _connection, sender, _path, _interface, method, parameters, invocation):
        if method == "OpenPipeWireRemote":
            return self.open_remote(invocation)
        options = parameters.unpack()[-1]
        request = f"{PATH}/request/{sender[1:].replace('.', '_')}/{options['handle_token']}"
        status, results = ALLOWED, {}
        if method == "CreateSession":
            results["session_handle"] = GLib.Variant("s", SESSION)
        elif method == "SelectSources":
            self.selected.append(options)
            if self.void == method and "restore_token" in options:
                return invocation.return_dbus_error("org.freedesktop.portal.Error.InvalidArgument", "no such token")
        else:
            is_void = self.void == "response" and "restore_token" in self.selected[-1]
            status = FAILED if is_void else self.status
            stream = (self.node, {"source_type": GLib.Variant("u", WINDOW)})
            results = {"streams": GLib.Variant("a(ua{sv})", [stream]),
                       "restore_token": GLib.Variant("s", f"token {len(self.selected)}")}
        invocation.return_value(GLib.Variant("(o)", (request,)))
        said = self.lies.get(method, GLib.Variant("(ua{sv})", (status, results)))
        return self.emit(request, "Request", "Response", said)

    def open_remote(self, invocation):
        try:
            with socket.socket(socket.AF_UNIX) as client:
                client.connect(self.pipewire)
                files = Gio.UnixFDList.new()
                invocation.return_value_with_unix_fd_list(GLib.Variant("(h)", (files.append(client.fileno()),)), files)
        except OSError as error:
            invocation.return_dbus_error("org.freedesktop.DBus.Error.Failed", f"PipeWire: {error}")

    def emit(self, path, interface, signal, value):
        self.connection.emit_signal(None, path, "org.freedesktop.portal." + interface, signal, value)

    def end_sharing(self):
        self.emit(SESSION, "Session", "Closed", GLib.Variant("(a{sv})", ({},)))

    def stop(self):
        if not self.connection.is_closed():
            self.connection.close_sync()
        self.loop.quit()


class PipeWire:
    """A daemon with a session manager, in `folder`, whose programs find the session bus `bus`."""
    PROGRAMS = ("pipewire", "wireplumber", "pw-dump")

    def __init__(self, folder, bus):
        self.env = dict(os.environ, XDG_RUNTIME_DIR=str(folder), XDG_STATE_HOME=str(folder), XDG_CONFIG_HOME=str(folder),
                        DBUS_SESSION_BUS_ADDRESS=bus.address, DISPLAY="")
        self.socket = str(folder / "pipewire-0")
        self.running = []
        self.start("pipewire")
        while not os.path.exists(self.socket):
            time.sleep(.02)
        self.start("wireplumber")

    @classmethod
    def why_not(cls):
        missing = [program for program in cls.PROGRAMS if not shutil.which(program)]
        Gst.init(None)
        if not Gst.ElementFactory.find("pipewiresrc"):
            missing.append("pipewiresrc (package gstreamer1.0-pipewire)")
        return f"not installed: {', '.join(missing)}" if missing else ""

    def start(self, *command):
        self.running.append(subprocess.Popen(command, env=self.env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))

    def share(self, line):
        """Shows the pictures of a launch line, and returns their node, which only one program looks at: pipewiresink stops
        for good when that ends."""
        name = f"shared{len(self.running)}"
        self.start("gst-launch-1.0", "-q", *line.split(), "!", "pipewiresink", "mode=provide",
                   f"stream-properties=p,media.class=Video/Source,node.name={name}")
        while True:
            dumped = subprocess.run(["pw-dump"], env=self.env, capture_output=True, text=True, check=False).stdout
            nodes = json.loads(dumped) if dumped.strip() else []
            for each in nodes:
                properties = ((each.get("info") or {}).get("props") or {})
                if properties.get("node.name") == name:
                    return each["id"]
            time.sleep(.05)

    def stop(self):
        for process in reversed(self.running):
            process.kill()
            process.wait()
