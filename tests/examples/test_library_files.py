#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""examples/library with films of odd names: its report, and which jobs Snakemake finds, if it is installed.

    test_library_files.py FOLDER-OF-SNAKEFILE
"""

import json
import os
import runpy
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

FOLDER = Path(sys.argv.pop(1) if len(sys.argv) > 1 else "examples/library").absolute()


class LibraryFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_a_name_may_have_what_ends_a_line_elsewhere(self):
        names = ["plain.mp4", "One\u2028two.mp4", "next\x85line.mp4", "é.mp4"]
        inputs = []
        for number, name in enumerate(names):
            inputs.append(self.folder / f"{number}.json")
            line = {"film": name, "result": "recorded", "track": f"{name}.flac", "duration_s": 1, "felt": .5, "largest_force_N": 1}
            failed = {"film": name, "result": "failed", "error": "first"}
            inputs[-1].write_text("".join(json.dumps(each, ensure_ascii=False) + "\n" for each in (failed, line)), encoding="utf-8")
        page = self.folder / "report.html"
        # In a locale without UTF-8, too.
        subprocess.run([sys.executable, "-X", "utf8=0", __file__, FOLDER, "report", page, *inputs], check=True,
                       env=dict(os.environ, LC_ALL="C", PYTHONCOERCECLOCALE="0"))
        text = page.read_text(encoding="utf-8")
        self.assertIn("4 films, 0.0 hours, 0 failed", text)
        for name in names:
            self.assertIn(name, text)

    def test_braces_and_hidden_folders(self):
        if not shutil.which("snakemake"):
            self.skipTest("snakemake is not installed")
        films = self.folder / "films {all}"
        for name in "plain.mp4", "Title {a1B2c3}.mp4", "100%7B.mp4", "{label}/film.mkv", ".Trash-1000/gone.mp4":
            (films / name).parent.mkdir(parents=True, exist_ok=True)
            (films / name).touch()
        run = lambda tracks: subprocess.run(
            ["snakemake", "--snakefile", FOLDER / "Snakefile", "--cores", "1", "--dry-run", "--config", f"films={films}",
             f"tracks={self.folder / tracks}"], cwd=self.folder, capture_output=True, text=True,
            env=dict(os.environ, XDG_CACHE_HOME=str(self.folder)))
        done = run("tracks")
        self.assertEqual(done.returncode, 0, done)
        self.assertRegex(done.stdout, r"track +4\b", "jobs of four films, without the hidden one")
        self.assertIn("Title %7Ba1B2c3%7D.mp4.json", done.stdout)
        self.assertIn("100%257B.mp4.json", done.stdout)
        refused = run("tracks {x}")
        self.assertIn("braces in the name of a folder", refused.stdout + refused.stderr)


if __name__ == "__main__":
    if sys.argv[1:2] == ["report"]:
        runpy.run_path(str(FOLDER / "report.py"),
                       {"snakemake": SimpleNamespace(output=[sys.argv[2]], input=sys.argv[3:])})
    else:
        unittest.main()
