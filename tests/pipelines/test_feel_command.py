# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What is given to spidar-feel, what it says, and where it lets the player search for the plugin. The environment names
the program (SPIDAR_FEEL), and another version of the plugin (OLD_PLUGIN)."""

import os
import shutil
import unittest

import track_case

FEEL = os.environ["SPIDAR_FEEL"]


class Command(track_case.TrackCase):
    def feel(self, line, status=0, env=None):
        return self.run_in_folder(f"DISPLAY=:0 GST_PLUGIN_FEATURE_RANK= {env or ''} {FEEL} {line}", status)

    def test_wrong_usage_is_named(self):
        for arguments, status, said in (
                ("", 2, "no FILM or PROGRAM given"), ("max-force=2", 2, "spidar-feel max-force=2 -- FILM"),
                ("max-force=2 true", 2, "spidar-feel max-force=2 -- FILM"), ("max-force=2 --", 2, "no FILM or PROGRAM given"),
                ("--dance", 2, "--dance is not an option"),
                ("max-farce=2 -- true", 2, 'spidarmotion has no property "max-farce" that can be set; did you mean max-force?'),
                ("filter-cutof=2 -- true", 2, 'no property "filter-cutof" that can be set; gst-inspect'),
                ("filter-min-cutof=2 -- true", 2, "did you mean filter-min-cutoff?"),
                ("preset=gentel -- true", 2, 'there is no preset "gentel"; known are film, gentle, paper'),
                ("preset=gentle max-force=.5 -- true", 0, ""),
                ("stats=2 -- true", 2, 'spidarmotion has no property "stats" that can be set'),
                ("max-force=much -- true", 2,
                 'max-force: "much" is not a number from 0 to 20. Largest force on the grip, in newtons'),
                ("max-force=1e9 -- true", 2, 'max-force: "1e9" is not a number from 0 to 20'),
                ("max-force=nan -- true", 2, 'max-force: "nan" is not a number from 0 to 20'),
                ("alpha=0 -- true", 2, 'alpha: "0" is not a number from 1e-06 to 10'),
                ("ts-offset=late -- true", 2, '"late" is not a whole number from -10000000000 to 10000000000'),
                ("ts-offset=late -- true", 2, "in nanoseconds"),
                ("controller=wild -- true", 2, 'controller: "wild" is not one of linear, nonlinear, adaptive\n'),
                ("mute=perhaps -- true", 2, 'mute: "perhaps" is not true or false'),
                ("no-such-program", 127, "no-such-program: No such file or directory"), ("./", 126, "./: this folder has no film"),
                ("--follow max-force=2", 2, "--follow takes one NAME, and properties come before it: max-force=2"),
                ("--screen max-force=2", 2, "--screen is the last word, its window follows '=', and properties come before it"),
                ("--screens", 2, "--screens is not an option"),
                ("controller=linear max-force=2 -- true", 0, ""), ("--help", 0, "usage: spidar-feel"),
                ("--version", 0, "spidar-feel ")):
            self.assertIn(said, self.feel(arguments, status))
        if os.path.exists("/dev/full"):
            for option in ("--help", "--version"):
                self.assertIn("what is printed cannot be written", self.feel(option + " > /dev/full", 1))
        self.assertEqual(self.feel("device=none -- printenv SPIDAR_FEEL GST_TRACERS"), "device=none\n\nspidarfeel\n")
        self.assertIn("stats;spidarfeel\n", self.feel("printenv GST_TRACERS", env="GST_TRACERS=stats"))

    def test_a_device_that_cannot_exist_or_be_driven_is_named_before_the_player_starts(self):
        for properties, said in (
                ("device=zzz", 'unknown device "zzz"; known are: sim, '), ("device=", 'unknown device ""; known'),
                ("device=fof", 'unknown device "fof"; did you mean ff?; known are: sim, '),
                ("device=sim:zzz", 'unknown simulated board "zzz"; known are: sim:sh4, '),
                ("device=uart:,/dev/ttyUSB0 profile=spidar-g6x4", "a path is empty"),
                ("profile=nope", 'unknown profile "nope"; known are spidar-g, '),
                ("profile=nope.toml", "nope.toml: it cannot be read: No such file or directory"),
                ("device=none profile=nope", 'unknown profile "nope"'),
                ("device=usb", "usb: no CyVerse USB 2.0 SH4 (0cec:0205) or "),
                ("device=usb profile=spidar-gcc", 'usb: profile "spidar-gcc" is for boards of the kind ahs')):
            text = self.feel(properties + " -- echo plays", 2)
            self.assertTrue(text.startswith("spidar-feel: "), text)
            self.assertIn(said, text)
            self.assertNotIn("plays", text)
        # Whether these are plugged in is seen when the video plays.
        for properties in ("device=usb:7 profile=spidar-g6c", "device=mouse:7",
                           "device=uart:/dev/no-such-line profile=spidar-g6x4", "device=ff:/dev/no-such-joystick",
                           "device=none", "device=usb profile=spidar-g6x3-v2-l", "device=zzz device=sim",
                           "'device=\"sim\"'"):
            self.assertEqual(self.feel(properties + " -- echo plays 2>/dev/null"), "plays\n", properties)

    def test_without_a_device_it_takes_what_there_is(self):
        self.assertEqual(self.feel("max-force=2 -- printenv SPIDAR_FEEL"), "device=auto\nmax-force=2\n\n")
        self.assertEqual(self.feel("max-force=2 device=sim -- printenv SPIDAR_FEEL"), "max-force=2\ndevice=sim\n\n")

    def write_program(self, name, text):
        path = self.path(name)
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)

    def test_a_film_is_played_and_a_program_is_run(self):
        """gst-play-1.0 prints its arguments here."""
        self.write_program("bin/gst-play-1.0", "#!/bin/sh\necho plays $*; printenv GST_TRACERS\n")
        self.write_program("bin/film.mp4", "#!/bin/sh\necho runs\n")
        self.write_program("without_line.sh", "echo runs\n")
        (self.folder / "sub").mkdir()
        for name in ("film.avi", "executable.avi", "angle=2.avi", "film.mp4", "sub/film.mp4", "empty.avi"):
            self.path(name).write_bytes(b"" if name == "empty.avi" else b"RIFF\0\0\0\0AVI LIST")
        # As on file systems that know no permissions.
        self.path("executable.avi").chmod(0o755)
        uri = "https://somewhere/film?number=1"
        for words, said in (
                ("film.avi", "film.avi"), ("executable.avi", "executable.avi"), ("./executable.avi", "./executable.avi"),
                ("angle=2.avi", "angle=2.avi"), ("max-force=2 -- film.avi --quiet", "film.avi --quiet"),
                ("film.avi executable.avi", "film.avi executable.avi"), (f"'{uri}'", uri), ("empty.avi", "empty.avi"),
                ("sub/film.mp4", "sub/film.mp4")):
            self.assertEqual(self.feel(words, env="PATH=$PWD/bin:$PATH"), f"plays {said}\nspidarfeel\n")
        for program in ("film.mp4", "bin/film.mp4", "./without_line.sh"):
            self.assertEqual(self.feel(program, env="PATH=$PWD/bin:$PATH"), "runs\n")
        self.assertIn("film.avi: No such file or directory", self.feel("sub/film.avi", 127))
        for words in ("film.avi max-force=2", "film.avi -- max-force=2"):
            self.assertIn("properties come before the film: spidar-feel max-force=2 -- film.avi", self.feel(words, 2))

    def test_without_a_graphics_card_the_film_is_shown_without_opengl(self):
        """What gst-play-1.0 gets of the ranks is printed here."""
        self.write_program("bin/gst-play-1.0", "#!/bin/sh\necho ${GST_PLUGIN_FEATURE_RANK-unset}\n")
        self.path("film.avi").write_bytes(b"RIFF\0")
        has_card = os.path.exists("/dev/dri/renderD128") or os.path.exists("/dev/nvidiactl")
        for words, ranks in (("film.avi", "unset" if has_card else "glimagesink:NONE"), ("film.avi --videosink=x", "unset")):
            said = self.run_in_folder(f"unset GST_PLUGIN_FEATURE_RANK; PATH=$PWD/bin:$PATH DISPLAY=:0 {FEEL} {words}")
            self.assertEqual(said.splitlines()[-1], ranks)
            self.assertEqual("there is no graphics card" in said, ranks != "unset")
        self.assertEqual(self.feel("film.avi", env="PATH=$PWD/bin:$PATH GST_PLUGIN_FEATURE_RANK=x:1"), "x:1\n")

    def played(self, words):
        """What gst-play-1.0 is given."""
        self.write_program("bin/gst-play-1.0", "#!/bin/sh\nprintf '%s\\n' \"$@\"\n")
        return self.feel(words, env="PATH=$PWD/bin:$PATH").splitlines()

    def make_films(self, *names):
        for name in names:
            self.path(name).parent.mkdir(parents=True, exist_ok=True)
            self.path(name).write_bytes(b"RIFF\0")

    def test_a_folder_is_played_in_the_order_of_its_names(self):
        self.make_films("in/10.avi", "in/9.avi", "in/9.avi.haptic.wav", "in/below/ü.mkv", "in/notes.txt", "in/.hidden.avi")
        self.assertEqual(self.played("in"), ["in/9.avi", "in/10.avi", "in/below/ü.mkv"])
        self.assertEqual(self.played("in/9.avi in/below/"), ["in/9.avi", "in/below/ü.mkv"])

    def test_a_playlist_stands_for_what_it_names(self):
        self.make_films("in/10.avi", "in/9.avi", "in/below/ü.mkv", "100% #1.avi", "100%25.avi", "100%.avi", "a b.avi",
                        "Alien:Romulus.avi", " c.avi", "fran\xe7ais.avi")
        os.rename(self.path("a b.avi"), self.path("a\u2019b.avi"))
        self.path("n.m3u").write_text("n.m3u\nin/o.m3u\nin/below\n")
        uri, here = "http://somewhere/film%201?a&b", self.path("in/10.avi").as_uri()
        for name, text, wanted in (
                # By hand: blanks, empty lines, comments, every end of a line, a byte order mark.
                ("a.m3u", f"#EXTM3U\r\n#EXTINF:1,A song\r\n in/10.avi\t\r\n\r\n{uri}\r\n", ["./in/10.avi", uri]),
                ("in/b.M3U8", "\ufeff9.avi\r/elsewhere.avi\r", ["in/9.avi", "/elsewhere.avi"]),
                ("c.m3u", " c.avi\nAlien:Romulus.avi\nmissing.avi", ["./ c.avi", "./Alien:Romulus.avi", "./missing.avi"]),
                # By programs: encoded, with backslashes, with URIs of files.
                ("d.m3u", "100%25%20%231.avi\n100%25.avi\n100%.avi\n", ["./100% #1.avi", "./100%25.avi", "./100%.avi"]),
                ("e.m3u", f"in\\below\\ü.mkv\n.\\in\\10.avi\n{here}\nfile:///no/film.avi\n",
                 ["./in/below/ü.mkv", "././in/10.avi", str(self.path("in/10.avi")), "file:///no/film.avi"]),
                ("f.m3u", "in/below/ü.mkv\n".encode("utf-16"), ["./in/below/ü.mkv"]),
                ("g.m3u", "fran\xe7ais.avi\na\u2019b.avi\n".encode("cp1252"), ["./fran\xe7ais.avi", "./a\u2019b.avi"]),
                ("h.pls", f"[playlist]\nNumberOfEntries=2\nFile10={uri}\nTitle10=x\nFile9 = in/9.avi \n", ["./in/9.avi", uri]),
                ("i.m3u", "[Playlist]\nfile1=in/9.avi\nFile1=in/10.avi\nFile2=\nLength1=-1\n", ["./in/10.avi"]),
                ("j.xspf", "<?xml version='1.0' encoding='UTF-8'?>\n<playlist xmlns='http://xspf.org/ns/0/'><title>a</title>"
                 "<location>in</location><trackList><track><title>9</title>\n<location>in/below/%C3%BC.mkv</location></track>"
                 f"<track><location>\n {uri.replace('&', '&amp;')} </location></track><track><location/></track>"
                 "</trackList></playlist>", ["./in/below/ü.mkv", uri]),
                ("k.xspf", "<?xml version='1.0' encoding='ISO-8859-1'?><playlist><trackList><track><location>fran\xe7ais.avi"
                 "</location></track></trackList></playlist>".encode("latin-1"), ["./fran\xe7ais.avi"]),
                ("l.asx", "<ASX version=3.0><Base href='x'><Title>a & b</Title><Entry><Ref HREF = 'in\\9.avi'/></ENTRY>"
                 "<entry><ref href='in/10.avi'></entry><entryref href='c.m3u'/></asx>",
                 ["./in/9.avi", "./in/10.avi", "./ c.avi", "./Alien:Romulus.avi", "./missing.avi"]),
                ("m.wpl", "<?wpl version='1.0'?><smil><body><seq><media src='in\\9.avi'/></seq></body></smil>", ["./in/9.avi"]),
                # Of playlists and folders, in a circle; one film that is played in parts.
                ("in/o.m3u", "10.avi\n../n.m3u\n", ["in/10.avi", "in/../in/below/ü.mkv"]),
                ("live.m3u8", "#EXTM3U\n#EXT-X-VERSION:3\n#EXTINF:4,\n1.ts\n", ["live.m3u8"]),
                ("empty.m3u", "#EXTM3U\n", []), ("empty.xspf", "", []), ("self.pls", "[playlist]\nFile1=self.pls\n", [])):
            self.path(name).write_bytes(text if isinstance(text, bytes) else text.encode())
            self.path(name).chmod(0o755)  # as on file systems that know no permissions
            if wanted:
                self.assertEqual(self.played(name), wanted, name)
            else:
                self.assertIn(f"{name}: this playlist names no film", self.feel(name, 126))
        self.assertEqual(self.played("n.m3u"), ["./in/10.avi", "./in/below/ü.mkv"])

    def test_a_path_that_exists_is_a_file_whatever_it_looks_like(self):
        self.make_films("Alien:Romulus.avi", "http:x/film.avi", "100%25.avi", "--mute.avi")
        for words, wanted in (("Alien:Romulus.avi", ["./Alien:Romulus.avi"]), ("http:x", ["./http:x/film.avi"]),
                              ("http:x/film.avi", ["./http:x/film.avi"]), ("100%25.avi", ["100%25.avi"]),
                              ("--mute.avi", ["./--mute.avi"]), ("max-force=2 -- --mute.avi", ["./--mute.avi"]),
                              ("http://x/film.avi", ["http://x/film.avi"])):
            self.assertEqual(self.played(words), wanted)

    def test_the_package_of_a_player_that_is_missing_is_named(self):
        self.path("film.avi").write_bytes(b"RIFF")
        self.assertIn("gst-play-1.0, which plays films, is not installed: on Debian and Ubuntu it is in the package "
                      "gstreamer1.0-plugins-base-apps", self.feel("film.avi", 127, env="PATH=/nowhere"))

    def test_a_player_that_does_not_use_gstreamer_is_named(self):
        """mpv is a name for the command true here."""
        self.path("mpv").symlink_to(shutil.which("true"))
        self.assertIn("mpv does not use GStreamer", self.feel(f"device=sim -- {self.path('mpv')}"))
        self.assertEqual(self.feel("device=sim -- true"), "")

    def paths(self, environment):
        """GST_PLUGIN_PATH and GST_PLUGIN_PATH_1_0 as the player gets them. Between them and spidar-feel is another one,
        which would put the folder before them once more if it did not find the plugin as a player does."""
        return self.run_in_folder(
            f"unset GST_PLUGIN_PATH GST_PLUGIN_PATH_1_0; GST_REGISTRY=registry GST_PLUGIN_SYSTEM_PATH_1_0= {environment} "
            f"{FEEL} device=none -- {FEEL} device=none -- sh -c 'echo $GST_PLUGIN_PATH, ${{GST_PLUGIN_PATH_1_0-unset}}'")

    def test_the_plugin_is_first_in_the_path_that_gstreamer_uses(self):
        """Another version of it, that comes earlier, is not used."""
        plugin = os.path.dirname(FEEL)
        old = self.path("old")
        old.mkdir()
        shutil.copy(os.environ["OLD_PLUGIN"], old)
        for environment, paths in (("", f"{plugin}, unset"), ("GST_PLUGIN_PATH=/other", f"{plugin}:/other, unset"),
                                   ("GST_PLUGIN_PATH_1_0=/other", f", {plugin}:/other"),
                                   ("GST_PLUGIN_PATH_1_0=", f", {plugin}"),
                                   ("GST_PLUGIN_PATH=/some GST_PLUGIN_PATH_1_0=/other", f"/some, {plugin}:/other"),
                                   # GStreamer finds it without further help.
                                   (f"GST_PLUGIN_PATH={plugin}", f"{plugin}, unset"),
                                   (f"GST_PLUGIN_PATH={old}", f"{plugin}:{old}, unset"),
                                   (f"GST_PLUGIN_PATH_1_0={old}", f", {plugin}:{old}")):
            self.assertEqual(self.paths(environment), paths + "\n")


if __name__ == "__main__":
    unittest.main()
