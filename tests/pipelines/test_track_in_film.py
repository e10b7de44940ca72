# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The command line of docs/haptic-track.md that puts a track into a film: what the film keeps, what players take for
its sound, and that the track is found. test_track_in_film.py PAGE"""
import json
import pathlib
import sys
import unittest

import track_case

PAGE = pathlib.Path(sys.argv.pop(1)).read_text(encoding="utf-8")
SUBTITLES = """[Script Info]
ScriptType: v4.00+

[V4+ Styles]
Format: Name, Fontname, Fontsize, PrimaryColour, Bold
Style: Default,Foo,20,&H00FFFF00,1

[Events]
Format: Layer, Start, End, Style, Text
Dialogue: 0,0:00:00.00,0:00:01.00,Default,{\\i1}A square moves.
"""
CHAPTERS = ";FFMETADATA1\n[CHAPTER]\nTIMEBASE=1/1000\nSTART=0\nEND=1000\ntitle=one\n"


@track_case.needs("ffmpeg", "ffprobe")
class InFilm(track_case.TrackCase):
    def setUp(self):
        super().setUp()
        self.path("s.ass").write_text(SUBTITLES)
        self.path("chapters.txt").write_text(CHAPTERS)
        self.path("foo.ttf").write_bytes(bytes(range(256)))
        # The second sound is the default, and the subtitles are forced.
        self.run_in_folder(
            "ffmpeg -nostdin -v error -f lavfi -i testsrc2=s=160x120:r=25:d=2 -f lavfi -i sine=d=2 -f lavfi -i "
            "sine=880:d=2 -i s.ass -i chapters.txt -map 0 -map 1 -map 2 -map 3 -map_metadata 4 -c:v libx264 -bf 0 -c:a "
            "flac -c:s copy -disposition:a:0 0 -disposition:a:1 default -disposition:s:0 default+forced "
            "-metadata:s:a:0 language=deu -attach foo.ttf -metadata:s:t mimetype=font/ttf film.mkv")
        self.path("film.mkv").rename(self.path("film.mp4"))  # as the page calls it
        self.spidartrack("record", "film.mp4")
        self.path("film.mp4.haptic.flac").rename(self.path("film.haptic.flac"))

    def probed(self, film):
        return json.loads(self.run_in_folder(["ffprobe", "-v", "error", "-show_streams", "-show_chapters", "-of",
                                              "json", film]))

    def played(self, film, rest):
        self.run_in_folder(f"gst-launch-1.0 -q playbin uri=file://{self.path(film)} "
                           f"video-sink='fakesink sync=false' {rest}")

    def expect_kept(self):
        before, after = self.probed("film.mp4"), self.probed("both.mkv")
        haptic = [stream for stream in after["streams"] if stream.get("channels") == 6]
        self.assertEqual(len(haptic), 1)
        others = [stream for stream in after["streams"] if stream not in haptic]
        self.assertEqual([s.get("codec_name") for s in others], [s.get("codec_name") for s in before["streams"]])
        self.assertEqual([s["disposition"] for s in others], [s["disposition"] for s in before["streams"]])
        self.assertFalse(haptic[0]["disposition"]["default"])
        self.assertEqual(len(after["chapters"]), 1)
        for film in ("film.mp4", "both.mkv"):
            self.run_in_folder(f"ffmpeg -nostdin -v error -y -dump_attachment:t font -i {film} -map 0:s -c copy "
                               f"{film}.ass")
            self.assertEqual(self.path("font").read_bytes(), bytes(range(256)))
        style = [self.path(f"{film}.ass").read_text().split("[Events]")[0] for film in ("film.mp4", "both.mkv")]
        self.assertEqual(*style)
        self.assertIn("&H00FFFF00", style[0])
        return haptic[0]

    def expect_found(self):
        self.played("both.mkv", "audio-sink='audioconvert ! audio/x-raw,format=F32LE ! wavenc ! filesink "
                    "location=ear.wav'")
        heard, _ = track_case.read_wav(self.path("ear.wav"))
        self.assertEqual(len(heard[0]), 1, "the sound of the film, and not the track")
        self.played("both.mkv", "audio-sink=fakesink video-filter='spidarmotion device=none track=auto trace=t.csv'")
        rows = self.path("t.csv").read_text().splitlines()[1:]
        forces = [float(row.split(",")[6]) for row in rows]
        self.assertEqual(len(forces), 50)
        self.assertFalse([row for row in rows if row.split(",")[2] != "0"], "a frame was analysed")
        self.assertGreater(max(map(abs, forces)), .1, "the track of this film pulls")
        whole = self.samples("film.haptic.flac")
        self.path("film.haptic.flac").unlink()
        self.spidartrack("convert", "both.mkv", "film.haptic.flac")
        self.assertEqual(self.samples("film.haptic.flac")[:len(whole)], whole)

    @track_case.needs("mkvmerge")
    def test_mkvmerge(self):
        line, = [line.strip() for line in PAGE.splitlines() if line.startswith("    mkvmerge ")]
        self.run_in_folder(line)
        tags = self.expect_kept()["tags"]
        self.assertEqual((tags["language"], tags["title"]), ("zxx", "Haptic track"))
        tracks = json.loads(self.run_in_folder(["mkvmerge", "-J", "both.mkv"]))["tracks"]
        haptic, = [track for track in tracks if track["properties"].get("track_name") == "Haptic track"]
        self.assertFalse(haptic["properties"]["enabled_track"])
        self.expect_found()


if __name__ == "__main__":
    unittest.main()
