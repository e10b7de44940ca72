# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What bash completes after the programs, from their --help."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = sys.argv.pop(1)
PROGRAMS = {name: os.environ[name] for name in ("SPIDARCTL", "SPIDARTRACK", "SPIDAR_FEEL")}


def completed(*words):
    """The words that may stand in the place of the last one."""
    script = f'. "{SCRIPT}"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _gst_spidar; printf "%s\\n" "${{COMPREPLY[@]}}"'
    run = subprocess.run(["bash", "-u", "-c", script, "bash", *words], stdout=subprocess.PIPE, check=True, text=True)
    return run.stdout.split()


class Completion(unittest.TestCase):
    def test_commands(self):
        for program in ("SPIDARCTL", "SPIDARTRACK"):
            text = subprocess.run([PROGRAMS[program], "--help"], stdout=subprocess.PIPE, check=True, text=True).stdout
            listed = text.split("Subcommands:\n")[1].split("\n\n")[0]
            commands = [line.split()[0] for line in listed.splitlines() if line[2:3].strip()]
            self.assertGreater(len(commands), 6)
            self.assertEqual(completed(PROGRAMS[program], ""), commands)
        self.assertEqual(completed(PROGRAMS["SPIDARTRACK"], "co"), ["convert"])

    def test_options_of_the_command(self):
        self.assertEqual(completed(PROGRAMS["SPIDARTRACK"], "convert", "--to"), ["--tolerance"])
        self.assertEqual(completed(PROGRAMS["SPIDARTRACK"], "info", "a.flac", "--"), ["--folder", "--help", "--json"])
        self.assertEqual(completed(PROGRAMS["SPIDAR_FEEL"], "--f"), ["--follow"])

    def test_values_of_an_option(self):
        self.assertEqual(completed(PROGRAMS["SPIDARTRACK"], "convert", "--axis", "f"), ["fx", "fy", "fz"])

    def test_properties(self):
        feel = PROGRAMS["SPIDAR_FEEL"]
        self.assertEqual(completed(feel, "max-f"), ["max-force="])
        self.assertEqual(completed(feel, "max-force", "=", "2", "contr"), ["controller="])
        self.assertEqual(completed(feel, "controller", "=", "a"), ["adaptive"])
        self.assertEqual(completed(feel, "debug-window", "="), ["true", "false"])
        self.assertIn("preset=gentle", completed(feel, "preset=g"))  # as zsh divides words
        with tempfile.TemporaryDirectory() as folder:
            before = os.getcwd()
            os.chdir(folder)
            self.addCleanup(os.chdir, before)
            pathlib.Path("max-film.mp4").touch()
            self.assertEqual(completed(feel, "max-f"), [])  # bash completes the file

    def test_devices(self):
        self.assertIn("sim", completed(PROGRAMS["SPIDARCTL"], "monitor", "s"))
        self.assertEqual(completed(PROGRAMS["SPIDARCTL"], "info", "sim", ":", "sh"), ["sh4"])  # as bash divides it
        self.assertEqual(completed(PROGRAMS["SPIDARCTL"], "info", "sim", ":"),
                         [name[4:] for name in completed(PROGRAMS["SPIDARCTL"], "info", "sim") if name != "sim"])
        # The second word of this one is a file or a profile.
        self.assertEqual(completed(PROGRAMS["SPIDARTRACK"], "info", "s"), [])


if __name__ == "__main__":
    unittest.main()
