# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The page of spidartrack export in the browsers that Debian can drive: Chromium, and WebKit, which Safari is made of.
With SPIDAR_SCREENSHOTS, pictures of it are left in that folder."""
import glob
import os
import pathlib
import shutil
import time
import unittest

import screen
import track_case

try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.chrome.service import Service as ChromeService
    from selenium.webdriver.common.by import By
except ImportError:
    webdriver = None

MINI_BROWSER = sorted(glob.glob("/usr/lib/*/webkit2gtk-4.*/MiniBrowser"))
LONGEST_S = 60
# What the console would show, from the beginning.
COLLECT = """<script>
window.faults = [];
addEventListener("error", (event) => faults.push(event.message || "what " + event.target.id + " loads"), true);
addEventListener("unhandledrejection", (event) => faults.push(String(event.reason)));
addEventListener("securitypolicyviolation", (event) => faults.push("policy: " + event.violatedDirective));
console.error = (...words) => faults.push(words.join(" "));
</script>
"""
# The white arrow, the curve, and how thick the shaft is near its beginning, in pixels of the page.
LOOK = """
const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
const boxOf = (isIt) => {
  const box = { left: 1e9, top: 1e9, right: -1, bottom: -1, count: 0 };
  for (let y = 0, i = 0; y < canvas.height; ++y) for (let x = 0; x < canvas.width; ++x, i += 4) {
    if (!isIt(pixels[i], pixels[i + 1], pixels[i + 2], pixels[i + 3])) continue;
    box.left = Math.min(box.left, x); box.right = Math.max(box.right, x);
    box.top = Math.min(box.top, y); box.bottom = Math.max(box.bottom, y);
    ++box.count;
  }
  return box;
};
const arrow = boxOf((r, g, b, a) => r + g + b + a === 4 * 255);
const curve = boxOf((r, g, b, a) => r > 200 && g > 100 && g < 200 && b < 100 && a > 200);
let thick = 0;
for (let y = 0; y < canvas.height; ++y) if (pixels[4 * (y * canvas.width + arrow.left + 2)] === 255 &&
  pixels[4 * (y * canvas.width + arrow.left + 2) + 2] === 255) ++thick;
const page = document.documentElement;
return { arrow, curve, thick, said: said.textContent, how: part("how").textContent, about: part("pad").textContent,
  size: [canvas.width, canvas.height], picture: [film.videoWidth, film.videoHeight], time_s: film.currentTime,
  over: [page.scrollWidth - innerWidth, page.scrollHeight - innerHeight], faults };
"""


def chromium(folder):
    options = webdriver.ChromeOptions()
    for option in ("headless=new", "no-sandbox", "disable-gpu", f"user-data-dir={folder / 'profile'}"):
        options.add_argument("--" + option)
    options.binary_location = shutil.which("chromium")
    return webdriver.Chrome(options=options, service=ChromeService(shutil.which("chromedriver")))


def webkit(_):
    options = webdriver.WebKitGTKOptions()
    options.binary_location = MINI_BROWSER[-1]
    options.add_argument("--automation")
    return webdriver.WebKitGTK(options=options)


BROWSERS = {
    "Chromium": (chromium, "chromium, chromium-driver", shutil.which("chromium") and shutil.which("chromedriver")),
    "WebKit": (webkit, "webkit2gtk-driver", shutil.which("WebKitWebDriver") and MINI_BROWSER),
}


def force(ms):
    """To the right with 2 N for two seconds, then upwards with 3 N."""
    return (.2, 0, 0, 0, 0, 0) if ms < 2000 else (0, .3, 0, 0, 0, 0)


class Page(screen.ScreenCase, track_case.TrackCase):
    def make_page(self, encoder="libx264 -pix_fmt yuv420p", film="film.mp4", *more):
        self.run_in_folder("ffmpeg -nostdin -v error -f lavfi -i testsrc2=size=320x180:rate=25:duration=4 "
                           f"-c:v {encoder} {film}")
        self.make_track("film.wav", count=4000, sample=force)
        self.spidartrack("export", film, "page.html", "--track", "film.wav", *more)
        text = self.path("page.html").read_text(encoding="utf-8")
        self.path("page.html").write_text(text.replace("<style>", COLLECT + "<style>", 1), encoding="utf-8")

    def browse(self):
        """Each browser that is here, with the page."""
        for name, (start, packages, is_here) in BROWSERS.items():
            if not is_here:
                print(f"skipped: {name}: {packages} is not installed")
                continue
            browser = start(self.folder)
            try:
                browser.get(self.path("page.html").as_uri())
                yield name, browser
            finally:
                browser.quit()

    def wait(self, browser, condition):
        end = time.monotonic() + LONGEST_S
        while not browser.execute_script("return " + condition):
            self.assertLess(time.monotonic(), end, f"{condition}: {browser.execute_script(LOOK)}")
            time.sleep(.05)

    def look(self, browser, name):
        """After two more pictures of the screen."""
        browser.execute_async_script("const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done));")
        if folder := os.environ.get("SPIDAR_SCREENSHOTS"):
            browser.save_screenshot(str(pathlib.Path(folder) / f"{name}.png"))
        return browser.execute_script(LOOK)

    def seek(self, browser, time_s):
        browser.execute_script("film.pause(); film.currentTime = arguments[0];", time_s)
        self.wait(browser, f"!film.seeking && Math.abs(film.currentTime - {time_s}) < .05 && film.readyState > 1")

    def test_a_click_and_the_space_bar_play_and_pause(self):
        self.make_page()
        for name, browser in self.browse():
            for width, height in (390, 844), (1280, 800):
                browser.set_window_size(width, height)
                browser.refresh()
                self.wait(browser, "film.readyState > 1 && !film.seeking && film.currentTime > 1")
                self.assertEqual(self.look(browser, f"{name}-poster-{width}")["over"], [0, 0])
                self.assertEqual(browser.execute_script("return [film.controls, part('begin').hidden]"), [False, False])
                browser.execute_script("film.loop = film.muted = true;")  # however long the clicks take
                picture = browser.find_element(By.ID, "stage")

                def space():
                    ActionChains(browser).send_keys(" ").perform()

                def click():
                    ActionChains(browser).move_to_element_with_offset(picture, 0, -60).click().perform()
                for act in (space, space, click, click, space):
                    was_paused = browser.execute_script("return film.paused")
                    act()
                    self.wait(browser, f"film.paused === {str(not was_paused).lower()}")
                self.assertEqual(browser.execute_script("return [film.controls, part('begin').hidden]"), [True, True])
                self.look(browser, f"{name}-plays-{width}")
                browser.execute_async_script("setTimeout(arguments[0], 300)")  # nothing else pauses it again
                self.assertFalse(browser.execute_script("return film.paused"))
                browser.execute_script("film.pause()")
                browser.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
                browser.execute_script("window.drawn = 0; canvas.getContext('2d').clearRect = () => ++drawn;")
                browser.execute_async_script("setTimeout(arguments[0], 300)")
                self.assertEqual(browser.execute_script("return drawn"), 0)
                self.assertEqual(browser.execute_script("return faults"), [])

    def test_it_loads_plays_seeks_and_shows_the_force_of_the_moment(self):
        self.make_page()
        for name, browser in self.browse():
            browser.set_window_size(1000, 700)
            self.wait(browser, "film.readyState > 1 && !film.seeking")
            browser.execute_script("film.muted = true; film.play();")
            self.wait(browser, "film.currentTime > .3")
            self.seek(browser, 1)
            right = self.look(browser, name + "-right")
            self.assertEqual((right["said"], right["picture"]), ("2.0 N", [320, 180]))
            self.seek(browser, 3)
            up = self.look(browser, name + "-up")
            self.assertEqual(up["said"], "3.0 N")
            width, height = right["size"]
            px_N = min(height, width * 180 / 320) / 5 / 3
            for seen, along, across, force_N in ((right, ("left", "right"), ("top", "bottom"), 2),
                                                 (up, ("top", "bottom"), ("left", "right"), 3)):
                arrow = seen["arrow"]
                self.assertAlmostEqual(arrow[along[1]] - arrow[along[0]], force_N * px_N, delta=.1 * force_N * px_N)
                self.assertLess(arrow[across[1]] - arrow[across[0]], arrow[along[1]] - arrow[along[0]])
                self.assertGreater(seen["curve"]["count"], 50)
                self.assertEqual(seen["over"], [0, 0])
                self.assertIn("The arrow is the force that a hand would feel", seen["how"])
            self.assertAlmostEqual(right["arrow"]["left"], width / 2, delta=4)
            self.assertLess(up["curve"]["top"], right["curve"]["top"])  # 3 N are higher than 2
            browser.find_element(By.ID, "wide").click()
            self.wait(browser, "document.fullscreenElement === part('stage')")
            self.look(browser, name + "-full")
            browser.execute_script("document.exitFullscreen();")
            self.wait(browser, "!document.fullscreenElement")
            self.assertEqual(self.look(browser, name)["faults"], [])

    def test_a_page_whose_film_does_not_play_says_why_and_what_helps(self):
        for film, why in (("film.mp4", "because its picture is video/mpeg simple. "), ("film.mkv", "because it is neither MP4 nor WebM. ")):
            self.make_page("mpeg4", film)
            for name, browser in self.browse():
                if name != "WebKit":  # whose GStreamer plays both
                    self.wait(browser, "film.error || said.textContent.includes('does not play')")
                    said = self.look(browser, f"{name}-{film}")["said"]
                    self.assertIn("does not play, " + why, said)
                    self.assertIn(f"“spidartrack export {film} FOLDER/”", said)
            self.path("page.html").unlink()

    def test_a_gamepad_vibrates_in_time_with_the_film(self):
        """By the force of the moment: 2 N of 3, and then all of it."""
        self.make_page()
        for _, browser in self.browse():
            browser.execute_script("""window.pulses = []; navigator.getGamepads = () => [{ vibrationActuator: {
                playEffect(kind, effect) { pulses.push([film.currentTime, effect.strongMagnitude]); return Promise.resolve(); } } }];
                film.muted = true; film.currentTime = 1.5; film.play();""")
            self.wait(browser, "film.ended && pulses.length > 2")
            for time_s, strength in browser.execute_script("return pulses")[:-1]:  # the last one ends it
                # The time may have gone on meanwhile.
                self.assertTrue(abs(time_s - 2) < .1 or abs(strength - (2 / 3 if time_s < 2 else 1)) < .02, (time_s, strength))

    def test_it_is_as_clear_on_an_upright_telephone(self):
        self.make_page()
        for name, browser in self.browse():
            thick = []
            for way, size in (("portrait", (500, 900)), ("landscape", (900, 500))):
                browser.set_window_size(*size)
                self.wait(browser, "film.readyState > 1")
                self.seek(browser, 1)
                seen = self.look(browser, f"{name}-{way}")
                self.assertEqual(seen["over"], [0, 0], way)
                thick.append(seen["thick"])
            self.assertGreater(thick[0], .85 * thick[1], thick)

    def test_a_film_in_the_page_plays(self):
        for film, encoder in (("film.mp4", "libx264 -pix_fmt yuv420p"), ("film.webm", "libvpx")):
            self.make_page(encoder, film, "--embed")
            self.path(film).unlink()
            for name, browser in self.browse():
                self.wait(browser, "film.readyState > 1 && film.videoWidth === 320")
                self.seek(browser, 3)
                seen = self.look(browser, f"{name}-{film}")
                self.assertEqual((seen["said"], seen["faults"]), ("3.0 N", []))
            self.path("page.html").unlink()


if __name__ == "__main__":
    if not webdriver or not any(is_here for _, _, is_here in BROWSERS.values()):
        print("skipped: needs python3-selenium, and chromium-driver or webkit2gtk-driver")
        raise SystemExit(77)
    unittest.main()
