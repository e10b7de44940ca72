# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""No command of spidartrack replaces a file without a word, except one that it has written itself."""
import os
import struct
import subprocess
import unittest

import track_case
from track_case import PROGRAM

MARK = "user.gst-spidar.written"
PRECIOUS = b"the only copy of a film"
USER_OBJ, USER, GROUP_OBJ, MASK, OTHER = 1, 2, 4, 16, 32  # of posix_acl_xattr_entry (linux/posix_acl_xattr.h)
NO_ID = 0xffffffff
HAS_ENCODER = any(subprocess.run(["gst-inspect-1.0", "--exists", element], check=False).returncode == 0
                  for element in ("x264enc", "openh264enc"))


class ExistingFiles(track_case.TrackCase):
    def setUp(self):
        super().setUp()
        self.make_film()
        self.make_track("film.avi.haptic.wav")
        self.make_track("a.wav", 100)
        self.before = self.files()

    def keeps_marks(self):
        try:
            os.setxattr(self.path("film.avi"), MARK, b"x")
        except OSError:
            return False
        return True

    def commands(self):
        """The arguments, and the file that each writes."""
        yield ("export", "film.avi"), "page.html"
        for name in ("b.wav", "b.flac", "b.mka", "b.hjif", "b.funscript", "b.ahap"):
            yield ("convert", "a.wav"), name
        yield ("plot", "a.wav"), "a.png"
        if HAS_ENCODER:
            yield ("show", "film.avi"), "shown.mkv"

    def test_a_file_that_another_has_written_is_refused(self):
        for arguments, name in self.commands():
            with self.subTest(command=arguments[0], name=name):
                self.path(name).write_bytes(PRECIOUS)
                said = self.spidartrack(*arguments, name, status=1)
                self.assertIn(f"{name}: exists, and is not as spidartrack {arguments[0]} left it; name another file, or replace "
                              "it with --force", said)
                self.assertEqual(self.path(name).read_bytes(), PRECIOUS)
                self.spidartrack(*arguments, name, "--force")
                self.assertNotEqual(self.path(name).read_bytes(), PRECIOUS)

    def test_a_file_that_the_same_command_has_written_is_replaced_until_somebody_changes_it(self):
        if not self.keeps_marks():
            self.skipTest(f"the file system of {self.folder} has no extended attributes")
        for arguments, name in self.commands():
            with self.subTest(command=arguments[0], name=name):
                self.spidartrack(*arguments, name)
                first = self.path(name).stat()
                self.spidartrack(*arguments, name)
                self.assertNotEqual(self.path(name).stat().st_ino, first.st_ino)
                with open(self.path(name), "r+b") as file:  # the size stays
                    begin = file.read(1)
                    file.seek(0)
                    file.write(begin)
                    file.flush()
                    os.utime(file.fileno(), ns=(first.st_atime_ns, first.st_mtime_ns + 10 ** 9))
                self.assert_said("exists, and is not as", *arguments, name)

    def test_a_file_of_another_command_is_not_its_own(self):
        self.spidartrack("record", "film.avi", "--force", "--format", "flac")
        self.assert_said("exists, and is not as spidartrack convert left it", "convert", "a.wav", "film.avi.haptic.flac")
        self.spidartrack("convert", "a.wav", "copied.wav")
        content = self.path("copied.wav").read_bytes()
        self.path("copied.wav").unlink()
        self.path("copied.wav").write_bytes(content)  # by somebody else, and with no mark
        self.assert_said("exists, and is not as spidartrack convert left it", "convert", "a.wav", "copied.wav")

    def test_a_link_stays_one_and_leads_to_the_new_file(self):
        self.path("sub").mkdir()
        self.path("sub/kept.wav").write_bytes(PRECIOUS)
        self.path("b.wav").symlink_to("sub/kept.wav")
        self.assert_said("b.wav: exists", "convert", "a.wav", "b.wav")
        self.assertEqual(self.path("sub/kept.wav").read_bytes(), PRECIOUS)
        self.spidartrack("convert", "a.wav", "b.wav", "--force")
        self.assertEqual(os.readlink(self.path("b.wav")), "sub/kept.wav")
        self.assertEqual(len(self.samples("sub/kept.wav")), 100)
        self.path("c.wav").symlink_to("nowhere.wav")
        self.assert_said("c.wav: cannot be written: it is a link to nowhere.wav, which is not there; remove the link",
                         "convert", "a.wav", "c.wav")
        # Of a track, too, that is recorded again.
        self.spidartrack("record", "film.avi")
        self.path("film.avi.haptic.flac").rename(self.path("sub/track.flac"))
        self.path("film.avi.haptic.flac").symlink_to("sub/track.flac")
        self.spidartrack("record", "film.avi", "--force")
        self.assertTrue(self.path("film.avi.haptic.flac").is_symlink())
        self.assertEqual(self.path("sub/track.flac").read_bytes()[:4], b"fLaC")

    def test_other_names_of_the_file_keep_what_was_there_and_that_is_said(self):
        self.path("b.wav").write_bytes(PRECIOUS)
        os.link(self.path("b.wav"), self.path("other.wav"))
        said = self.spidartrack("convert", "a.wav", "b.wav", "--force")
        self.assertIn("b.wav: what was there stays under its other names (hard links)\n", said)
        self.assertEqual(self.path("other.wav").read_bytes(), PRECIOUS)
        self.assertEqual(len(self.samples("b.wav")), 100)

    def test_permissions_stay_as_they_were(self):
        self.path("b.wav").write_bytes(PRECIOUS)
        self.path("b.wav").chmod(0o640)
        if os.getuid() == 0:
            os.chown(self.path("b.wav"), 12345, 54321)
        before = self.path("b.wav").stat()
        acl = struct.pack("<I", 2) + b"".join(struct.pack("<HHI", *entry) for entry in (
            (USER_OBJ, 6, NO_ID), (USER, 4, 12345), (GROUP_OBJ, 4, NO_ID), (MASK, 4, NO_ID), (OTHER, 0, NO_ID)))
        try:
            os.setxattr(self.path("b.wav"), "system.posix_acl_access", acl)
        except OSError:
            acl = None  # this file system has none
        self.spidartrack("convert", "a.wav", "b.wav", "--force")
        after = self.path("b.wav").stat()
        self.assertEqual((after.st_mode, after.st_uid, after.st_gid), (before.st_mode, before.st_uid, before.st_gid))
        if acl:
            self.assertEqual(os.getxattr(self.path("b.wav"), "system.posix_acl_access"), acl)

    def test_a_protected_file_is_not_replaced(self):
        command = [PROGRAM, "convert", "a.wav", "b.wav", "--force"]
        if os.getuid() == 0:  # as a user, to whom modes apply
            command = ["setpriv", "--inh-caps=-dac_override", "--bounding-set=-dac_override", *command]
        self.path("b.wav").write_bytes(PRECIOUS)
        self.path("b.wav").chmod(0o444)
        self.assertIn("b.wav: is protected against writing", self.run_in_folder(command, status=1))
        self.assertEqual(self.path("b.wav").read_bytes(), PRECIOUS)

    def test_what_is_refused_is_refused_before_the_work(self):
        """With what cannot be read, too: only one of both is said."""
        self.path("b.wav").write_bytes(PRECIOUS)
        said = self.spidartrack("convert", "none.wav", "b.wav", status=1)
        self.assertIn("b.wav: exists", said)
        self.assertNotIn("none.wav", said)
        self.assertEqual(self.files(), self.before | {"b.wav"})


if __name__ == "__main__":
    unittest.main()
