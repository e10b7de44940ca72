# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The files that spidartrack writes, whatever their names are and whatever a shell has closed."""
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import time
import unicodedata
import unittest

import track_case
from track_case import PROGRAM


class Files(track_case.TrackCase):
    def make_long_track(self, name, seconds):
        """Of rest, which takes no room on the disk."""
        size = seconds * 24000
        with open(self.path(name), "wb") as file:
            file.write(b"RIFF" + struct.pack("<I", 36 + size) + b"WAVEfmt " +
                       struct.pack("<IHHIIHH", 16, 3, 6, 1000, 24000, 24, 32) + b"data" + struct.pack("<I", size))
            file.truncate(44 + size)

    def memory_of(self, command):
        """The most that it has taken, in MB."""
        script = ("import resource, subprocess, sys; subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=False); "
                  "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024)")
        # The address sanitizer keeps 256 MB of what has been freed.
        env = dict(os.environ, ASAN_OPTIONS=os.environ.get("ASAN_OPTIONS", "") + ":quarantine_size_mb=1")
        return int(self.run_in_folder([sys.executable, "-c", script, *command], env=env).splitlines()[-1])

    def test_memory_does_not_grow_with_the_length_of_a_track(self):
        """Not by the 24 MB that every 17 minutes take as samples."""
        self.make_long_track("short.wav", 10)
        self.make_long_track("long.wav", 3600)
        for command in (["info"], ["check"], ["convert", "b.flac"], ["convert", "b.hjif"], ["convert", "b.ahap"],
                        ["convert", "b.funscript"]):
            short, long = (self.memory_of([PROGRAM, command[0], name, *command[1:]]) for name in ("short.wav", "long.wav"))
            self.assertLess(long, short + 20, command)

    def test_a_track_is_read_as_it_is_played(self):
        self.make_long_track("short.wav", 600)
        self.make_long_track("long.wav", 3 * 3600)
        read = {}
        for name in ("short.wav", "long.wav"):
            said = self.run_in_folder(
                "gst-launch-1.0 -q videotestsrc num-buffers=25 ! video/x-raw,width=64,height=48,framerate=25/1 ! identity "
                f"! spidarmotion device=none track={name} ! fakesink; cat /proc/$$/io")
            read[name] = int(re.search(r"rchar: (\d+)", said).group(1))
        # As much of each, but for how far the reader gets ahead, which is a matter of scheduling: parsebin and decodebin have
        # queues of 2 MB each, ReadAhead ten seconds, of 24 kB each. The whole has 245 MB more.
        self.assertLess(read["long.wav"], read["short.wav"] + 2 * 2 ** 21 + 10 * 24_000 + 100_000)

    def test_a_file_of_no_known_format_is_named_as_such(self):
        self.path("broken.mp4").write_bytes(bytes(range(128, 256)) * 1000)
        for command in (["info", "broken.mp4"], ["show", "broken.mp4", "shown.mp4"], ["export", "broken.mp4", "page.html"]):
            self.assert_said("broken.mp4: it is damaged, or of a format that GStreamer does not know", *command)

    def test_what_is_printed_does_not_go_into_a_file(self):
        self.make_film()
        self.spidartrack("record", "film.avi")
        whole = self.path("film.avi.haptic.flac").read_bytes()
        for closed in (">&-", "<&- >&-", ">&- 2>&-", "<&- >&- 2>&-"):
            with self.subTest(closed):
                self.run_in_folder(f"{PROGRAM} record --force film.avi {closed}")
                self.assertEqual(self.path("film.avi.haptic.flac").read_bytes(), whole)
                self.run_in_folder(f"{PROGRAM} convert film.avi.haptic.flac a.funscript {closed}")
                self.assertEqual(self.path("a.funscript").read_bytes()[:1], b"{")

    def test_a_film_has_a_track_where_the_name_of_that_fits(self):
        self.make_film()
        for length in (230, 243):  # and 12 bytes for .haptic.flac are 255
            name = "あ" * ((length - 4) // 3) + "x" * ((length - 4) % 3) + ".avi"
            os.link(self.path("film.avi"), self.path(name))
            self.spidartrack("record", name)
            self.assertEqual(len(self.samples(name + ".haptic.flac")), 1000)
        self.path(name).rename(self.path("x" + name))
        self.assert_said("name too long", "record", "x" + name)

    def test_what_lies_beside_a_film_is_found_in_either_form_of_its_name(self):
        """Letters with accents as one character or two, also in the names of folders."""
        composed, decomposed = (unicodedata.normalize(form, "Café") for form in ("NFC", "NFD"))
        self.make_film("film.avi")
        tracks = dict(os.environ, SPIDAR_TRACK_PATH=str(self.path("tracks")))
        for film, other in ((composed, decomposed), (decomposed, composed)):
            self.path(film).mkdir()
            self.path("film.avi").rename(self.path(f"{film}/{film}.avi"))
            for track, env in ((f"{film}/{other}.avi.haptic.wav", None), (f"tracks/{other}/{other}.haptic.wav", tracks)):
                self.path(track).parent.mkdir(parents=True, exist_ok=True)
                self.make_track(track)
                self.assertIn("the haptic track is ", self.spidartrack("info", f"{film}/{film}.avi", env=env))
                self.path(track).unlink()
            self.path(f"tracks/{other}").rmdir()
            for script in (other, other + ".roll"):
                script = self.path(f"{film}/{script}.funscript")
                script.write_text('{"actions":[{"at":0,"pos":50},{"at":100,"pos":100}]}')
                said = self.run_in_folder(f"gst-launch-1.0 filesrc location={film}/{film}.avi ! decodebin ! videoconvert ! "
                                          "spidarmotion device=none track=auto ! fakesink")
                self.assertIn(f"{script.name}: ", said)
                script.unlink()
            self.path(f"{film}/{film}.avi").rename(self.path("film.avi"))

    def test_nothing_that_lies_at_the_name_of_a_part_file_is_written_into(self):
        self.make_film()
        self.path("out").mkdir()
        part = self.path("out") / track_case.part_name("film.avi.haptic.flac")
        mine = self.path("mine")
        mine.write_text("mine")
        part.symlink_to(mine)
        self.assert_said("remove it", "record", "film.avi", "--folder", "out")
        self.assertEqual(mine.read_text(), "mine")
        part.unlink()
        os.link(mine, part)
        self.spidartrack("record", "film.avi", "--folder", "out")
        self.assertEqual(mine.read_text(), "mine")
        # What a killed process left.
        part.write_text("x" * 1000000)
        self.spidartrack("record", "--force", "film.avi", "--folder", "out")
        self.assertEqual(len(self.samples("out/film.avi.haptic.flac")), 1000)
        self.assertEqual(os.listdir(part.parent), ["film.avi.haptic.flac"])

    def test_a_file_that_is_read_is_never_written_whatever_its_name(self):
        self.make_film()
        self.make_film("clip.avi")
        self.make_track()
        self.path("rules.feel").write_text("0:00-0:01 largest\n")
        for name, of, link in (("film.avi.haptic.flac", "film.avi", os.link), ("a.mp4", "film.avi", os.link),
                               ("clip.mp4", "clip.avi", os.link), ("a.png", "a.wav", os.symlink), ("b.wav", "a.wav", os.symlink)):
            link(self.path(of), self.path(name))
        self.path("script.sway.funscript").write_text('{"actions":[{"at":0,"pos":9},{"at":99,"pos":80}]}')
        self.path("script.funscript").write_text('{"actions":[{"at":0,"pos":9},{"at":99,"pos":90}]}')
        before = {name: self.path(name).read_bytes() for name in self.files()}
        commands = [["record", "film.avi", "--force"], ["show", "film.avi", "a.mp4"], ["convert", "a.wav", "b.wav"],
                    ["convert", "script.funscript", "script.funscript"], ["export", "clip.avi", "./"],
                    ["convert", "script.funscript", "script.x.funscript", "--axis", "all"],
                    ["record", "film.avi", "--format", "wav", "--manifest", "film.avi"],
                    ["record", "film.avi", "--format", "wav", "--manifest", "script.funscript"],
                    ["record", "film.avi", "--format", "wav", "--manifest", "rules.feel", "--", "feel=rules.feel"]]
        os.symlink("script.sway.funscript", self.path("script.x.sway.funscript"))
        if shutil.which("gnuplot"):
            commands.append(["plot", "a.wav", "a.png"])
        for command in commands:
            for force in ([],) if "--force" in command else ([], ["--force"]):
                with self.subTest(command + force):
                    at = command.index("--") if "--" in command else len(command)
                    said = self.spidartrack(*command[:at], *force, *command[at:], status=1)
                    self.assertRegex(said, "is to be another file than|is no manifest|exists, and|has not made it")
                    for name, content in before.items():
                        self.assertEqual(self.path(name).read_bytes(), content, name)

    def test_what_has_no_name_of_the_user_is_replaced_only_if_it_was_made(self):
        self.make_film()
        self.path("site").mkdir()
        self.path("site/index.html").write_text("my page")
        self.assert_said("exists, and nothing says that spidartrack export has made it", "export", "film.avi", "site/", "--force")
        self.assertEqual(self.path("site/index.html").read_text(), "my page")
        self.assertEqual(self.files(), {"film.avi", "site/index.html"})
        self.make_track("film.avi.haptic.wav")
        mine = self.path("film.avi.haptic.wav").read_bytes()
        self.assert_said("has not made it, and does not replace it", "record", "film.avi", "--format", "wav", "--force")
        self.assertEqual(self.path("film.avi.haptic.wav").read_bytes(), mine)
        self.assertIn("film.avi.haptic.wav is not played as long as film.avi.haptic.flac is there",
                      self.spidartrack("record", "film.avi"))

    def test_names_and_rules_of_any_kind(self):
        self.make_film("-x.avi")
        self.path("films").mkdir()
        self.make_film("films/film.avi")
        self.spidartrack("record", "-x.avi")
        self.assertIn("-x.avi.haptic.flac", self.files())
        self.spidartrack("info", "-x.avi")
        for folder in "Ring: the first", "a:b:c":
            said = self.spidartrack("record", "films", "--folder", folder)
            place = re.search(r"SPIDAR_TRACK_PATH=(.*)\n", said).group(1)
            self.assertEqual(place, str(self.path(folder)))
            self.spidartrack("info", "films/film.avi", "--folder", folder)
            for others in "{}", "/none:{}", "{}:/none", "/tmp:{}:/none":
                self.spidartrack("info", "films/film.avi", env=dict(os.environ, SPIDAR_TRACK_PATH=others.format(place)))
        # More than Linux takes as an argument of a process.
        self.path("rules.feel").write_text("".join(f"{k}-{k}.5 largest\n" for k in range(8000)))
        self.spidartrack("record", "films", "--force", "--", "feel=rules.feel")
        self.assertIn("is there", self.spidartrack("record", "films", "--", "feel=rules.feel"))

    @unittest.skipUnless(shutil.which("gnuplot"), "needs gnuplot")
    def test_a_picture_does_not_depend_on_the_settings_of_gnuplot(self):
        self.make_track()
        self.spidartrack("plot", "a.wav", "plain.png")
        self.path(".gnuplot").write_text("set datafile separator ','\nset logscale x\nset key off\n")
        self.spidartrack("plot", "a.wav", "with.png", env=dict(os.environ, HOME=str(self.folder)))
        self.assertEqual(self.path("with.png").read_bytes(), self.path("plain.png").read_bytes())

    def test_what_cannot_be_written_is_an_error_and_leaves_nothing(self):
        """A limit of the size of a file stands for a full disk: the write fails in the same way."""
        self.make_track(count=2000)  # more than 8 KiB in every format
        self.make_film()
        before = self.files()
        commands = [f"convert a.wav b.{end}" for end in ("flac", "mka", "wav", "hjif")]
        commands += [f"record film.avi --format {name}" for name in ("flac", "mka", "wav")]
        if shutil.which("gnuplot"):
            commands.append("plot a.wav b.png")
        for command in commands:
            with self.subTest(command):
                said = self.run_in_folder(f"trap '' XFSZ; ulimit -f 2; {PROGRAM} {command}", status=1)
                self.assertNotEqual(said, "")
                if command.startswith("record"):
                    self.assertIn("film.avi: failed: Could not write to resource.", said)
                self.assertEqual(self.files(), before)

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_what_cannot_be_printed_is_an_error(self):
        self.make_track()
        self.make_film()
        for command in ("--version", "--help", "info a.wav", "info --json a.wav", "check a.wav", "convert a.wav a.ahap",
                        "record film.avi film.avi"):
            with self.subTest(command):
                said = self.run_in_folder(f"{PROGRAM} {command} > /dev/full", status=1)
                self.assertIn("spidartrack: what is printed cannot be written", said)
        # A reader that had enough needs no message.
        reader, writer = os.pipe()
        os.close(reader)
        run = subprocess.run([PROGRAM, "check", "a.wav"], cwd=self.folder, stdout=writer, stderr=subprocess.PIPE, check=False)
        os.close(writer)
        self.assertEqual((run.returncode, run.stderr), (1, b""))

    def test_a_low_limit_of_the_stack_is_enough(self):
        """It is also that of the threads, as 128 KiB are with musl."""
        self.make_film()
        for name in ("flac", "mka", "wav"):
            self.run_in_folder(f"ulimit -s 128; {PROGRAM} record film.avi --format {name}")

    def test_messages_name_the_output_that_was_given(self):
        self.make_track()
        for name in ("b.flac", "b.hjif"):
            self.assert_said(f"spidartrack: none/{name}: cannot be written: there is no folder none\n", "convert", "a.wav", f"none/{name}")
        self.assert_said("file:///tmp/b.flac: cannot be written: there is no folder file:///tmp; a file name is needed",
                         "convert", "a.wav", "file:///tmp/b.flac")

    @track_case.needs("gnuplot")
    def test_a_plot_runs_no_command_that_a_name_contains(self):
        self.make_track()
        for name in ("|touch ran", "< touch ran", "it's.png", "'; system 'touch ran'; a='", "`touch ran`",
                     "$(touch ran)", "two\nlines.png", "100%s.png", b"\xff\xfe.png"):
            self.spidartrack("plot", "a.wav", name)
            name = name.decode(errors="surrogateescape") if isinstance(name, bytes) else name
            self.assertEqual(self.path(name).read_bytes()[:4], b"\x89PNG")
            self.assertFalse(self.path("ran").exists())

    def stand_in_for_gnuplot(self, script):
        """Runs plot with a program of this text in the place of gnuplot, which is in the Debian package."""
        self.path("bin").mkdir(exist_ok=True)
        self.path("bin/gnuplot").write_text("#!/bin/sh\n" + script)
        self.path("bin/gnuplot").chmod(0o755)
        return dict(os.environ, PATH=f"{self.path('bin')}:{os.environ['PATH']}")

    def test_what_gnuplot_says_is_part_of_the_message(self):
        self.make_track()
        before = self.files()
        self.assert_said("Debian package gnuplot-nox", "plot", "a.wav", "a.png", env=dict(os.environ, PATH="/nowhere"))
        self.assertEqual(self.files(), before)
        env = self.stand_in_for_gnuplot("echo some warning >&2\ncat > /dev/null\necho no terminal >&2\nexit 1\n")
        self.assertEqual(self.spidartrack("plot", "a.wav", "a.png", env=env, status=1),
                         "spidartrack: gnuplot could not draw the picture: no terminal\n")

    def test_a_signal_removes_what_is_incomplete(self):
        """While a stand-in for gnuplot draws, and while a long film is recorded."""
        self.make_track()
        self.make_film(frames=4000)
        env = self.stand_in_for_gnuplot("cat > /dev/null\nwhile kill -0 $PPID; do sleep .02; done 2> /dev/null\n")
        before = self.files()
        for command in (["plot", "a.wav", "a.png"], ["record", "film.avi"]):
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                with self.subTest(command=command, number=number):
                    # The tests may have been started with nohup.
                    running = subprocess.Popen(
                        [PROGRAM, *command], cwd=self.folder, env=env, stdout=subprocess.DEVNULL,
                        preexec_fn=lambda number=number: signal.signal(number, signal.SIG_DFL))
                    while running.poll() is None and self.files() == before:
                        time.sleep(.005)
                    self.assertIsNone(running.poll())
                    running.send_signal(number)
                    self.assertEqual(running.wait(), -number, "as its caller expects")
                    self.assertEqual(self.files(), before)


if __name__ == "__main__":
    unittest.main()
