#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Runs the tests of GUEST as the only program of a virtual machine with Debian's kernel.

run_guest.py GUEST --profiles FOLDER --programs FILE... --plugins FILE...: in the machine, programs are in the
folder of GUEST and plugins of GStreamer in /plugins. Neither permissions nor USB are needed; the processor is
emulated. The exit status is that of the tests, or 77 when QEMU or a kernel is missing.

The kernel is the newest in /boot that has a folder in /lib/modules, or in $SPIDAR_TEST_KERNEL: a folder
into which Debian's package was unpacked."""

import argparse
import lzma
import os
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import time
from pathlib import Path

QEMU = "qemu-system-x86_64"
MODULES = ("usb-common", "usbcore", "usbip-core", "vhci-hcd", "evdev", "uinput")
EXIT_PORT = "iobase=0xf4,iosize=0x04"  # guest.cpp: kExitPort; QEMU's status is 2 · result + 1
PASSED = 1
SKIPPED = 77
TIME_LIMIT_S = 280  # below that of the test in meson.build


def find_kernel(root):
    """(image, {module: file}) or None. "Cloud" kernels have no USB."""
    for image in sorted((root / "boot").glob("vmlinuz-*"), reverse=True):
        folder = root / "lib" / "modules" / image.name.removeprefix("vmlinuz-")
        found = {}
        for name in MODULES:
            for ending in (".ko", ".ko.xz"):
                for file in folder.glob(f"kernel/drivers/**/{name}{ending}"):
                    found[name] = file
        if len(found) == len(MODULES) and os.access(image, os.R_OK):
            return image, found
    return None


def missing(root):
    """What to install, or None."""
    if not shutil.which(QEMU):
        return "qemu-system-x86 is not installed"
    if not find_kernel(root):
        return (
            f"linux-image-amd64 is not in {root}: install it, or, to leave the system as it is, unpack the package "
            "that it depends on (apt-get download, dpkg-deb -x) and name the folder in SPIDAR_TEST_KERNEL"
        )
    return None


def libraries_of(program):
    """{name in the machine: file}"""
    said = subprocess.run(["ldd", program], check=True, capture_output=True, text=True).stdout
    found = {}
    for line in said.splitlines():
        if match := re.match(r"\s*(\S+) => (/\S+)", line):
            found["lib/" + match[1]] = match[2]
        elif match := re.match(r"\s*(/\S*ld-linux\S*)", line):
            found[match[1].lstrip("/")] = match[1]
        elif "not found" in line:
            sys.exit(f"error: {program}:{line}")
    return found


class Archive:
    """An initramfs: cpio in the "newc" format (Documentation/driver-api/early-userspace/buffer-format.rst)."""

    def __init__(self):
        self.bytes = bytearray()
        self.folders = set()
        self.entries = 0

    def _add(self, name, mode, data=b"", device=(0, 0)):
        self.entries += 1
        fields = (self.entries, mode, 0, 0, 1, 0, len(data), 0, 0, *device, len(name.encode()) + 1, 0)
        self.bytes += b"070701" + b"".join(b"%08x" % field for field in fields) + name.encode() + b"\0"
        self._align()
        self.bytes += data
        self._align()

    def _align(self):
        self.bytes += bytes(-len(self.bytes) % 4)

    def _add_folders_of(self, name):
        for folder in reversed(Path(name).parents[:-1]):
            if str(folder) not in self.folders:
                self.folders.add(str(folder))
                self._add(str(folder), stat.S_IFDIR | 0o755)

    def add(self, name, data):
        self._add_folders_of(name)
        self._add(name, stat.S_IFREG | 0o755, data)

    def add_console(self):
        self._add_folders_of("dev/console")
        self._add("dev/console", stat.S_IFCHR | 0o600, device=(5, 1))

    def finish(self):
        self._add("TRAILER!!!", 0)
        return bytes(self.bytes)


def make_initramfs(arguments, modules):
    files = {"init": arguments.guest}
    files |= {Path(program).name: program for program in arguments.programs}
    files |= {"plugins/" + Path(plugin).name: plugin for plugin in arguments.plugins}
    for file in list(files.values()):
        files |= libraries_of(file)
    files |= {"profiles/" + file.name: file for file in Path(arguments.profiles).glob("*.toml")}
    archive = Archive()
    archive.add_console()
    for name, file in files.items():
        archive.add(name, Path(file).read_bytes())
    for name, file in modules.items():
        data = file.read_bytes()
        archive.add(f"modules/{name}.ko", lzma.decompress(data) if file.suffix == ".xz" else data)
    return archive.finish()


def run(image, initramfs):
    """QEMU's exit status. One processor: emulated ones wait for each other. Time in the machine is counted in
    instructions (two nanoseconds each): a host that is busy makes nothing late in it."""
    command = (
        f"{QEMU} -accel tcg -M pc -cpu max -smp 1 -icount shift=1,sleep=off -m 512 -nodefaults -display none "
        f"-serial stdio -no-reboot "
        f"-device isa-debug-exit,{EXIT_PORT}"
    ).split()
    command += ["-kernel", str(image), "-initrd", initramfs]
    command += ["-append", "console=ttyS0 quiet panic=-1 -- --gtest_color=no"]
    try:
        return subprocess.run(command, stdin=subprocess.DEVNULL, timeout=TIME_LIMIT_S).returncode
    except subprocess.TimeoutExpired:
        print(f"error: the machine did not end in {TIME_LIMIT_S} s")
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("guest")
    parser.add_argument("--profiles", required=True)
    parser.add_argument("--programs", nargs="*", default=[])
    parser.add_argument("--plugins", nargs="*", default=[])
    arguments = parser.parse_args()
    root = Path(os.environ.get("SPIDAR_TEST_KERNEL", "/"))
    if why := missing(root):
        print(f"skipped: {why}")
        return SKIPPED
    image, modules = find_kernel(root)
    with tempfile.NamedTemporaryFile(suffix=".cpio") as file:
        file.write(make_initramfs(arguments, modules))
        file.flush()
        print(f"kernel {image.name}, initramfs of {file.tell() / 1e6:.1f} MB", flush=True)
        begin = time.monotonic()
        status = run(image, file.name)
        print(f"machine ended with status {status} after {time.monotonic() - begin:.1f} s")
    return 0 if status == PASSED else 1


if __name__ == "__main__":
    sys.exit(main())
