# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidartrack convert, info, check and plot."""
import csv
import json
import struct
import math
import re
import unittest

import track_case
from track_case import CHANNELS, FULL_SCALE

# Half a step of 24 bits, and what a float below 1 is rounded by.
HALF_STEP = 2 ** -24 + 2 ** -25
HJIF = 4e-4 + .5e-5 + HALF_STEP  # its tolerance, and half a step of its numbers


def difference(a, b):
    return max(abs(x - y) for one, other in zip(a, b) for x, y in zip(one, other))


class Conversion(track_case.TrackCase):
    def test_every_format_keeps_every_channel(self):
        self.make_track()
        original = self.samples("a.wav")
        source = "a.wav"
        for name, error in (("a.mka", 0), ("b.flac", HALF_STEP), ("c.wav", HALF_STEP), ("d.hjif", HJIF),
                            ("e.mka", HJIF), ("f.flac", HJIF), ("g.hjif", 2 * HJIF)):
            self.assertEqual(self.spidartrack("convert", source, name), "")
            read = self.samples(name)
            self.assertEqual(len(read), len(original))
            self.assertLessEqual(difference(read, original), error, name)
            source = name

    def test_a_trace_has_the_forces_that_extract_gives(self):
        self.gst("videotestsrc num-buffers=25 pattern=ball ! video/x-raw,width=160,height=120,framerate=25/1",
                 "! spidarmotion device=none attach-meta=true trace=film.csv",
                 "! spidarextract name=x x.wrench ! wavenc ! filesink location=film.wav")
        extracted = self.samples("film.wav")
        rows = list(csv.DictReader(self.path("film.csv").read_text().splitlines()))
        self.assertEqual(len(rows), 25)
        columns = ("force_x_N", "force_y_N", "force_z_N", "torque_x_Nm", "torque_y_Nm", "torque_z_Nm")
        for row in rows:
            # A motion is that of the time halfway between its two pictures, which are 40 ms apart; the first has none.
            sample = extracted[max(0, int(row["stream_time_ns"]) // 1000000 - 20)]
            self.assertLessEqual(difference([[float(row[name]) / scale for name, scale in zip(columns, FULL_SCALE)]],
                                            [sample]), 1e-6)

    def test_six_funscripts_have_all_axes_and_are_read_back(self):
        peaks = (.2, .1, .05, .02, .01, .004)
        self.make_track(sample=lambda ms: [peak * math.sin(.02 * ms + i) for i, peak in enumerate(peaks)])
        said = self.spidartrack("convert", "a.wav", "a.funscript", "--axis", "all")
        # Sideways is the strongest; the vertical force has the name of that.
        for name, channel, gain in (("a", "fx", "5"), ("a.sway", "fy", "5"), ("a.surge", "fz", "5"), ("a.pitch", "tx", "50"),
                                    ("a.twist", "ty", "50"), ("a.roll", "tz", "50")):
            self.assertIn(f"{name}.funscript: {channel}, gain {gain}\n", said)
        said = self.spidartrack("convert", "a.funscript", "back.wav", "--axis", "all")
        self.assertIn("a.twist.funscript: ty, gain 50 taken back: 100 % is 0.02 N m\n", said)
        self.assertEqual(self.spidartrack("convert", "a.funscript", "again.wav"), said)
        before, after = self.samples("a.wav"), self.samples("back.wav")
        self.assertEqual(len(after), len(before))
        for channel in range(6):
            # The tolerance of the curve and half a position, by the gain.
            gain = 5 if channel < 3 else 50
            self.assertLessEqual(max(abs(a[channel] - b[channel]) for a, b in zip(before, after)), (.01 + .01) / gain + 1e-6)
        self.path("a.twist.funscript").write_text("kept")
        self.path("a.funscript").unlink()
        self.assert_said("a.twist.funscript: exists", "convert", "a.wav", "a.funscript", "--axis", "all")
        self.assertEqual(self.path("a.twist.funscript").read_text(), "kept")
        self.assertFalse(self.path("a.funscript").exists())
        self.path("a.twist.funscript").unlink()
        self.path("a.funscript").write_text('{"actions":[{"at":0,"pos":50},{"at":100,"pos":100}]}')
        said = self.spidartrack("convert", "a.funscript", "back.wav", "--axis", "all", "--force")
        # By a foreign one, upwards, the file that notes the vertical force is not replaced.
        self.assertIn("a.funscript: fy, gain 3.3", said)
        self.assertIn("a.sway.funscript, another one for fy: is not read", said)
        self.assert_said("--axis is for .funscript", "convert", "a.wav", "b.flac", "--axis", "all", status=2)

    def test_a_funscript_has_the_axis_with_the_most_motion(self):
        self.make_track(sample=lambda ms: (.02 * math.sin(.05 * ms), 0, .3 * (ms == 500), 0, 0, .01))
        self.assertIn("axis fx, which has the most motion; --axis chooses another\ngain 50:",
                      self.spidartrack("convert", "a.wav", "a.funscript"))
        positions = [action["pos"] for action in json.loads(self.path("a.funscript").read_text())["actions"]]
        self.assertEqual((min(positions), max(positions)), (0, 100))
        self.assertNotIn("axis", self.spidartrack("convert", "a.wav", "a.ahap"))
        # There and back is the same force: the script knows its channel and gain.
        self.assertEqual(self.spidartrack("convert", "a.funscript", "b.wav"),
                         "a.funscript: fx, gain 50 taken back: 100 % is 0.2 N\n")
        back = self.samples("b.wav")
        self.assertEqual({sample[1:] for sample in back}, {(0,) * 5})
        self.assertLessEqual(max(abs(sample[0] - .02 * math.sin(.05 * ms)) for ms, sample in enumerate(back)), .02 / 50 + 1e-6)

    def write_script(self, name, peak=100, **more):
        actions = [{"at": 0, "pos": 50}, {"at": 250, "pos": peak}, {"at": 500, "pos": 50}]
        self.path(name).write_text(json.dumps({"actions": actions} | more))

    def test_scripts_beside_a_film_are_its_track(self):
        """They end before it, as nearly all do."""
        self.make_film("film.avi", frames=50)
        for names in (("film.funscript", "film.roll.funscript"), ("film.avi.funscript", "film.avi.R1.funscript"),
                      ("film.stroke.funscript", "film.ROLL.funscript"), ("film.L0.funscript", "film.r1.Funscript")):
            self.write_script(names[0])
            self.write_script(names[1], 0)
            info = json.loads(self.spidartrack("info", "--json", "film.avi"))
            self.assertEqual(info["belongs"], True)
            self.assertEqual(info["samples"], 501)
            self.assertEqual([round(info["channels"][name]["peak"], 6) for name in CHANNELS], [0, .3, 0, 0, 0, .1], names)
            for name in names:
                self.path(name).unlink()
        # Not read: other axes, and scripts of other films.
        self.write_script("film.funscript")
        for name in ("film.vib.funscript", "film.b.funscript", "filmroll.funscript", "film.roll.b.funscript"):
            self.write_script(name)
        self.path("film.pitch.funscript").write_text('{"actions":[]}')
        said = self.spidartrack("info", "film.avi")
        self.assertIn("film.vib.funscript: is not read\n", said)
        self.assertIn("film.pitch.funscript: has no actions; tx is at rest\n", said)
        self.assertEqual(len(re.findall("funscript: ", said)), 4, said)
        # A haptic track goes before a script, and one that was a script may end early, too.
        self.spidartrack("convert", "film.funscript", "film.avi.haptic.flac")
        info = json.loads(self.spidartrack("info", "--json", "film.avi"))
        self.assertEqual((info["track"], info["belongs"]), ("film.avi.haptic.flac", True))
        self.path("film.avi.haptic.flac").unlink()
        self.path("film.pitch.funscript").write_text("{")
        self.assert_said("film.pitch.funscript: it is no JSON", "info", "film.avi")

    def test_what_a_format_cannot_hold_is_said(self):
        self.make_track(sample=lambda ms: (ms / 100, 0, 0, 0, 0, 0), count=101)
        self.assertEqual(self.spidartrack("convert", "a.wav", "c.funscript", "--gain", "1", "--axis", "fy"),
                         "axis fy is at rest; --axis fx has the most motion\n"
                         "gain 1\nlost: fx up to 10 N, steps of fy below 0.2 N\n")
        self.assertEqual(self.spidartrack("convert", "a.wav", "c.ahap", "--gain", "1"),
                         "gain 1\nlost: the direction of the force\n")

    def test_the_range_of_the_target_is_filled(self):
        self.make_track(sample=lambda ms: (.03, .1 * math.sin(.05 * ms), .04, 0, 0, 0))
        said = self.spidartrack("convert", "a.wav", "a.funscript")
        self.assertEqual(said, "axis fy, which has the most motion; --axis chooses another\n"
                         "gain 10: the largest value fills the range; --gain 1 keeps it as it is\n"
                         "lost: fx up to 0.3 N, fz up to 0.4 N, steps of fy below 0.02 N\n")
        positions = [action["pos"] for action in json.loads(self.path("a.funscript").read_text())["actions"]]
        self.assertEqual((min(positions), max(positions)), (0, 100))
        self.assertIn("gain 8.9:", self.spidartrack("convert", "a.wav", "a.ahap"))  # of a force of .1118
        self.assertIn("Force of a film: 1 is 1.12 N", self.path("a.ahap").read_text())
        values = [point["ParameterValue"]
                  for event in json.loads(self.path("a.ahap").read_text())["Pattern"]
                  for point in event.get("ParameterCurve", {}).get("ParameterCurveControlPoints", [])]
        self.assertAlmostEqual(max(values), 1, delta=.02)  # its tolerance
        self.make_track(sample=lambda _: (0,) * 6)
        self.assertRegex(self.spidartrack("convert", "a.wav", "a.funscript"), "^the whole track is at rest\ngain 1:")
        self.assert_said("--gain is for .funscript and .ahap", "convert", "a.wav", "b.flac", "--gain",
                         "2", status=2)

    def test_an_error_in_a_file_names_it_in_our_words(self):
        deep = b'{"a":' + b"[" * 200000 + b"]" * 200000 + b',"b":1}'
        points = b'"actions":[{"at":0,"pos":0},{"at":9,"pos":100}]}'
        for content, why in ((b"", "it is no JSON: it ends too early"), (b'{"actions":x', "it is no JSON: line 1, column 12"),
                             (deep, "its arrays and objects lie more than 64 deep"), (b"[1e999]", "it has a number that is beyond 1.8e308")):
            for name in ("a.funscript", "a.hjif"):
                self.path(name).write_bytes(content)
                for command in (["info"], ["check"], ["convert", "b.wav"], ["convert", "b.wav", "--axis", "all"]):
                    if name != "a.hjif" or "--axis" not in command:
                        self.assert_said(f"{name}: {why}", command[0], name, *command[1:])
        self.path("a.funscript").write_bytes(b'{"gst-spidar":{"channel":1,"gain":1e-300},' + points)
        self.assert_said("a.funscript: gst-spidar.gain is 1e-300, not from 0.001 to 1e+06",
                         "convert", "a.funscript", "b.wav", "--axis", "all")
        # A gain that fills the range is one that is read back.
        self.make_track(sample=lambda ms: (0, 1e-9 * ms, 0, 0, 0, 0))
        self.assertIn("gain 1e+06", self.spidartrack("convert", "a.wav", "b.funscript", "--axis", "all"))
        self.spidartrack("convert", "b.funscript", "c.wav", "--axis", "all")
        self.assertLessEqual(difference(self.samples("a.wav"), self.samples("c.wav")), 1e-6)

    def test_numbers_of_64_bits_that_are_none_of_32_are_rest(self):
        self.make_track(count=10)
        self.path("a.wav").write_bytes(track_case.chunk(b"RIFF", b"WAVE" + track_case.chunk(
            b"fmt ", struct.pack("<HHIIHH", 3, 6, 1000, 48000, 48, 64)) + track_case.MARK + track_case.chunk(
                b"data", struct.pack("<60d", *[1e300 if i == 7 else .1 for i in range(60)]))))
        self.assertEqual(json.loads(self.spidartrack("info", "--json", "a.wav"))["not_finite"], 1)
        self.spidartrack("convert", "a.wav", "b.wav")
        read = self.samples("b.wav")
        self.assertEqual(read[1], (0,) * 6)
        self.assertTrue(all(math.isfinite(value) for sample in read for value in sample))

    def test_a_wild_time_of_a_picture_is_none(self):
        self.make_film("film.avi")
        self.spidartrack("record", "film.avi", "--format", "wav")
        whole = self.path("film.avi.haptic.wav").read_bytes()
        picture = re.search(rb"HAPTIC_FILM=(-?\d+):([0-9a-f]{16})", whole)
        for time in (b"9000000000000000000", b"-9223372036854775808"):
            mark = track_case.chunk(b"LIST", b"INFO" + track_case.chunk(
                b"ICMT", b"HAPTIC_FULL_SCALE=10 N, 1 N m\nHAPTIC_FILM=" + time + b":" + picture.group(2) + b"\0"))
            self.make_track("film.avi.haptic.wav")
            content = self.path("film.avi.haptic.wav").read_bytes()
            self.path("film.avi.haptic.wav").write_bytes(track_case.chunk(b"RIFF", content[8:].replace(track_case.MARK, mark)))
            self.assertNotIn("of another film", self.spidartrack("info", "film.avi"))

    def test_an_option_that_changes_nothing_is_an_error(self):
        self.make_track()
        for options, why in ((("b.wav", "--axis", "fy"), "--axis is for .funscript, not for"),
                             (("b.hjif", "--axis", "fy"), "--axis is for .funscript, not for"),
                             (("b.flac", "--tolerance", "0.1"), "--tolerance is for .hjif, .ahap and .funscript, not")):
            self.assert_said(why, "convert", "a.wav", *options, status=2)
        self.assert_said("ends in none of .flac .mka", "convert", "a.wav", "a.txt")

    def test_csv_is_written_and_read(self):
        self.make_track(count=1500)
        self.spidartrack("convert", "a.wav", "a.csv")
        lines = self.path("a.csv").read_text().splitlines()
        self.assertEqual((lines[0], len(lines)), ("time_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm", 1501))
        self.assertTrue(lines[1235].startswith("1.234,"))
        for value, share, full in zip(lines[1235].split(",")[1:], track_case.wave(1234), track_case.FULL_SCALE):
            self.assertAlmostEqual(float(value), share * full, delta=2**-23 * full)  # the digits of a float
        # Half of the last digit of a sample, here and there.
        for read, made in zip(self.samples("a.csv"), self.samples("a.wav")):
            for value, wanted in zip(read, made):
                self.assertAlmostEqual(value, wanted, delta=2**-23)

    def test_csv_of_others_is_read(self):
        """In test_csv_track.cpp, in all dialects; here, what is printed."""
        self.path("a.csv").write_text("time_s,fx_lbf\n0,1\n")
        self.assert_said('a.csv, line 1: fx: the unit "lbf" is not one of N, ', "info", "a.csv")
        # One sample, which is less than a block of FLAC.
        self.path("a.csv").write_text("time_s,fx_mN\n0,500\n")
        for name in ("b.flac", "c.wav", "d.mka"):
            self.assertEqual(self.spidartrack("convert", "a.csv", name), "")
            self.assertLessEqual(difference(self.samples(name), [(.05, 0, 0, 0, 0, 0)]), HALF_STEP)

    def test_check_finds_what_would_not_be_felt_as_it_is(self):
        self.make_track()
        self.spidartrack("check", "a.wav")
        info = json.loads(self.spidartrack("info", "--json", "a.wav"))
        self.assertEqual(info["samples"], 1000)
        self.assertAlmostEqual(info["channels"]["fx"]["peak"], .15, delta=1e-4)
        peak_N = re.search(r"^fx +(\S+) +\S+ N ", self.spidartrack("info", "a.wav"), re.MULTILINE)
        self.assertAlmostEqual(float(peak_N.group(1)), 1.5, delta=1e-3)  # the same, times 10 N
        bad = [list(track_case.wave(ms)) for ms in range(2000)]
        bad[100][0] = math.nan
        for ms, sample in enumerate(bad):
            sample[1] = 1.5 if 500 <= ms < 600 else sample[1]
            sample[3] = .2 if ms % 4 < 2 else -.2
        self.make_track(sample=lambda ms: bad[ms], count=2000)
        said = self.spidartrack("check", "a.wav", status=1)
        for problem in ("1 samples are not numbers", "100 samples are beyond full scale", "largest force",
                        "largest torque", "changes by", "energy of tx"):
            self.assertIn(problem, said)

    def test_what_is_damaged_or_no_track_is_named(self):
        self.make_track(count=2000)
        self.path("text.flac").write_text("no music")
        self.spidartrack("info", "text.flac", status=1)
        self.gst("audiotestsrc num-buffers=10 ! audio/x-raw,rate=8000,channels=2 ! wavenc",
                 "! filesink location=stereo.wav")
        self.assert_said("2 channels", "info", "stereo.wav")
        # Cut in the middle: what is left is a track.
        self.spidartrack("convert", "a.wav", "a.flac")
        for name in ("a.wav", "a.flac"):
            content = self.path(name).read_bytes()
            self.path(name).write_bytes(content[:len(content) // 2])
            self.assertIn("it is cut off: ", self.spidartrack("info", name))
            self.assert_said("s of 2.000 s are there", "check", name)
        self.spidartrack("convert", "a.wav", "a.ahap")
        self.assert_said("written, but not read", "info", "a.ahap")

    @track_case.needs("ffmpeg")
    def test_a_trimmed_flac_is_whole(self):
        """What trims copies frames, and leaves the length in the head as it was."""
        self.make_track(count=2000)
        self.spidartrack("convert", "a.wav", "a.flac")
        whole = self.samples("a.flac")
        for name, cut, first, count in (("begin", "-ss 0.8", 800, 1200), ("end", "-t 0.8", 0, 800),
                                        ("both", "-ss 0.4 -t 0.8", 400, 800)):
            self.run_in_folder(f"ffmpeg -nostdin -v error {cut} -i a.flac -c copy {name}.flac")
            self.assertIn(f"{name}.flac: {count} samples", self.spidartrack("info", f"{name}.flac"))
            self.assertIn("ok\n", self.spidartrack("check", f"{name}.flac"))
            self.assertEqual(self.samples(f"{name}.flac"), whole[first:first + count])
            self.path("read back.wav").unlink()
            # Also what a tagger appends is no frame, and the beginning of one is.
            content = self.path(f"{name}.flac").read_bytes()
            self.path("tagged.flac").write_bytes(content + b"TAG" + bytes(125))
            self.assertIn("ok\n", self.spidartrack("check", "tagged.flac"))
            for byte in (1, 2, 5, 20):
                self.path("cut.flac").write_bytes(content[:-byte])
                self.assert_said("it is cut off", "check", "cut.flac")

    def test_a_size_that_its_writer_could_not_know_is_judged_by_what_is_there(self):
        """sox writes 0x7ffff000 less a remainder into a pipe, others the largest number or its first bit."""
        self.make_track(count=2000)
        whole = self.path("a.wav").read_bytes()
        at = whole.index(b"data") + 4
        for size in (0, 0x7fffeff0, 0x7fffffff, 0x80000000, 0xffffff00, 0xffffffff):
            self.path("piped.wav").write_bytes(whole[:at] + struct.pack("<I", size) + whole[at + 4:])
            self.assertIn("ok\n", self.spidartrack("check", "piped.wav"), hex(size))
        # Real ones are not taken for these.
        for size in (len(whole) - at - 4 + 24000, 0x7ffe0000, 0x80000001, 0xf0000000):
            self.path("cut.wav").write_bytes(whole[:at] + struct.pack("<I", size) + whole[at + 4:])
            self.assert_said("it is cut off: 2.000 s of", "check", "cut.wav")
        # The head of FLAC has 36 bits for the number of samples, from the 172nd on.
        self.spidartrack("convert", "a.wav", "a.flac")
        flac = bytearray(self.path("a.flac").read_bytes())
        self.assertEqual(int.from_bytes(flac[18:26], "big") & (1 << 36) - 1, 2000)
        flac[21] &= 0xf0
        flac[22:26] = bytes(4)
        self.path("piped.flac").write_bytes(flac)
        self.assertIn("ok\n", self.spidartrack("check", "piped.flac"))

    def test_a_chunk_without_a_length_is_refused(self):
        """GStreamer goes on for ever where a chunk before the samples says that it has none."""
        self.make_track()
        whole = self.path("a.wav").read_bytes()
        at = whole.index(b"LIST") + 4
        self.path("b.wav").write_bytes(whole[:at] + bytes(4) + whole[at + 4:])
        for command in (["info"], ["check"], ["convert", "c.wav"]):
            self.assert_said("its head is damaged", command[0], "b.wav", *command[1:])

    @track_case.needs("ffmpeg")
    def test_a_file_that_gstreamer_cannot_take_apart_is_refused(self):
        """The decoder of Wave64 would give other values, and samples that are not in the file."""
        self.make_track()
        self.run_in_folder("ffmpeg -nostdin -v error -i a.wav -af aformat=channel_layouts=5.1 -c:a pcm_f32le a.w64")
        self.assert_said("GStreamer cannot take audio/x-w64 apart", "info", "a.w64")

    @track_case.needs("ffmpeg")
    def test_a_jump_of_days_is_not_filled_with_silence(self):
        self.make_track()
        self.run_in_folder("ffmpeg -nostdin -v error -i a.wav -af "
                           "'asetnsamples=100,asetpts=PTS+gte(N\\,5)*1000000000' -c:a pcm_f32le jump.mka")
        self.assert_said("reach to 1000000 s, and a track lasts at most 24 h", "convert", "jump.mka", "b.wav")

    def test_a_film_stands_for_its_track(self):
        for name in ("film.avi", "two\nlines.avi", b"\xff\xfe.avi".decode(errors="surrogateescape")):
            self.make_film(name)
            for command in (["info"], ["check"], ["convert", "b.wav"], ["plot", "b.png"]):
                self.assert_said("a film without a haptic track, inside it or beside it", command[0], name, *command[1:])
            for count in (1000, 1500):
                self.make_track(name + ".haptic.wav", count)
                self.assertEqual("of another film" in self.spidartrack("info", name), count != 1000)
                info = json.loads(self.spidartrack("info", "--json", name))
                self.assertEqual(info["belongs"], count == 1000)
                if "\udcff" not in name:
                    self.assertEqual(info["film"], name)
                self.assertEqual("of another film" in self.spidartrack("check", name, status=int(count != 1000)),
                                 count != 1000)
                self.spidartrack("convert", name, "b.wav", status=int(count != 1000))
            self.assertEqual(len(self.samples("b.wav")), 1000)
            self.assert_said("is that of another film", "plot", name, "b.png")

    def test_endings_may_be_in_capital_letters(self):
        self.make_track("FILM.AVI.HAPTIC.WAV")
        for name in ("B.FLAC", "C.MKA", "D.HJIF", "E.FUNSCRIPT", "F.WAV"):
            self.spidartrack("convert", "FILM.AVI.HAPTIC.WAV", name)
            self.spidartrack("info", name)
        self.spidartrack("convert", "F.WAV", "G.AHAP")
        self.assert_said("written, but not read", "info", "G.AHAP")
        self.assertEqual(self.path("E.FUNSCRIPT").read_bytes()[:1], b"{")

    def test_a_track_in_which_nothing_is_felt_is_not_ok(self):
        # 0.04 N at the radius of the grip, 22.5 mm, are 0.9 mN m.
        least = "force and torque are below 0.04 N and 0.0009 N m"
        for sample, felt in (((0,) * 6, 0), ((0, .003, 0, 0, 0, 0), 0), ((0, 0, 0, .0008, 0, 0), 0),
                             ((0, 0, 0, .001, 0, 0), 100), ((.005, 0, 0, 0, 0, 0), 100)):
            self.make_track(sample=lambda _, sample=sample: sample)
            self.assertEqual(self.spidartrack("check", "a.wav", status=int(felt == 0)),
                             "a.wav: ok\n" * (felt > 0) + f"a.wav: {felt} % of it is felt" +
                             (f": {least}\n" if felt == 0 else "\n"))
            self.assertEqual(json.loads(self.spidartrack("info", "a.wav", "--json"))["felt"], felt / 100)
        self.make_track(sample=lambda ms: (0, 0, 0, 0, 0, .05 * (ms < 500)))
        self.assertIn(f"a.wav: 50 % of it is felt; in the rest {least}\n", self.spidartrack("check", "a.wav", status=None))


if __name__ == "__main__":
    unittest.main()
