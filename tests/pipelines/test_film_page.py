# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidartrack export: test_film_page.py FILM_PAGE_JS. The scripts of the page run in node, if it is installed; in browsers, they
do in test_page_in_browsers.py."""
import base64
import json
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import unittest

import track_case
from track_case import FULL_SCALE

FILM_PAGE_JS = pathlib.Path(sys.argv.pop(1)).resolve()
MOST_BYTES = 100_000
HEIGHT_PX = 480  # of the picture that film_page.js shows

HAS_ENCODER = any(subprocess.run(["gst-inspect-1.0", "--exists", element], check=False).returncode == 0
                  for element in ("x264enc", "openh264enc"))


def force_at(samples, ms):
    """In newtons."""
    return [FULL_SCALE[axis] * samples[ms][axis] for axis in range(3)]


class FilmPage(track_case.TrackCase):
    def export(self, film, page="page.html"):
        """The tolerance in newtons that the command prints."""
        said = self.spidartrack("export", film, page)
        found = re.search(r"; (\d+) KB, exact to (\S+) N(?:;|$)", said, re.MULTILINE)
        self.assertTrue(found, said)
        self.assertLess(self.path(page).stat().st_size, MOST_BYTES)
        return float(found.group(2)) + .005  # as it is rounded

    def run_page(self, *times_s, page="page.html", browser=""):
        """What film_page.js prints."""
        said = self.run_in_folder(["node", str(FILM_PAGE_JS), str(self.path(page)), *map(str, times_s)],
                                  env=dict(os.environ, PAGE_BROWSER=browser))
        return json.loads(said.splitlines()[-1])  # after warnings of node's own

    def assert_shows(self, samples, tolerance_N):
        times_ms = range(0, len(samples), 73)
        shown = self.run_page(*(ms / 1000 for ms in times_ms))
        most_N = shown["most_N"]
        px_N = HEIGHT_PX / 5 / most_N
        # Along each of three axes, and "1.5 N" is rounded.
        size_N = math.sqrt(3) * tolerance_N
        for ms, moment in zip(times_ms, shown["moments"]):
            force_N = force_at(samples, ms)
            if moment["tip"]:
                for axis in range(2):
                    self.assertAlmostEqual(moment["tip"][axis] / px_N, force_N[axis], delta=tolerance_N)
            else:  # shorter than it is wide
                self.assertLess(math.hypot(*force_N[:2]), HEIGHT_PX / 80 / px_N + size_N)
            self.assertEqual(moment["ring"] is not None, abs(force_N[2]) * px_N > HEIGHT_PX / 80, msg=f"{ms} ms") \
                if abs(abs(force_N[2]) * px_N - HEIGHT_PX / 80) > tolerance_N * px_N else None
            if moment["ring"]:
                self.assertAlmostEqual(moment["ring"] / px_N * (1 if moment["comes"] else -1), force_N[2], delta=tolerance_N)
            self.assertAlmostEqual(float(moment["said"].split()[0]), math.hypot(*force_N), delta=size_N + .05)
            for strength in moment["pulses"]:
                self.assertAlmostEqual(strength * most_N, math.hypot(*force_N), delta=size_N)
            for on_ms in moment["vibrated_ms"]:
                self.assertAlmostEqual(on_ms / 50 * most_N, math.hypot(*force_N), delta=size_N + most_N / 100)
        return shown

    @track_case.needs("node")
    def test_the_page_shows_and_renders_the_force_of_the_track(self):
        self.make_film("a film.avi", frames=50)
        self.make_track("a film.avi.haptic.wav", count=2000)
        tolerance_N = self.export("a film.avi")
        self.assertLess(tolerance_N, .04)  # what a hand can feel
        shown = self.assert_shows(self.samples("a film.avi.haptic.wav"), tolerance_N)
        self.assertEqual((shown["url"], shown["title"]), ("a%20film.avi", "a film.avi"))
        self.assertGreater(max(map(len, (moment["pulses"] for moment in shown["moments"]))), 0)
        self.assertFalse(shown["drawsPaused"])
        # Before it plays, the page shows the moment of the largest force, whose time no controls show.
        poster_s, *shows = shown["poster"]
        self.assertAlmostEqual(math.hypot(*force_at(self.samples("a film.avi.haptic.wav"), round(1000 * poster_s))),
                               shown["most_N"], delta=math.sqrt(3) * tolerance_N)
        self.assertEqual(shows, [False, 0, True])

    @track_case.needs("node")
    def test_a_step_of_the_force_is_in_its_place(self):
        """A rise by 36 N/s, and back: a mean of ten samples would be off by 0.16 N beside them, 0.09 N between."""
        self.make_film()
        self.make_track("film.avi.haptic.wav", count=1000,
                        sample=lambda ms: (3.6e-3 * max(0, 50 - abs(ms - 500)), 0, -2e-3 * max(0, 50 - abs(ms - 700)), 0, 0, 0))
        tolerance_N = self.export("film.avi")
        samples = self.samples("film.avi.haptic.wav")
        times_ms = range(440, 760)
        shown = self.run_page(*(ms / 1000 for ms in times_ms))
        for ms, moment in zip(times_ms, shown["moments"]):
            for strength in moment["pulses"]:
                self.assertAlmostEqual(strength * shown["most_N"], math.hypot(*force_at(samples, ms)), delta=tolerance_N)

    @track_case.needs("node")
    def test_a_film_without_force_says_so(self):
        self.make_film()
        for size, how in ((0, "A hand would feel nothing"), (.003, "A hand would feel nothing"), (.01, "The arrow is")):
            self.make_track("film.avi.haptic.wav", sample=lambda ms: (size, 0, 0, 0, 0, 0))
            self.export("film.avi")
            self.assertIn(how, self.run_page(0).get("how") or self.path("page.html").read_text(encoding="utf-8"))

    @track_case.needs("node", "ffmpeg")
    def test_the_arrow_stands_on_what_is_felt(self):
        """A square of 50 px goes to the right before a wall, in 400 x 240 px, which film_page.js shows twice as large."""
        self.run_in_folder(
            "ffmpeg -nostdin -v error -f lavfi -i nullsrc=size=400x240:rate=25:duration=2 -vf "
            "\"geq=lum='if(lt(abs(X-60-80*T),25)*lt(abs(Y-120),25),128+100*sin((X-80*T)/3)*sin(Y/4),"
            "128+60*sin(X/11)*sin(Y/9))':cb=128:cr=128\" -c:v libvpx film.webm")
        block_px, frame_px = 8, 80 / 25  # what a box is off by; how far it goes in a frame
        self.spidartrack("record", "film.webm")
        self.export("film.webm", "on.html")
        off_px = block_px + frame_px + .02 * 400
        for time_s in (.5, 1, 1.5):
            moment = self.run_page(time_s, page="on.html")["moments"][0]
            left, top, width, height = (length / 2 for length in moment["box"])
            self.assertAlmostEqual(left + width / 2, 60 + 80 * time_s, delta=off_px)
            self.assertAlmostEqual(top + height / 2, 120, delta=off_px)
            self.assertAlmostEqual(width, 50, delta=2 * off_px)
            self.assertAlmostEqual(moment["origin"][0] / 2, left + width / 2, delta=1e-6)
            self.assertAlmostEqual(moment["origin"][1] / 2, top + height / 2, delta=1e-6)
        # A track that does not tell how it was measured.
        self.path("film.webm.haptic.flac").unlink()
        self.make_track("film.webm.haptic.wav", count=2000)
        self.export("film.webm", "middle.html")
        moments = self.run_page(.2, .4, .6, .8, 1, page="middle.html")["moments"]
        self.assertEqual([moment["box"] for moment in moments], 5 * [None])
        self.assertIn([400, 240], [moment["origin"] for moment in moments])

    @track_case.needs("node")
    def test_a_film_without_a_track_is_recorded_and_leaves_none(self):
        self.make_film()
        said = self.spidartrack("export", "film.avi", "page.html")
        self.assertIn("% of its frames are felt", said)
        self.assertEqual(self.files(), {"film.avi", "page.html"})
        most_N = self.run_page(0)["most_N"]
        self.spidartrack("record", "film.avi")
        self.assertNotIn("frames are felt", self.spidartrack("export", "film.avi", "of_track.html"))
        self.assertAlmostEqual(self.run_page(0, page="of_track.html")["most_N"], most_N, delta=.01)
        # Properties make it anew, whatever there is.
        self.spidartrack("export", "film.avi", "weak.html", "--", f"max-force={most_N / 2}")
        self.assertLess(self.run_page(0, page="weak.html")["most_N"], most_N / 2 + .02)
        self.make_track("other.wav", sample=lambda ms: (.2, 0, 0, 0, 0, 0))
        self.spidartrack("export", "film.avi", "other.html", "--track", "other.wav")
        self.assertAlmostEqual(self.run_page(0, page="other.html")["most_N"], 2, delta=.01)
        self.assert_said("properties follow --: spidartrack export FILM TO -- max-force=1", "export", "film.avi", "a.html",
                         "max-force=1", status=2)
        self.assert_said("exclude each other", "export", "film.avi", "a.html", "--track", "other.wav", "--", "max-force=1",
                         status=2)

    @track_case.needs("node")
    def test_a_browser_that_vibrates_nothing_says_why(self):
        self.make_film()
        self.make_track("film.avi.haptic.wav")
        self.export("film.avi")
        for browser, about in (("firefox", "A Pad (this browser cannot vibrate it; Chromium may)"),
                               ("policy", "the page around this one allows no gamepads; a telephone vibrates by itself"),
                               ("insecure", "gamepads need https, or a page that is opened as a file; a telephone"),
                               ("iphone", "this browser vibrates no telephone (no iPhone does)")):
            with self.subTest(browser):
                shown = self.run_page(.15, browser=browser)
                self.assertIn(about, shown["about"])
                self.assertEqual(shown["wide"], browser != "iphone")
                self.assertEqual(shown["moments"][0]["vibrated_ms"] != [], browser in ("policy", "insecure"))

    @track_case.needs("ffmpeg")
    def test_a_film_too_large_for_a_page_is_refused(self):
        self.run_in_folder("ffmpeg -nostdin -v error -f lavfi -i testsrc2=size=64x48:rate=25:duration=1 -c:v libvpx film.webm")
        with open(self.path("film.webm"), "r+b") as film:
            film.truncate(1 << 29)  # sparse
        self.make_track("film.webm.haptic.wav")
        self.assert_said("film.webm: has 536 MB, which is too large for a page: browsers do not hold more than 268 MB",
                         "export", "film.webm", "page.html", "--embed")

    @track_case.needs("ffmpeg")
    def test_what_safari_plays_in_part_is_not_copied(self):
        for name, encoder in (("vp9.mp4", "libvpx-vp9"), ("av1.webm", "libaom-av1 -cpu-used 8")):
            self.run_in_folder(f"ffmpeg -nostdin -v error -f lavfi -i testsrc2=size=64x48:rate=25:duration=1 -c:v {encoder} {name}")
            self.assertIn("; not every browser plays it, because its picture is ", self.spidartrack("export", name, name + ".html"))

    @track_case.needs("node")
    def test_a_pause_ends_the_vibration_once(self):
        self.make_film()
        self.make_track("film.avi.haptic.wav")
        self.export("film.avi")
        self.assertEqual(self.run_page(.15)["paused"], {"pulses": [0], "vibrated_ms": [0]})
        self.assertEqual(self.run_page(.15, 7)["paused"], {"pulses": [], "vibrated_ms": []})

    @track_case.needs("node")
    def test_a_film_that_waits_for_data_is_at_rest(self):
        """Also where the browser only lets its time stand."""
        self.make_film()
        self.make_track("film.avi.haptic.wav")
        self.export("film.avi")
        for rests, goes_on in self.run_page(.15)["waiting"]:
            self.assertEqual(rests, 0)
            self.assertGreater(goes_on, 0)

    @track_case.needs("node")
    def test_it_is_drawn_in_the_pixels_of_the_screen(self):
        """Which change with the zoom, and on another screen."""
        self.make_film()
        self.make_track("film.avi.haptic.wav")
        self.export("film.avi")
        self.assertEqual(self.run_page(.15)["canvases"],
                         [[round(800 * fine), round(480 * fine), fine, fine] for fine in (1, 2, 1.25)])

    @track_case.needs("node", "ffmpeg")
    def test_a_film_whose_times_are_others_than_those_of_its_track_is_followed(self):
        """In a transport stream the pictures begin later."""
        self.run_in_folder("ffmpeg -nostdin -v error -f lavfi -i testsrc2=size=160x120:rate=25:duration=4 "
                           "-bf 2 film.mp4 && ffmpeg -nostdin -v error -i film.mp4 -c copy copy.ts")
        self.spidartrack("record", "film.mp4")
        self.path("copy.ts.haptic.flac").write_bytes(self.path("film.mp4.haptic.flac").read_bytes())
        self.export("film.mp4", "film.html")
        self.export("copy.ts", "copy.html")
        later_s = self.run_page(0, page="copy.html")["later_s"]
        self.assertGreater(later_s, .02)
        times_s = [.1 * i for i in range(1, 30)]
        said = [[moment["said"] for moment in self.run_page(*(time_s + shift_s for time_s in times_s), page=page)["moments"]]
                for page, shift_s in (("film.html", 0), ("copy.html", later_s))]
        self.assertEqual(*said)
        self.assertGreater(len(set(said[0])), 1)

    @track_case.needs("node")
    def test_names_of_films_are_not_read_as_html(self):
        for name in ("<!--<script>.avi", "a&b #1 100%.avi", "färbt'ihn\".avi"):
            folder = f"sub {len(name)}"
            self.make_film(name)
            self.make_track(name + ".haptic.wav")
            self.path(folder).mkdir()
            self.export(name, f"{folder}/page.html")
            shown = self.run_page(0, page=f"{folder}/page.html")
            self.assertEqual(shown["title"], name)
            self.assertEqual(shown["url"], "../" + "".join(
                chr(byte) if chr(byte).isalnum() and byte < 128 or chr(byte) in "-._~/" else f"%{byte:02X}"
                for byte in name.encode()))

    def test_the_page_needs_no_network(self):
        self.make_film()
        self.make_track("film.avi.haptic.wav")
        self.export("film.avi")
        text = self.path("page.html").read_text(encoding="utf-8")
        self.assertIn("default-src 'none'; media-src 'self' file: blob:", text)
        self.assertEqual(re.findall(r"https?:|//\w|\bsrc *=|\bhref|@import|url\(", text.replace("film.src = ", "").replace(" src = ", "")), [])

    @track_case.needs("node")
    def test_a_long_track_fits_by_being_less_exact(self):
        """Ten minutes of a force that no straight lines follow."""
        rng = random.Random(5)
        ends = [[rng.uniform(-.3, .3) for _ in range(6)] for _ in range(600 * 20 + 1)]
        self.make_film("film.avi")
        self.gst("videotestsrc num-buffers=600 ! video/x-raw,width=64,height=48,framerate=1/1 ! jpegenc ! avimux",
                 "! filesink location=film.avi")
        self.make_track("film.avi.haptic.wav", count=600_000,
                        sample=lambda ms: [a + (b - a) * (ms % 50) / 50
                                           for a, b in zip(ends[ms // 50], ends[ms // 50 + 1])])
        tolerance_N = self.export("film.avi")
        self.assertGreater(tolerance_N, .04)
        self.assert_shows(self.samples("film.avi.haptic.wav")[:10_000], tolerance_N)

    def test_what_is_wrong_is_said(self):
        self.make_film()
        self.gst("videotestsrc num-buffers=1 ! pngenc ! filesink location=picture.png")
        self.assert_said("picture.png: is a single picture", "export", "picture.png", "a.html")
        self.path("picture.png").unlink()
        self.make_track()
        self.assert_said("a.wav: is a track; give the film that it is for", "export", "a.wav", "a.html", status=2)
        self.make_track("film.avi.haptic.wav")
        self.assert_said("a.htm: is to end in .html, or in / as a folder does", "export", "film.avi", "a.htm", status=2)
        self.make_track("film.avi.haptic.wav", count=1500)
        self.assert_said("is that of another film", "export", "film.avi", "a.html")
        self.assertEqual(self.files(), {"film.avi", "film.avi.haptic.wav", "a.wav"})

    def make_mpeg4(self, name="film.mp4"):
        """Of which browsers play the sound, and not the picture."""
        self.run_in_folder("ffmpeg -nostdin -v error -f lavfi -i testsrc2=size=160x120:rate=25:duration=4 "
                           f"-f lavfi -i sine=d=4 -c:v mpeg4 -c:a aac {name}")
        self.spidartrack("record", name)

    @track_case.needs("ffmpeg")
    def test_a_film_that_browsers_do_not_play_is_said_with_what_helps(self):
        """Also by the page, which a browser shows."""
        for name, why, helps in (("film.mp4", "because its picture is video/mpeg simple", "; spidartrack export film.mp4 FOLDER/"),
                                 ("film.mkv", "because it is neither MP4 nor WebM", "; spidartrack export film.mkv FOLDER/ converts")):
            self.make_mpeg4(name)
            self.assertIn(f"; browsers do not play it, {why}{helps}", self.spidartrack("export", name, name + ".html"))

    @track_case.needs("ffmpeg")
    def test_a_page_without_the_subtitles_of_its_film_says_so(self):
        self.make_mpeg4("film.mkv")
        self.path("one.srt").write_text("1\n00:00:01,000 --> 00:00:02,000\nHere\n", encoding="utf-8")
        for told, codec in (("told.mkv", "srt"), ("text.mp4", "mov_text")):
            self.run_in_folder("ffmpeg -nostdin -v error -i film.mkv -i one.srt -map 0 -map 1 -c copy "
                               f"-c:s {codec} {told}")
            self.assertIn("; without its subtitles", self.spidartrack("export", told, told + ".html"))
        for beside, is_lost in (("film.srt", True), ("film.de.vtt", True), ("film.txt", False), ("films.srt", False)):
            self.path("one.srt").rename(self.path(beside))
            self.assertEqual("subtitles" in self.spidartrack("export", "film.mkv", beside + ".html"), is_lost, beside)
            self.path(beside).rename(self.path("one.srt"))

    @unittest.skipUnless(HAS_ENCODER, "needs an encoder of H.264")
    @track_case.needs("ffmpeg")
    def test_others_are_converted_into_a_folder_or_a_page(self):
        self.make_mpeg4()
        self.assertIn("; converted, because its picture is video/mpeg", self.spidartrack("export", "film.mp4", "out/"))
        self.assertIn("; with the film in it; converted", self.spidartrack("export", "film.mp4", "one.html", "--embed"))
        self.assertEqual({name for name in self.files() if name.startswith("out/")}, {"out/index.html", "out/film.mp4"})

    @track_case.needs("ffmpeg")
    def test_a_film_that_browsers_play_is_copied_as_it_is(self):
        self.run_in_folder("ffmpeg -nostdin -v error -f lavfi -i testsrc2=size=160x120:rate=25:duration=2 -c:v libvpx film.webm")
        self.spidartrack("record", "film.webm")
        self.assertNotIn("converted", self.spidartrack("export", "film.webm", "out/"))
        self.assertEqual(self.path("out/film.webm").read_bytes(), self.path("film.webm").read_bytes())
        self.assert_said("--embed is for a page, not for a folder", "export", "film.webm", "out/", "--embed", status=2)
        text = self.path("film.webm").read_bytes()
        self.spidartrack("export", "film.webm", "one.html", "--embed")
        kept = re.search('id="bytes">([^<]*)<', self.path("one.html").read_text(encoding="utf-8")).group(1)
        self.assertEqual(base64.b64decode(kept), text)


if __name__ == "__main__":
    unittest.main()
