# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidartrack record with several films, processes and properties."""
import fcntl
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import unittest

import track_case
from track_case import PROGRAM


class Batch(track_case.TrackCase):
    def tearDown(self):
        self.assertFalse([name for name in self.files() if ".part-" in name])

    def json_lines(self, name):
        return [json.loads(line) for line in self.path(name).read_text().splitlines()]

    def test_wrong_usage_says_what_would_be_right(self):
        self.assertIn("record", self.spidartrack("--help"))
        for command in ("record", "info", "check", "convert", "plot"):
            self.assertIn(command, self.spidartrack(command, "--help"))
            self.spidartrack(command, status=2)
        for arguments, said in ((["frobnicate"], "frobnicate is not a command; commands are record, info, check"),
                                (["record", "x.mp4", "--format", "ogg"], "flac"),
                                (["record", "x.mp4", "--", "motion", "camera"],
                                 "motion: has no value; type motion=VALUE, where VALUE is one of mean, object,"),
                                (["record", "x.mp4", "--", "max-force"], "where VALUE is a number from 0 to 20."),
                                (["record", "x.mp4", "--", "camera"], "camera: is not PROPERTY=VALUE, such as max"),
                                (["record", "x.mp4", "motion=camera"], "spidartrack record FILM -- motion=camera"),
                                (["record", "-j0", "x.mp4"], '"0" is not a number from 1 to 1024'),
                                (["check", "x.wav", "--max-force", "nan"], '"nan" is not a number from 0 to 20 N'),
                                (["convert", "x.wav"], "TO"), (["info", "x.wav", "y.wav"], "y.wav"),
                                (["info", "--jsom", "x.wav"], "--jsom")):
            self.assert_said(said, *arguments, status=2)

    def test_a_plugin_that_gstreamer_does_not_search_is_found(self):
        self.make_film("a.avi", 5)
        self.make_film("b.avi", 5)
        nowhere = {**os.environ, "GST_PLUGIN_PATH": "", "GST_PLUGIN_PATH_1_0": "",
                   "GST_REGISTRY": str(self.path("registry"))}
        self.assertIn("2 recorded", self.run_in_folder([PROGRAM, "record", "a.avi", "b.avi"], env=nowhere))
        away = self.path("away")
        shutil.copy(PROGRAM, away)
        said = self.run_in_folder([away, "record", "a.avi", "b.avi", "--force"], status=1, env=nowhere)
        self.assertEqual(said.count("spidarmotion"), 1, said)
        self.assertIn("set GST_PLUGIN_PATH to the folder of libgstspidar.so", said)

    def test_films_are_recorded_once(self):
        self.make_film("a film.avi", 50)
        self.make_film("b.avi", 25)
        said = self.spidartrack("record", "-j2", "a film.avi", "b.avi")
        for part in ("[1/2] ", "[2/2] ", "2 recorded, 0 there, 0 failed"):
            self.assertIn(part, said)
        # 40 ms a frame.
        self.assertEqual(len(self.samples("a film.avi.haptic.flac")), 2000)
        track = self.samples("b.avi.haptic.flac")
        self.assertEqual(len(track), 1000)
        self.assertGreater(max(abs(sample[0]) for sample in track), .05)
        before = os.stat(self.path("b.avi.haptic.flac")).st_mtime_ns
        self.assertIn("is there", self.spidartrack("record", "a film.avi", "b.avi"))
        self.assertEqual(os.stat(self.path("b.avi.haptic.flac")).st_mtime_ns, before)
        self.assert_said("there is no such file", "record", "none.avi")
        for words, line in ((["none.flac"], "&& mv 'a film.avi.haptic.flac' none.flac"),
                            (["-o", "a track.flac"], "&& mv 'a film.avi.haptic.flac' 'a track.flac'"),
                            (["--output=out.wav"], "--format wav && mv 'a film.avi.haptic.wav' out.wav"),
                            (["-o", "x.hjif"], "&& spidartrack convert 'a film.avi.haptic.flac' x.hjif"),
                            (["-oout"], "&& mv 'a film.avi.haptic.flac' out"), (["-o", "out/"], "--folder out/")):
            self.assert_said(": a track is named after its film; type: spidartrack record 'a film.avi' " + line, "record",
                             "a film.avi", *words, status=2)
        self.spidartrack("record", "--format", "wav", "b.avi", "--", "max-force=1")
        for sample in self.samples("b.avi.haptic.wav"):
            self.assertLessEqual(sum(value * value for value in sample[:3]) ** .5, .1 + 1e-6)

    def test_films_of_one_name_have_tracks_of_their_own(self):
        self.make_film("x.avi", 50)
        self.make_film("x.mkv", 25)
        self.spidartrack("record", "x.avi", "x.mkv")
        self.assertEqual(len(self.samples("x.avi.haptic.flac")), 2000)
        self.assertEqual(len(self.samples("x.mkv.haptic.flac")), 1000)
        self.make_film("A/y.avi", 50)
        self.make_film("B/y.avi", 25)
        self.path("out").mkdir()
        self.assert_said("out/y.avi.haptic.flac is for A/y.avi", "record", "--folder", "out", "A/y.avi", "B/y.avi")
        self.assertEqual(len(self.samples("out/y.avi.haptic.flac")), 2000)
        said = self.spidartrack("record", "A/y.avi", "./A/y.avi")
        self.assertIn("is given twice", said)
        self.assertIn("there, 1 given twice, 0 failed\n", said)

    def test_a_folder_stands_for_its_films_the_largest_first(self):
        self.make_film("in/small.avi", 25)
        self.make_film("in/a b/LARGE.AVI", 75)
        self.make_film("in/.hidden.avi", 25)
        self.path("in/notes.txt").write_text("no film")
        self.path("in/empty.mkv").touch()
        self.path("out").mkdir()
        command = ("record", "--jobs", "1", "in", "--folder", "out", "--manifest", "done.jsonl")
        said = self.spidartrack(*command, status=1)
        for part in ("[1/3] in/a b/LARGE.AVI: out/a b/LARGE.AVI.haptic.flac",
                     "[2/3] in/small.avi: out/small.avi.haptic.flac", "2 recorded, 0 there, 1 failed"):
            self.assertIn(part, said)
        self.assertEqual(len(self.samples("out/a b/LARGE.AVI.haptic.flac")), 3000)
        lines = self.json_lines("done.jsonl")
        self.assertEqual([(line["film"], line["result"]) for line in lines],
                         [("in/a b/LARGE.AVI", "recorded"), ("in/small.avi", "recorded"), ("in/empty.mkv", "failed")])
        self.assertEqual(lines[0]["duration_s"], 3)
        self.assertGreater(lines[0]["largest_force_N"], .1)
        self.assertTrue(0 < lines[0]["felt"] <= 1)
        self.assertTrue(lines[2]["error"])
        self.assertNotIn("track", lines[2])
        # The other failed, and is tried again.
        self.spidartrack(*command, status=1)
        again = self.json_lines("done.jsonl")
        self.assertEqual(len(again), 6)
        self.assertEqual((again[3]["result"], again[3]["felt"]), ("there", lines[0]["felt"]))
        self.path("none").mkdir()
        self.assert_said("none: this folder has no film", "record", "none")
        self.assert_said("in/small.avi: is a file, and tracks go into a folder", "record", "in", "--folder", "in/small.avi", status=2)
        # A share that is not mounted is not written to under its name.
        self.assert_said("away/tracks: is not made, because there is no folder ", "record", "in", "--folder", "away/tracks")
        self.assertFalse(self.path("away").exists())

    def test_a_folder_of_tracks_is_made_and_its_tracks_are_found(self):
        self.make_film("lib/b c/film.avi")
        self.make_film("lib/film.avi", pattern="smpte")  # another one of this name
        said = self.spidartrack("record", "lib", "--folder", "tracks", "--manifest", "tracks/films.jsonl")
        self.assertIn(f"players find these tracks with SPIDAR_TRACK_PATH={self.path('tracks')}\n", said)
        self.assertEqual(len(self.json_lines("tracks/films.jsonl")), 2)
        self.assert_said("a film without a haptic track", "info", "lib/film.avi")
        setting = dict(os.environ, SPIDAR_TRACK_PATH=f"{self.path('none')}:{self.path('tracks')}")
        user = self.path("home/gst-spidar")
        user.mkdir(parents=True)
        user.joinpath("tracks").symlink_to(self.path("tracks"))
        for how, more, env in (("--folder", ["--folder", "tracks"], None), ("variable", [], setting),
                               ("user", [], dict(os.environ, XDG_DATA_HOME=str(self.path("home"))))):
            for film, folder in (("lib/b c/film.avi", "tracks/b c"), ("lib/film.avi", "tracks")):
                with self.subTest(how, film=film):
                    said = self.spidartrack("info", film, *more, env=env)
                    self.assertRegex(said, f"film.avi: the haptic track is in [^\n]*{folder}\n")
        self.spidartrack("plot", "lib/film.avi", "film.png", "--folder", "tracks")
        self.assertNotIn("frames are felt", self.spidartrack("export", "lib/film.avi", "page.html", env=setting))
        said = self.run_in_folder("gst-launch-1.0 filesrc location='lib/b c/film.avi' ! decodebin ! videoconvert ! "
                                  "spidarmotion device=none track=auto feel=leftmost ! fakesink", env=setting)
        self.assertIn(f"{self.path('tracks/b c/film.avi.haptic.flac')} is not felt, because feel= says what is.", said)
        # One beside its film goes before it.
        self.make_track("lib/film.avi.haptic.wav")
        self.assertIn("is beside the film", self.spidartrack("info", "lib/film.avi", env=setting))
        self.assertIn("goes before these", self.spidartrack("record", "lib/film.avi", "--folder", "tracks", env=setting))

    def test_what_a_folder_has_besides_films_is_left_out_and_said_once(self):
        for name in ("in/a.avi", "in/b.DIVX", "in/c.f4v", "in/d.3g2", "in/e.m2v", "in/.Trash-1000/files/deleted.avi",
                     "in/.AppleDouble/film.avi", "in/._film.avi"):
            self.make_film(name, 5)
        for name in ("in/a.srt", "in/b.srt", "in/cover.jpg", "in/README", "in/.hidden.srt", "in/x.avi.haptic.wav"):
            self.path(name).write_text("")
        self.path("elsewhere").mkdir()
        self.path("in/link").symlink_to("../elsewhere")
        self.path("in/gone.avi").symlink_to("nowhere.avi")
        self.path("in/linked.avi").symlink_to("a.avi")
        os.mkfifo(self.path("in/pipe.avi"))
        said = self.spidartrack("record", "in", "--folder", "elsewhere")
        left, = re.findall("left out: (.*)\n", said)
        self.assertEqual(sorted(left.split("; ")), sorted((
            "1 linked folder", "4 files that are no film by the name (2 .srt, 1 without an ending, 1 .jpg)",
            "1 dangling link", "1 hidden film", "2 hidden folders", "1 special file")))
        self.assertIn("6 recorded, 0 there, 0 failed", said)

    def test_a_folder_that_may_not_be_read_costs_no_other(self):
        """As lost+found at the root of a disk."""
        self.make_film("in/sub/a.avi", 5)
        self.path("in/lost+found").mkdir(mode=0)
        command = [PROGRAM, "record", "in"]
        if os.getuid() == 0:
            # Root may read it, too, unless it gives that right away. Another user could not, but that one need not be able
            # to enter the folder that the program was built in.
            self.assertTrue(shutil.which("setpriv"), "setpriv is in util-linux, which every Debian has")
            given_away = "-dac_override,-dac_read_search"
            command = ["setpriv", f"--inh-caps={given_away}", f"--bounding-set={given_away}", *command]
        env = dict(os.environ, HOME=str(self.folder), GST_REGISTRY=str(self.path("registry")))
        said = self.run_in_folder(command, env=env)
        self.assertIn("left out: in/lost+found, which cannot be read (Permission denied)\n", said)
        self.assertTrue(self.path("in/sub/a.avi.haptic.flac").exists())

    @track_case.needs("ffmpeg")
    def test_how_much_is_felt_and_why_the_rest_is_not_is_said(self):
        self.make_film("ball.avi", 50)
        said = self.spidartrack("record", "ball.avi")
        self.assertRegex(said, r"ball.avi.haptic.flac; [1-9]\d* % of its frames are felt; \d+ %: ")
        self.assertRegex(self.spidartrack("check", "ball.avi.haptic.flac"), r"ok\n.* \d+ % of it is felt; in the rest")
        # A camera that pans across a standing texture.
        self.run_in_folder("ffmpeg -nostdin -v error -f lavfi -i \"color=gray:s=640x240:r=25,noise=alls=60:all_seed=1,"
                           "gblur=2,trim=end_frame=1,loop=-1:1,setpts=N/25/TB,crop=320:240:2*n:0\" -t 2 pan.avi")
        said = self.spidartrack("record", "pan.avi")
        self.assertRegex(said, r"pan.avi.haptic.flac; \d % of its frames are felt; 9\d %: .*camera")
        self.assertEqual(self.spidartrack("check", "pan.avi", status=1), "pan.avi.haptic.flac: 0 % of it is felt: "
                         "force and torque are below 0.04 N and 0.0009 N m\n")

    def test_a_manifest_that_cannot_be_written_is_an_error(self):
        self.make_film("x.avi")
        self.assert_said("the manifest none/done.jsonl cannot be written: No such file or directory",
                         "record", "x.avi", "--manifest", "none/done.jsonl")
        self.assertFalse(self.path("x.avi.haptic.flac").exists())
        self.assert_said("the manifest /dev/full cannot be written: No space left on device",
                         "record", "x.avi", "--manifest", "/dev/full")

    def test_a_file_behind_a_link_gets_no_manifest(self):
        self.make_film("x.avi")
        self.path("kept").write_text("as it was")
        self.path("link").symlink_to("kept")
        self.assert_said("the manifest link cannot be written: it is a link, and what it leads to is not overwritten",
                         "record", "x.avi", "--manifest", "link")
        self.assertEqual(self.path("kept").read_text(), "as it was")

    def claim(self, name):
        """Is the other process that records a film."""
        part = open(self.path(track_case.part_name(name + ".haptic.flac")), "w", encoding="utf-8")
        fcntl.flock(part, fcntl.LOCK_EX)
        return part

    def start(self, *films):
        with open(self.path("log"), "wb") as log:
            return subprocess.Popen([PROGRAM, "record", "-j1", *films], cwd=self.folder, stdout=log)

    def await_log(self, process, text):
        while process.poll() is None and text not in self.path("log").read_text():
            time.sleep(.01)

    def kill_reader(self, batch, film, number):
        """Ends the process that reads a film as a fault in a decoder does."""
        while batch.poll() is None:
            for tasks in pathlib.Path(f"/proc/{batch.pid}/task").glob("*/children"):
                for child in tasks.read_text().split():
                    command = pathlib.Path(f"/proc/{child}/cmdline").read_bytes().split(b"\0")
                    if film.encode() in command:
                        os.kill(int(child), number)
                        return
            time.sleep(.01)

    def test_a_film_that_crashes_its_decoder_costs_one_film(self):
        self.make_film("bad.avi", 2000)
        self.make_film("good.avi")
        for number, said in ((signal.SIGSEGV, "the process that read it crashed (Segmentation fault): it is damaged, or"),
                             (signal.SIGKILL, "the process that read it was killed: is there enough memory for it?")):
            batch = self.start("bad.avi", "good.avi", "--force", "--manifest", "done.jsonl")
            self.kill_reader(batch, "bad.avi", number)
            self.assertEqual(batch.wait(), 1)
            self.assertIn("1 recorded, 0 there, 1 failed:\n  bad.avi: " + said, self.path("log").read_text())
            lines = {line["film"]: line for line in self.json_lines("done.jsonl")[-2:]}
            self.assertIn(said, lines["bad.avi"]["error"])
            self.assertEqual(lines["good.avi"]["result"], "recorded")
            self.assertFalse([name for name in self.files() if "bad.avi." in name or ".part-" in name])

    def test_the_processes_of_films_end_with_a_command_that_is_killed(self):
        """What a signal removes: test_track_files.py."""
        self.make_film("x.avi", 2000)
        batch = self.start("x.avi")
        while not list(self.folder.glob(".part-*")):
            time.sleep(.01)
        batch.kill()
        batch.wait()
        # Whoever records a film has locked its part file.
        for part in self.folder.glob(".part-*"):
            with open(part, "rb") as left:
                fcntl.flock(left, fcntl.LOCK_EX)
            part.unlink()

    def test_a_film_that_another_process_records_is_waited_for(self):
        self.make_film("x.avi")
        self.make_film("y.avi")
        other = self.claim("x.avi")
        batch = self.start("x.avi", "y.avi")
        self.await_log(batch, "y.avi: y.avi.haptic.flac")
        self.assertIn("x.avi: another process is recording it", self.path("log").read_text())
        self.assertFalse(self.path("x.avi.haptic.flac").exists())
        other.close()  # as if it had been killed
        self.assertEqual(batch.wait(), 0)
        self.assertIn("2 recorded, 0 there, 0 failed", self.path("log").read_text())
        self.assertEqual(len(self.samples("x.avi.haptic.flac")), 1000)

        self.make_film("z.avi")
        other = self.claim("z.avi")
        batch = self.start("z.avi")
        self.await_log(batch, "another process")
        self.path("x.avi.haptic.flac").rename(self.path("z.avi.haptic.flac"))
        self.path(other.name).unlink()
        other.close()
        self.assertEqual(batch.wait(), 0)
        self.assertIn("z.avi.haptic.flac is there", self.path("log").read_text())

    def test_there_are_as_many_jobs_as_descriptors_allow(self):
        """A process of one film has enough of them. All films at once would need 50: the soft limit
        is raised, and under the hard one some wait."""
        self.path("in").mkdir()
        self.make_film("in/0.avi", 2)
        for n in range(1, 20):
            os.link(self.path("in/0.avi"), self.path(f"in/{n}.avi"))
        for limit in ("ulimit -S -n 40", "ulimit -n 40"):
            with self.subTest(limit):
                said = self.run_in_folder(f"{limit}; {PROGRAM} record -j20 --force in")
                self.assertIn("20 recorded", said)
                self.assertNotIn("CRITICAL", said)

    def test_properties_that_do_not_belong_to_a_track_are_refused(self):
        self.make_film("x.avi")
        self.make_film("y.avi")
        for words, said in (("attach-meta=false", "attach-meta=false: changes nothing in a track; these properties do"),
                            ("device=sim", "device=sim: changes nothing"),
                            ("name=extract", "name=extract: changes nothing"),
                            ("pointer=grip", "pointer=grip: a track has neither a hand nor a mouse"),
                            ("touch=luma", "touch=luma: what is touched depends on the hand"),
                            ("track=auto", "track=auto: a film is analysed for its track"),
                            ("max-force=0", "max-force=0: the whole track would be at rest"),
                            ("max-force=2N", 'max-force: "2N" is not a number from 0 to'),
                            ("motion=sideways", '"sideways" is not one of mean, object'),
                            ("motion=camera ! fakesink", '"camera ! fakesink" is not one of'),
                            ("frobnicate=1", 'spidarmotion has no property "frobnicate"')):
            self.assert_said(said, "record", "x.avi", "--", words, status=2)
        self.assert_said("trace=t.csv: all films would be written to one file", "record", "x.avi", "y.avi", "--",
                         "trace=t.csv", status=2)
        self.assertFalse(self.path("x.avi.haptic.flac").exists())
        self.spidartrack("record", "x.avi", "--", "trace=t.csv")
        self.assertTrue(self.path("t.csv").exists())

    def test_a_track_knows_its_film_and_its_properties(self):
        self.make_film("x.avi", 50)
        for name in ("wav", "mka", "flac"):
            self.spidartrack("record", "x.avi", "--format", name, "--", "max-force=2", "motion=camera")
            self.assert_said("was recorded with max-force=2 motion=camera, and not with the defaults", "record", "x.avi",
                             "--format", name)
        # The last one of a name counts, and 0.0025 is the default.
        self.assertIn("is there", self.spidartrack("record", "x.avi", "--", "motion=mean", "motion=camera",
                                                   "max_force=2.0", "alpha=0.0025"))
        self.assert_said("and not with alpha=0.02", "record", "x.avi", "--", "alpha=0.02")
        # Mean velocities have another default.
        self.spidartrack("record", "--force", "x.avi", "--", "motion=mean", "alpha=0.0025")
        self.assert_said("was recorded with alpha=0.0025 motion=mean, and not with motion=mean", "record", "x.avi", "--",
                         "motion=mean")
        self.spidartrack("record", "--force", "x.avi")
        self.assertIn("is there", self.spidartrack("record", "x.avi"))
        self.make_film("x.avi", 50, "snow")
        self.assert_said("is the track of another film", "record", "x.avi")
        self.path("x.avi.haptic.flac").write_bytes(b"")
        self.assert_said("--force records it again", "record", "x.avi")

    def test_a_track_that_is_not_played_is_named(self):
        self.make_film("a.avi")
        self.assertNotIn("warning", self.spidartrack("record", "a.avi"))
        for _ in range(2):
            self.assertIn("play a.avi.haptic.flac in place of a.avi.haptic.wav; remove it",
                          self.spidartrack("record", "a.avi", "--format", "wav", "--", "motion=camera"))
        self.assertNotIn("warning", self.spidartrack("record", "a.avi", "--force"))

    def test_films_of_any_name_are_recorded(self):
        self.make_film("film")
        for name in (b"with spaces.avi", b"it's \"quoted\".avi", b"100 %s.avi", b"a\\b.avi", b"two\nlines.avi",
                     b"-dash.avi", b"\xff\xfe.avi", "ünï.avi".encode(), b"! fakesink.avi", b"$(touch ran).avi", b".avi",
                     b"no extension"):
            os.link(self.path("film"), os.fsencode(self.folder) + b"/" + name)
            self.spidartrack("record", b"./" + name)
            self.spidartrack("convert", b"./" + name + b".haptic.flac", b"\xff \"quoted\".wav")
            read = self.samples(b"\xff \"quoted\".wav".decode(errors="surrogateescape"))
            self.assertEqual(len(read), 1000, name)
        self.assertFalse(self.path("ran").exists())

    def test_a_batch_ends_with_a_summary(self):
        self.make_film("x.avi", 50)
        self.make_film("y.avi", 50)
        self.path("bad\nname.avi").write_text("no film")
        self.assertNotIn("recorded", self.spidartrack("record", "y.avi"), "one film needs none")
        said = self.spidartrack("record", "-j1", "x.avi", "y.avi", "none.avi", "bad\nname.avi", status=1)
        self.assertIn("1 recorded, 1 there, 2 failed:\n  none.avi: there is no such file\n  bad?name.avi: ", said)
        self.assertNotIn("done;", said, "progress is for terminals, and for what takes long")
        # A line for each film, the summary, and the two that failed once more.
        self.assertEqual(said.count("\n"), 4 + 1 + 2, said)
        terminal = self.run_in_folder(f"script -qec '{PROGRAM} record --force x.avi' /dev/null")
        self.assertIn("0 of 1 done; x.avi 50 %", terminal)


if __name__ == "__main__":
    unittest.main()
