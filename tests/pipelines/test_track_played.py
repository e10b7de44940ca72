# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Haptic tracks on all ways of docs/haptic-track.md from a file to the hand, also over the loopback interface, and tracks
that are faulty. In real time; nothing depends on how long anything takes: ticks that come late leave samples out, and
none is wrong. test_track_played.py SDP_FILE"""

import json
import math
import os
import pathlib
import socket
import struct
import subprocess
import sys
import time
import unittest

import gst_case
import track_case
from gst_case import Gst

SDP_FILE = pathlib.Path(sys.argv.pop(1))
# Whole steps of 24 bits, different on each axis: 0.6 N and 40 mN m.
CONSTANT = (.0625, -.03125, .046875, .03125, -.015625, .0234375)
FULL_N = math.hypot(*(value * 10 for value in CONSTANT[:3]))
FRAMES = 10
MS = 400  # as long as the film at 25 frames/s
VIDEO = f"videotestsrc pattern=ball num-buffers={FRAMES} ! video/x-raw,width=64,height=48,framerate=25/1 ! "
RTP = ("application/x-rtp,media=application,clock-rate=90000,encoding-name=X-GST,payload=96")


def write_masked_wav(path, mask):
    """A track whose header says where its channels are. A mask of Windows: 0x60f is 0xc0f of GStreamer."""
    track_case.write_wav(path, [CONSTANT] * MS, marked=False)
    data = path.read_bytes()[36:]
    floats = bytes.fromhex("0300000000001000800000aa00389b71")
    path.write_bytes(b"RIFF" + struct.pack("<I", 60 + len(data)) + b"WAVEfmt " + struct.pack(
        "<IHHIIHHHHI", 40, 0xfffe, 6, 1000, 24000, 24, 32, 22, 32, mask) + floats + data)


class TrackPlayedCase(gst_case.GstCase):
    def felt(self, path):
        """The force of each tick, N. Where samples of the constant were felt, each channel was in its place."""
        rows = gst_case.read_ticks(path)
        self.check_ticks(rows)
        for row in rows:
            if row["found"] in ("exact", "interpolated"):
                wanted = gst_case.vector(row, "wanted_force") + gst_case.vector(row, "wanted_torque", "Nm")
                for value, share, scale in zip(wanted, CONSTANT, track_case.FULL_SCALE):
                    self.assertAlmostEqual(value, share * scale, delta=1e-6)
        return [math.hypot(*gst_case.vector(row, "commanded_force")) for row in rows]

    def expect_felt(self, line):
        """All ticks that felt something felt the constant, and some did."""
        with self.subTest(line):
            for _ in track_case.tries():
                pipeline = self.parse(line)
                outcome = self.play(pipeline)
                self.assertEqual((outcome.error, outcome.warnings), ("", []))
                self.felt(pipeline.watched[-1])
                if any(row["found"] in ("exact", "interpolated") for row in gst_case.read_ticks(pipeline.watched[-1])):
                    return
            self.fail("nothing is felt")


class Channels(TrackPlayedCase):
    """Six constants, different on each channel."""
    TRACKS = ("track.wav", "track.flac", "f32.mka", "flac.mka", "s24.mov", "s32be.mov", "alac.mov")

    def setUp(self):
        super().setUp()
        self.make_track("track.wav", MS, lambda _: CONSTANT)
        for name in ("track.flac", "f32.mka"):
            self.spidartrack("convert", "track.wav", name)
        self.gst("filesrc location=track.flac ! flacparse ! matroskamux ! filesink location=flac.mka")
        # In one, the first byte of a number is the largest.
        for encoding, name in (("S24LE", "s24.mov"), ("S32BE", "s32be.mov")):
            self.gst("filesrc location=track.flac ! flacparse ! flacdec ! capssetter",
                     "caps=audio/x-raw,channel-mask=(bitmask)0x0 ! audioconvert dithering=none noise-shaping=none !",
                     f"audio/x-raw,format={encoding} ! qtmux ! filesink location={name}")
        # Its decoder gives channel after channel.
        self.run_in_folder("ffmpeg -nostdin -v error -i track.flac -c:a alac alac.mov")

    @track_case.needs("ffmpeg")
    def test_every_container_into_the_sink_and_in_place_of_analysis(self):
        for name in self.TRACKS:
            track = self.path(name)
            # ffmpeg makes the mark a tag of the whole MOV, which says nothing of one of its streams.
            options = "accept-unmarked=true" if name == "alac.mov" else ""
            self.expect_felt(f"filesrc location={track} ! decodebin ! spidarsink {options}")
            self.expect_felt(f"{VIDEO} spidarmotion track={track} ! fakesink sync=true")


class BadTracks(TrackPlayedCase):
    # The words that name what is wrong, channels, rate in Hz, and mask.
    CASES = (("5 channels", 5, 1000, 0x37), ("8 channels", 8, 1000, 0xc3f), ("not 48000", 6, 48000, 0x3f),
             ("not 96", 6, 96, 0x3f), ("channel-mask 0xc0f", 6, 1000, 0xc0f))

    def film(self, track, video=VIDEO):
        return self.play(f"{video} spidarmotion track={track} ! queue ! fakesink sync=true")

    def expect_analysed(self, outcome, word):
        self.assertTrue(outcome.eos, outcome.error)
        self.assertIn(word, outcome.warnings[0])
        self.assertEqual(len(outcome.forces), FRAMES)

    def test_for_a_film_they_are_named_and_it_is_analysed_and_in_the_sink_they_are_an_error(self):
        track = self.path("bad.wav")
        for word, channels, rate, mask in self.CASES:
            with self.subTest(word):
                if mask == 0xc0f:
                    write_masked_wav(track, 0x60f)
                else:
                    track_case.write_wav(track, [(.1,) * channels] * (rate * MS // 1000), rate)
                self.expect_analysed(self.film(track), word)
                outcome = self.play(f"filesrc location={track} ! wavparse ! spidarsink")
                self.assertIn(word, outcome.error)

    def test_the_sink_has_only_caps_in_its_template_that_it_accepts(self):
        template, = Gst.ElementFactory.find("spidarsink").get_static_pad_templates()

        def is_accepted(channels, rate, mask):
            return template.get_caps().can_intersect(Gst.Caps.from_string(
                f"audio/x-raw,format=F32LE,layout=interleaved,rate={rate},channels={channels},"
                f"channel-mask=(bitmask){mask:#x}"))

        self.assertFalse([case for case in self.CASES if is_accepted(*case[1:])])
        self.assertTrue(all(is_accepted(6, rate, mask) for rate in (200, 1000, 8000) for mask in (0, 0x3f)))

    def test_samples_that_are_no_numbers_are_rest_and_huge_ones_limited(self):
        samples = [list(CONSTANT) for _ in range(MS)]
        samples[200][0], samples[250][5] = math.nan, -math.inf
        for sample in samples[300:350]:
            sample[1] = 1e30
        track = self.path("bad.wav")
        track_case.write_wav(track, samples)
        pipeline = self.parse(f"filesrc location={track} ! wavparse ! spidarsink name=sink")
        film, sink = self.film(track), self.play(pipeline)
        stats = pipeline.get_by_name("sink").get_property("stats")
        self.assertEqual([stats.get_value(name) for name in ("samples", "samples-not-finite", "samples-beyond-full-scale")],
                         [MS, 2, 50])
        for outcome, first, second in ((film, "2 samples", "50 samples"), (sink, "samples", "samples")):
            self.assertTrue(outcome.eos, outcome.error)
            self.assertEqual(len(outcome.warnings), 2)
            self.assertIn(first + " that are not numbers", outcome.warnings[0])
            self.assertIn(second + " beyond full scale", outcome.warnings[1])

    def test_sound_in_a_track_is_named_at_each_entrance(self):
        """Six channels of a tone that is marked as a track, and a swing at a rate that a hand follows."""
        video = VIDEO.replace(f"num-buffers={FRAMES}", f"num-buffers={4 * FRAMES}")
        def expect(hertz, is_sound):
            track = self.path(f"{hertz}.wav")
            track_case.write_wav(track, [[.1 * math.sin(2 * math.pi * hertz * n / 1000)] * 6 for n in range(4 * MS)])
            for outcome in (self.film(track, video), self.play(f"filesrc location={track} ! wavparse ! spidarsink")):
                self.assertTrue(outcome.eos, outcome.error)
                named = [warning for warning in outcome.warnings if "sound for ears" in warning]
                self.assertEqual(len(named), is_sound, outcome.warnings)

        expect(100, 1)
        expect(5, 0)

    def test_a_truncated_flac_is_named_for_a_film_and_goes_to_rest_in_the_sink(self):
        self.make_track()
        self.spidartrack("convert", "a.wav", "cut.flac")
        track = self.path("cut.flac")
        os.truncate(track, track.stat().st_size * 2 // 3)
        self.expect_analysed(self.film(track), "it is cut off")
        # The check of the ticks looks for rest after the last sample.
        self.play(f"filesrc location={track} ! flacparse ! flacdec ! spidarsink")

    def test_a_track_that_cannot_be_read_further_is_felt_until_there(self):
        """Ten seconds ahead of the first frame, a sample claims to be that of another day."""
        frames = 550  # of 40 ms
        self.make_track(count=20000, sample=lambda ms: CONSTANT)
        self.run_in_folder("ffmpeg -nostdin -v error -i a.wav -af "
                           "'asetnsamples=100,asetpts=PTS+gte(N\\,19000)*1000000000' -c:a pcm_f32le jump.mka")
        outcome = self.play(f"videotestsrc pattern=ball ! video/x-raw,width=64,height=48,framerate=25/1 ! identity "
                            f"eos-after={frames} ! spidarmotion track={self.path('jump.mka')} ! fakesink")
        self.assertTrue(outcome.eos, outcome.error)
        self.assertEqual(len(outcome.warnings), 1)
        self.assertRegex(outcome.warnings[0], "jump.mka is not felt any further: its samples reach to 1000019 s")
        # Analysed from the frame on that has no samples.
        self.assertTrue(0 < len(outcome.forces) <= frames - 19000 // 40 + 2, len(outcome.forces))

    def test_what_may_never_end_is_not_read(self):
        """Reading would block for ever, and stopping with it."""
        fifo = self.path("film.avi.haptic.flac")
        os.mkfifo(fifo)
        self.expect_analysed(self.film(fifo), "not a regular file")
        self.make_film("film.avi", FRAMES)
        line = (f"filesrc location={self.path('film.avi')} ! avidemux ! jpegdec ! videoconvert ! "
                "spidarmotion track=auto ! fakesink sync=true")
        for state in (Gst.State.PAUSED, Gst.State.PLAYING):
            pipeline = self.parse(line)
            pipeline.set_state(state)
            self.stop(pipeline)
        self.expect_analysed(self.play(line), "not a regular file")

    def test_the_track_of_another_film_may_differ_by_a_frame_and_no_more(self):
        for ms in (MS - 60, MS - 40, MS, MS + 40, MS + 60):
            with self.subTest(ms):
                self.make_track("a.wav", ms)
                outcome = self.film(self.path("a.wav"))
                if abs(ms - MS) <= 40:
                    self.assertEqual((outcome.warnings, outcome.forces), ([], []))
                else:
                    self.assertIn(f"is felt, as track= says, though the track lasts {ms / 1000:.3f} s, the film "
                                  f"{MS / 1000:.3f} s", outcome.warnings[0])
                    self.assertEqual(outcome.forces, [])
                self.make_film("film.avi", FRAMES)
                self.path("a.wav").rename(self.path("film.avi.haptic.wav"))
                outcome = self.play(f"filesrc location={self.path('film.avi')} ! avidemux ! jpegdec ! videoconvert ! "
                                    "spidarmotion track=auto ! fakesink sync=true")
                if abs(ms - MS) > 40:
                    self.expect_analysed(outcome, f"the film {MS / 1000:.3f} s")

    def test_scripts_beside_a_film_are_felt_and_rest_where_they_end(self):
        self.make_film("film.avi", FRAMES)
        points = [{"at": 0, "pos": 100}, {"at": 200, "pos": 100}]
        for name in ("film.funscript", "film.roll.funscript", "film.vib.funscript"):
            self.path(name).write_text(json.dumps({"actions": points}))
        film = f"filesrc location={self.path('film.avi')} ! avidemux ! jpegdec ! videoconvert ! spidarmotion "
        for track in ("auto", self.path("film.funscript")):
            pipeline = self.parse(f"{film} track={track} ! fakesink sync=true")
            outcome = self.play(pipeline)
            self.assertEqual((outcome.error, outcome.forces), ("", []))
            self.assertEqual(len(outcome.warnings), 1, outcome.warnings)
            self.assertIn("is felt without", outcome.warnings[0])
            self.assertIn("film.vib.funscript", outcome.warnings[0])
            rows = gst_case.read_ticks(pipeline.watched[-1])
            felt = [row for row in rows if row["found"] in ("exact", "interpolated")]
            self.assertTrue(felt)
            for row in felt:
                wanted = gst_case.vector(row, "wanted_force") + gst_case.vector(row, "wanted_torque", "Nm")
                self.assertLessEqual(max(abs(a - b) for a, b in zip(wanted, (0, 3, 0, 0, 0, .1))), 1e-6)
            self.assertEqual(rows[-1]["found"] in ("exact", "interpolated"), False)
        self.path("film.roll.funscript").write_text("{")
        outcome = self.play(f"{film} track=auto ! fakesink sync=true")
        self.expect_analysed(outcome, "film.roll.funscript: it is no JSON")

    def write_hjif(self, name, curve="Linear"):
        """Force x is 5 N for 200 ms."""
        keyframes = [{"relative_position": ms, "amplitude_modulation": .5} for ms in (0, 200)]
        band = {"band_type": "Curve", "curve_type": curve, "effects": [{"position": 0, "keyframes": keyframes}]}
        channels = [{"gain": 1, "bands": [band] if channel == 0 else []} for channel in range(6)]
        self.path(name).write_text(json.dumps({"perceptions": [{"perception_modality": "Vibrotactile"},
                                                               {"perception_modality": "Force", "channels": channels}]}))

    def test_hjif_beside_a_film_is_felt_where_no_track_and_no_script_is(self):
        self.make_film("film.avi", FRAMES)
        self.write_hjif("film.hjif")
        film = f"filesrc location={self.path('film.avi')} ! avidemux ! jpegdec ! videoconvert ! spidarmotion "

        def felt_force(track):
            pipeline = self.parse(f"{film} track={track} max-force=7 ! fakesink sync=true")
            outcome = self.play(pipeline)
            self.assertEqual((outcome.error, outcome.forces), ("", []))
            # A sample has single precision.
            wanted = {tuple(round(value, 6) for value in gst_case.vector(row, "wanted_force"))
                      for row in gst_case.read_ticks(pipeline.watched[-1]) if row["found"] in ("exact", "interpolated")}
            return wanted, outcome.warnings

        for track in ("auto", self.path("film.hjif")):
            wanted, warnings = felt_force(track)
            self.assertEqual(wanted, {(5, 0, 0)})
            self.assertEqual(len(warnings), 1, warnings)
            self.assertIn(f"is felt without perceptions[0] (Vibrotactile) of {self.path('film.hjif')}", warnings[0])
        self.write_hjif("film.hjif", "Akima")
        self.expect_analysed(self.play(f"{film} track=auto ! fakesink sync=true"), "film.hjif: perceptions[1].channels[0]."
                             "bands[0] is a curve of type Akima, not Linear")
        points = [{"at": 0, "pos": 100}, {"at": 200, "pos": 100}]
        self.path("film.funscript").write_text(json.dumps({"actions": points}))
        self.assertEqual(felt_force("auto"), ({(0, 3, 0)}, []))
        self.make_track("film.haptic.wav", MS, lambda _: (.25, 0, 0, 0, 0, 0))
        self.assertEqual(felt_force("auto"), ({(2.5, 0, 0)}, []))

    def test_it_is_felt_in_time_without_sync_too_and_a_warning_says_so(self):
        self.make_track("a.wav", MS, lambda _: CONSTANT)
        line = f"filesrc location={self.path('a.wav')} ! wavparse ! spidarsink name=sink"
        before = self.parse(line + " sync=false")
        later = self.parse(line)
        later.set_state(Gst.State.PAUSED)
        later.get_state(Gst.CLOCK_TIME_NONE)
        later.get_by_name("sink").set_property("sync", False)
        for pipeline in (before, later):
            outcome = self.play(pipeline)
            self.assertEqual(len(outcome.warnings), 1)
            self.assertIn("sync=false has no effect", outcome.warnings[0])
            self.assertAlmostEqual(max(self.felt(pipeline.watched[-1])), FULL_N, delta=1e-6)

    def test_messages_are_logged_under_the_name_of_the_element(self):
        lines = {"spidarsink": "audiotestsrc num-buffers=2 ! audio/x-raw,rate=1000,channels=6,channel-mask=(bitmask)0x3f ! "
                               "spidarsink {}",
                 "spidarmotion": "videotestsrc num-buffers=2 ! spidarmotion {} ! fakesink"}
        for element, line in lines.items():
            for prop, said in (("device=no-such-device", "warning: unknown device"),
                               ("haptic-trace=/dev/full", "warning: The haptic trace can no longer be written")):
                run = subprocess.run(["gst-launch-1.0", *line.format(prop).split()], capture_output=True, text=True,
                                     env=dict(os.environ, GST_DEBUG="2", GST_DEBUG_NO_COLOR="1"), check=False)
                self.assertRegex(run.stderr, f" {element} .*{said}")


class NetworkCase(TrackPlayedCase):
    """A track of three seconds, sent as on the page."""

    def setUp(self):
        super().setUp()
        self.make_track(count=3000, sample=lambda _: CONSTANT)
        self.spidartrack("convert", "a.wav", "film.flac")
        self.track = f"filesrc location={self.path('film.flac')} ! flacparse ! "

    def receiver(self, source, options=""):
        receiver = self.parse(f"{source} ! spidarsink name=sink {options}")
        receiver.set_state(Gst.State.PLAYING)
        return receiver

    @staticmethod
    def samples_of(receiver):
        return receiver.get_by_name("sink").get_property("stats").get_value("samples")

    def await_samples(self, receiver, count):
        while self.samples_of(receiver) < count:
            time.sleep(.01)

    def await_silence(self, receiver):
        before, now = 0, self.samples_of(receiver)
        while now == 0 or now != before:
            before = now
            time.sleep(1)  # more than what waits in the buffers
            now = self.samples_of(receiver)

    def send_all(self, sender, receiver):
        """Plays `sender` to its end, and ends `receiver` when nothing comes any more. The forces of its ticks, N."""
        outcome = self.play(sender)
        self.assertTrue(outcome.eos, outcome.error)
        self.await_silence(receiver)
        self.stop(receiver)
        return self.felt(receiver.watched[-1])

    @staticmethod
    def has_rest_between(forces):
        """All of the force was felt, then there was rest, then all of it again."""
        full = [n for n, force in enumerate(forces) if force > .99 * FULL_N]
        return bool(full) and any(force == 0 for force in forces[full[0]:full[-1]])

    def expect_tried(self, once, what):
        """A busy machine may leave out more of what is sent."""
        self.assertTrue(any(once() for _ in track_case.tries()), what)

    @staticmethod
    def free_port():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", 0))
            return free.getsockname()[1]


class Network(NetworkCase):
    def udp_sender(self, port):
        return self.parse(f"{self.track} flacdec ! rtpgstpay name=pay config-interval=1 ! udpsink host=127.0.0.1 "
                          f"port={port}")

    def test_lost_packets_are_a_ramp_to_rest_and_back(self):
        self.expect_tried(self.loses_packets, "felt, at rest, and felt again")

    def loses_packets(self):
        receiver = self.parse(f"udpsrc name=source address=127.0.0.1 port=0 caps=\"{RTP}\" ! rtpjitterbuffer latency=200 ! "
                              "rtpgstdepay ! spidarsink name=sink")
        receiver.get_by_name("source").set_state(Gst.State.READY)
        receiver.set_state(Gst.State.PLAYING)
        sender = self.udp_sender(receiver.get_by_name("source").get_property("port"))
        packets = []

        def lose(_pad, _info):
            """A second of packets arrives but for three, then none for 0.8 s, then all."""
            packets.append(None)
            n = len(packets) - 1
            return Gst.PadProbeReturn.DROP if n in (10, 15, 16) or 25 <= n < 45 else Gst.PadProbeReturn.OK

        # The payloader pushes each packet as a list of one.
        sender.get_by_name("pay").get_static_pad("src").add_probe(
            Gst.PadProbeType.BUFFER | Gst.PadProbeType.BUFFER_LIST, lose)
        forces = self.send_all(sender, receiver)
        self.assertGreaterEqual(len(packets), 75, "one for each 40 ms")
        return self.has_rest_between(forces)

    @unittest.skipUnless(Gst.ElementFactory.find("sdpdemux"), "needs gstreamer1.0-plugins-bad")
    def test_an_sdp_file_leads_to_the_track(self):
        port = self.free_port()
        of_page = " 5004 "
        text = SDP_FILE.read_text(encoding="ascii")
        self.assertIn(of_page, text)
        self.path("haptic.sdp").write_text(text.replace(of_page, f" {port} "))

        def is_felt():
            receiver = self.receiver(f"filesrc location={self.path('haptic.sdp')} ! sdpdemux latency=200 ! rtpgstdepay")
            return abs(max(self.send_all(self.udp_sender(port), receiver)) - FULL_N) < 1e-6

        self.expect_tried(is_felt, "all of the force")


@unittest.skipUnless(Gst.ElementFactory.find("srtsrc"), "needs gstreamer1.0-plugins-bad")
class Srt(NetworkCase):
    def sender(self, port):
        sender = self.parse(f"{self.track} flacdec ! rtpgstpay config-interval=1 mtu=1316 ! "
                            f"srtsink uri=\"srt://127.0.0.1:{port}?mode=listener\"")
        sender.set_state(Gst.State.PLAYING)
        return sender

    def srt_receiver(self, port):
        return self.receiver(f"srtsrc latency=200 uri=srt://127.0.0.1:{port} ! {RTP} ! rtpjitterbuffer latency=50 ! "
                             "rtpgstdepay")

    def test_a_sender_that_is_started_again_is_felt_again(self):
        self.expect_tried(self.is_felt_again, "felt, at rest, and felt again")

    def is_felt_again(self):
        port = self.free_port()
        first = self.sender(port)
        receiver = self.srt_receiver(port)
        self.await_samples(receiver, 400)
        self.stop(first)
        time.sleep(.3)  # at rest by then
        before = self.samples_of(receiver)
        second = self.sender(port)
        self.await_samples(receiver, before + 400)
        self.await_silence(receiver)
        self.stop(receiver)
        self.stop(second)
        return self.has_rest_between(self.felt(receiver.watched[-1]))


if __name__ == "__main__":
    unittest.main()
