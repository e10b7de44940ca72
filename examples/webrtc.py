#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A call by WebRTC whose video is felt where it is received; both ends are in one pipeline."""

import signal

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstWebRTC", "1.0")
gi.require_version("GstSdp", "1.0")
from gi.repository import Gst, GstSdp, GstWebRTC  # noqa: E402

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl+C ends it
Gst.init(None)
call = Gst.parse_launch("videotestsrc is-live=true pattern=ball ! vp8enc deadline=1 ! rtpvp8pay ! application/x-rtp,"
                        "media=video,encoding-name=VP8,payload=96 ! webrtcbin name=a  webrtcbin name=b")
a, b = map(call.get_by_name, "ab")

def answered(promise, *_):
    reply = promise.get_reply()  # owns the answer
    answer = reply.get_value("answer")
    b.emit("set-local-description", answer, None), a.emit("set-remote-description", answer, None)

def offered(promise, *_):
    reply = promise.get_reply()
    offer = reply.get_value("offer")
    a.emit("set-local-description", offer, None), b.emit("set-remote-description", offer, None)
    b.emit("create-answer", None, Gst.Promise.new_with_change_func(answered, None))

def came(_, pad):
    felt = Gst.parse_bin_from_description("rtpvp8depay ! vp8dec ! videoconvert ! spidarmotion ! autovideosink", True)
    call.add(felt), felt.sync_state_with_parent(), pad.link(felt.get_static_pad("sink"))

a.connect("on-ice-candidate", lambda _, line, candidate: b.emit("add-ice-candidate", line, candidate))
b.connect("on-ice-candidate", lambda _, line, candidate: a.emit("add-ice-candidate", line, candidate))
a.connect("on-negotiation-needed", lambda _: a.emit(
    "create-offer", None, Gst.Promise.new_with_change_func(offered, None)))
b.connect("pad-added", came)
print("a moving ball is sent to this same program by WebRTC, until it is felt", flush=True)
call.set_state(Gst.State.PLAYING)
found = None
while found is None or not found.has_name("spidar-motion") or found.get_value("no-force-reason") != "none":
    found = call.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, Gst.MessageType.ELEMENT).get_structure()
print(f"felt: {found.get_value('force-x'):+.2f} N right, {found.get_value('force-y'):+.2f} N up")
call.set_state(Gst.State.NULL)
