# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidar-feel --screen with films in Chromium and Firefox, on a screen that nobody sees: what is felt beside what the film
itself gives, how late it is, and what capture costs. Each picture of the film has its number in black and white at its
upper edge. Browsers that are not installed are skipped."""

import json
import math
import os
import shutil
import statistics
import subprocess
import time
import unittest

import gi
import numpy

gi.require_version("Gst", "1.0")
from gi.repository import Gst

import bus_case
import screen
import test_screen
from screen import comes
from test_followed import BIT_PX, BITS, Watched

WIDTH, HEIGHT, BAR_PX, LENGTH_S = 640, 360, 16, 12
FILM_AT = (60, 80)
# Of the forces that the film gives, N: what is felt there, and what counts as nothing.
FELT_N, NOTHING_N = .1, .1
PAGES = {
    "page": """<style>body {{ margin: 0 }} video {{ position: absolute; left: {x}px; top: {y}px }}
        #ad {{ position: absolute; left: 760px; top: 90px; width: 300px; height: 120px; background: #ffd }}
        #ball {{ position: absolute; width: 60px; height: 60px; border-radius: 30px; background: #06c }}
        #chat {{ position: absolute; left: 760px; top: 260px; width: 400px; height: 260px; overflow: hidden }}</style>
        <video src=film.webm muted></video><div id=ad><div id=ball></div></div><div id=chat></div>
        <script>let n = 0;
        setInterval(() => ball.style.left = 120 + 110 * Math.sin(performance.now() / 330) + "px", 33);
        setInterval(() => {{ chat.append("viewer " + n++ + ": " + Math.random(), document.createElement("br"));
                             chat.scrollTop = 1e9; }}, 700);</script>""",
    "film alone": """<style>body {{ margin: 0 }} video {{ position: absolute; left: {x}px; top: {y}px }}</style>
        <video src=film.webm muted></video>""",
    "full screen": """<style>body {{ margin: 0; background: #000 }}
        video {{ width: 100vw; height: 100vh; object-fit: contain }}</style><video src=film.webm muted></video>""",
}
PLAY = "<script>const film = document.querySelector('video'); setTimeout(() => film.play(), 4000);"
# What becomes of "page".
EVENTS = {
    "theatre": "setTimeout(() => film.style.cssText = 'z-index: 1; left: 80px; top: 20px; width: 1120px', 9000)",
    "second film": """const other = document.body.appendChild(document.createElement('video'));
        Object.assign(other, {src: 'film.webm', muted: true, loop: true, style: 'left: 760px; top: 540px; width: 320px'});
        setTimeout(() => other.play(), 6000)""",
    "scrolled": """for (let n = 0; n < 200; ++n)
            document.body.appendChild(document.createElement('p')).textContent = `Line ${n} of what is read below a film. `.repeat(4);
        film.style.position = 'relative';
        setTimeout(() => { film.pause(); setInterval(() => scrollBy(0, 4), 16) }, 7000)""",
}


def texture(random, height, width):
    """Grey, with spots of about 8 pixels."""
    coarse = random.integers(40, 216, (height // 8 + 2, width // 8 + 2)).astype(float)
    rows, columns = numpy.arange(height) / 8, numpy.arange(width) / 8
    down, right = rows.astype(int), columns.astype(int)
    at_y, at_x = (rows - down)[:, None], (columns - right)[None, :]
    upper = coarse[down][:, right] * (1 - at_x) + coarse[down][:, right + 1] * at_x
    lower = coarse[down + 1][:, right] * (1 - at_x) + coarse[down + 1][:, right + 1] * at_x
    return (upper * (1 - at_y) + lower * at_y).astype(numpy.uint8)


def cut_out(world, x, y):
    """What a camera there sees, between the pixels, too."""
    right, down = x % 1, y % 1
    rows = world[int(y):int(y) + HEIGHT + 1, int(x):int(x) + WIDTH + 1].astype(float)
    rows = rows[:, :-1] * (1 - right) + rows[:, 1:] * right
    return (rows[:-1] * (1 - down) + rows[1:] * down).astype(numpy.uint8)


def pictures(rate_hz):
    """By a camera in a hand: a patch that runs along an eight before a background at rest, and stands still every six seconds,
    for two. A camera that moved by whole pixels would pass for a page that scrolls."""
    random = numpy.random.default_rng(7)
    background, patch = texture(random, HEIGHT + 80, WIDTH + 80), texture(random, 100, 140)
    phase = 0
    for number in range(LENGTH_S * rate_hz):
        now_s = number / rate_hz
        phase += (2 * math.pi / 5 / rate_hz) * (now_s % 6 < 4)
        x = int(WIDTH / 2 - 30 + 220 * math.sin(phase))
        y = int(HEIGHT / 2 - 10 + 90 * math.sin(2 * phase))
        world = background.copy()
        world[y:y + 100, x:x + 140] = patch
        picture = cut_out(world, 40 + 35 * math.sin(2.1 * now_s), 40 + 35 * math.sin(1.7 * now_s))
        picture[:BAR_PX] = 16
        for at, bit in enumerate([1, 0] + [number >> bit & 1 for bit in range(BITS)]):
            picture[:BAR_PX, at * BIT_PX:(at + 1) * BIT_PX] = 235 if bit else 16
        yield picture


def forces(path):
    """Of a trace: running s, and newtons, as columns."""
    rows = [json.loads(line) for line in path.read_text(encoding="utf-8").rpartition("\n")[0].splitlines()]
    return (numpy.array([row["running_time_ns"] * 1e-9 for row in rows]),
            numpy.array([row["wrench"]["force_N"][:2] for row in rows]), [row["repeated"] for row in rows])


class Likeness:
    """What is felt of a screen beside what the film gives, shifted to where they are most alike."""

    def __init__(self, film, seen):
        (film_s, film_N, _), (seen_s, seen_N, _) = film, seen
        grid_s = numpy.arange(0, film_s[-1], 1 / 120)

        def at(times, values, later_s):
            return numpy.stack([numpy.interp(grid_s + later_s, times, values[:, axis]) for axis in (0, 1)], 1)
        want = at(film_s, film_N, 0)

        def correlation(later_s):
            got = at(seen_s, seen_N, later_s)
            return (want * got).sum() / math.sqrt((want ** 2).sum() * (got ** 2).sum() + 1e-9)
        later_s = max(numpy.arange(0, seen_s[-1] - film_s[-1], 1 / 120), key=correlation)
        got = at(seen_s, seen_N, later_s)
        wanted_N, got_N = numpy.hypot(*want.T), numpy.hypot(*got.T)
        cosine = (want * got).sum(1) / numpy.maximum(wanted_N * got_N, 1e-9)
        angle = numpy.degrees(numpy.arccos(numpy.clip(cosine, -1, 1)))
        felt = wanted_N > FELT_N
        self.correlation = correlation(later_s)
        self.within_30 = 100 * (angle < 30)[felt].mean()
        self.beyond_60 = 100 * ((angle > 60) & (got_N > FELT_N / 2))[felt].mean()
        self.without = 100 * (got_N > NOTHING_N)[~felt].mean()

    def is_good(self):
        return self.within_30 >= 90 and self.beyond_60 <= 4 and self.without <= 8

    def __str__(self):
        return (f"correlation {self.correlation:.2f}, within 30 degrees {self.within_30:.0f} %, beyond 60 "
                f"{self.beyond_60:.0f} %; felt where the film gives nothing {self.without:.0f} %")


class Browser:
    """What each test of a browser does; its class says which one."""
    COMMAND = ()

    def setUp(self):
        for program in (self.COMMAND[0], "ffmpeg"):
            if not shutil.which(program):
                self.skipTest(f"{program} is not installed")
        super().setUp()
        Gst.init(None)
        if not Gst.ElementFactory.find("ximagesrc"):
            self.skipTest("ximagesrc, which reads the screen, is not installed")

    def make_film(self, rate_hz):
        command = (f"ffmpeg -y -v error -f rawvideo -pix_fmt gray -s {WIDTH}x{HEIGHT} -r {rate_hz} -i - -c:v libvpx "
                   "-pix_fmt yuv420p -b:v 6M -deadline realtime -cpu-used 8 film.webm")
        with subprocess.Popen(command.split(), cwd=self.folder, stdin=subprocess.PIPE) as encoder:
            for picture in pictures(rate_hz):
                encoder.stdin.write(picture.tobytes())
            encoder.stdin.close()
        self.gst("filesrc location=film.webm ! decodebin ! videoconvert ! spidarmotion device=none trace=film.jsonl ! fakesink")

    def browse(self, page):
        self.path("page.html").write_text("<!doctype html><meta charset=utf-8><title>film</title>"
                                          + PAGES.get(page, PAGES["page"]).format(x=FILM_AT[0], y=FILM_AT[1]) + PLAY
                                          + EVENTS.get(page, "") + "</script>", encoding="utf-8")
        env = dict(os.environ, HOME=str(self.folder), LIBGL_ALWAYS_SOFTWARE="1")
        env.pop("LD_PRELOAD", None)
        profile = self.path("profile")
        profile.mkdir(exist_ok=True)
        (profile / "user.js").write_text('user_pref("media.autoplay.default", 0);\nuser_pref("browser.aboutwelcome.enabled", '
                                         'false);\nuser_pref("datareporting.policy.dataSubmissionEnabled", false);\n',
                                         encoding="ascii")
        words = [word.format(profile=profile, page=f"file://{self.path('page.html')}") for word in self.COMMAND]
        browser = subprocess.Popen(words, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=self.folder,
                                   start_new_session=True)

        def end():
            try:
                os.killpg(browser.pid, 9)
            except ProcessLookupError:
                pass
            browser.wait()
        self.addCleanup(end)
        return end

    def look_at(self, page, length_s, *properties):
        """Plays the page, and looks at the screen for so long from when its film begins."""
        watched = Watched((0, 0) if page == "full screen" else FILM_AT)
        self.addCleanup(watched.stop)
        felt = self.look("", f"trace={self.path('screen.jsonl')}", *properties)
        end = self.browse(page)
        began_s = time.monotonic()
        if page == "full screen":
            time.sleep(20)
        else:
            self.assertTrue(comes(lambda: len(watched.seen) > 2), "the browser shows no film: " + self.said())
        time.sleep(length_s)
        with open(f"/proc/{felt.pid}/stat", encoding="ascii") as file:
            used = file.read().rpartition(")")[2].split()
        self.processor_s = (int(used[11]) + int(used[12])) / os.sysconf("SC_CLK_TCK")
        self.looked_s = time.monotonic() - began_s
        felt.terminate()
        self.assertEqual(felt.wait(), 0)
        watched.stop()
        end()
        return watched.seen

    def lags_s(self, seen):
        """From when each picture of the film is on the screen, which is seen within 5 ms, to the first tick with its force."""
        ticks = [(int(row["monotonic_ns"]) * 1e-9, int(row["frame_ns"])) for row in self.rows()]
        first_tick_s = {}
        for now_s, frame_ns in ticks:
            first_tick_s.setdefault(frame_ns, now_s)
        captured = self.captured()
        lags, at = [], 0
        for seen_s, _ in seen[1:]:
            while at < len(captured) and captured[at][0] < seen_s - .005:
                at += 1
            if at < len(captured) and captured[at][1] in first_tick_s and captured[at][0] < seen_s + .1:
                lags.append(first_tick_s[captured[at][1]] - seen_s)
        return sorted(lags)

    def captured(self):
        """(monotonic s, running ns) of each new picture."""
        playing = [row for row in self.rows() if row["playing"] == "1"]
        base_ns = int(statistics.median(int(row["monotonic_ns"]) - int(row["running_ns"]) for row in playing))
        running_s, _, repeated = forces(self.path("screen.jsonl"))
        running_ns = [round(1e9 * each) for each, again in zip(running_s, repeated) if not again]
        return [((base_ns + each) * 1e-9, each) for each in running_ns]

    def test_the_film_in_a_page_is_felt_as_it_is(self):
        """A browser that gets too little of the processor leaves out pictures, which is another film then: it may try again."""
        self.make_film(25)
        for page in ("page", "theatre", "second film", "full screen"):
            with self.subTest(page):
                for _ in range(3):
                    self.look_at(page, LENGTH_S + 2)
                    likeness = Likeness(forces(self.path("film.jsonl")), forces(self.path("screen.jsonl")))
                    print(f"{self.COMMAND[0]}, {page}: {likeness}", flush=True)
                    if likeness.is_good():
                        break
                self.assertTrue(likeness.is_good(), likeness)

    def test_nothing_is_felt_while_a_page_scrolls_with_a_film_that_pauses(self):
        self.make_film(25)
        # Of the page, too, some lines pass for a number. The film plays for three seconds.
        paused_s = max(now_s for now_s, at_s in self.look_at("scrolled", 7) if 1 < at_s < 4)
        felt_N = {"before": 0, "then": 0}
        for now_s, _, force_N, _ in bus_case.read_trace(self.trace):
            if now_s > paused_s - 2.5:
                when = "before" if now_s < paused_s else "then" if now_s > paused_s + .5 else "between"
                felt_N[when] = max(felt_N.get(when, 0), force_N)
        print(f"{self.COMMAND[0]}, scrolled: {felt_N}", flush=True)
        self.assertGreater(felt_N["before"], FELT_N)
        self.assertEqual(felt_N["then"], 0)

    def test_what_is_felt_is_what_is_seen(self):
        for rate_hz in (24, 25, 30, 60):
            with self.subTest(rate_hz):
                self.make_film(rate_hz)
                lags = self.lags_s(self.look_at("film alone", LENGTH_S - 2))
                print(f"{self.COMMAND[0]}, {rate_hz} pictures/s: {1e3 * statistics.median(lags):.1f} ms late in the median, 95 % "
                      f"within {1e3 * lags[int(.95 * len(lags))]:.1f} ms, {len(lags)} pictures; "
                      f"{100 * self.processor_s / self.looked_s:.0f} % of a core", flush=True)
                self.assertGreater(len(lags), 4 * rate_hz)


class Chromium(Browser, screen.ScreenCase, test_screen.LookedAtCase):
    COMMAND = ("chromium", "--no-sandbox", "--disable-gpu", "--no-first-run", "--user-data-dir={profile}",
               "--autoplay-policy=no-user-gesture-required", "--window-size=1280,800", "--window-position=0,0", "--kiosk",
               "{page}")


class Firefox(Browser, screen.ScreenCase, test_screen.LookedAtCase):
    COMMAND = ("firefox-esr", "--no-remote", "--profile", "{profile}", "--width", "1280", "--height", "800", "--kiosk", "{page}")


if __name__ == "__main__":
    unittest.main()
