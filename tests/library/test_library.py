#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A library of films on a laptop, on Slurm and on two hosts of ssh, each beside one run on one core.
    test_library.py SPIDARTRACK SNAKEFILE
Sixty films, of which three are broken and one is an hour long. While Slurm works, a job is cancelled and a node loses
its power; while GNU parallel works, a host does. Every track must be that of the one run, byte by byte."""
import json
import os
import shlex
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cluster
from cluster import NODES, run, wait_for

SHORT_FILMS = 56
BROKEN = ("broken/text.avi", "broken/empty.mkv", "broken/torn é.mp4")


def make_films(folder: Path):
    """Shapes of different speeds in three containers, names with spaces and quotes in subfolders."""
    for number in range(SHORT_FILMS):
        path = folder / f"reel {number % 3}" / f"it's {number}.{('mp4', 'mkv', 'avi')[number % 3]}"
        path.parent.mkdir(parents=True, exist_ok=True)
        run("ffmpeg", "-v", "error", "-f", "lavfi", "-i",
            f"testsrc2=size=320x240:rate={20 + number % 11}:duration={2 + number % 4}", "-c:v", "mpeg4", "-q:v", "5",
            "-vf", f"crop=300:220:{number % 20}:'mod(t*{number},20)'", "-bitexact", path)
    # Ten scenes of 6 s, again and again.
    minute = folder / "minute.mp4"
    scenes = ";".join(f"testsrc2=size=192x144:rate=25:duration=6,hue=h={36 * scene},"
                      f"rotate={scene}*t/20[{scene}]" for scene in range(10))
    run("ffmpeg", "-v", "error", "-filter_complex",
        scenes + ";" + "".join(f"[{scene}]" for scene in range(10)) + "concat=n=10[all]", "-map", "[all]", "-c:v",
        "mpeg4", "-q:v", "8", "-bitexact", minute)
    run("ffmpeg", "-v", "error", "-stream_loop", "59", "-i", minute, "-c", "copy", "-bitexact", folder / "hour.mkv")
    minute.unlink()
    whole = (folder / "reel 0/it's 0.mp4").read_bytes()
    (folder / "broken").mkdir()
    for name, content in zip(BROKEN, (b"no film", b"", whole[:len(whole) // 2])):
        (folder / name).write_bytes(content)


def tracks_in(folder: Path):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*.flac")}


class Library:
    def __init__(self, folder: Path, spidartrack: str, snakefile: Path):
        self.folder, self.films, self.spidartrack = folder, folder / "films", spidartrack
        self.snakemake = ["snakemake", "--snakefile", str(snakefile), "--nocolor"]
        self.profile = snakefile.parent / "slurm"
        self.films.mkdir()
        make_films(self.films)
        self.expected = {}

    def one_run(self):
        (self.folder / "one").mkdir()
        done = subprocess.run([self.spidartrack, "record", self.films, "--folder", self.folder / "one", "--jobs", "1"])
        assert done.returncode == 1, "three films are broken"
        self.expected = tracks_in(self.folder / "one")
        assert len(self.expected) == SHORT_FILMS + 1, sorted(self.expected)

    def judge(self, name):
        found = tracks_in(self.folder / name)
        assert found.keys() == self.expected.keys(), found.keys() ^ self.expected.keys()
        different = [path for path, track in found.items() if track != self.expected[path]]
        assert not different, different
        print(f"{name}: {len(found)} tracks are those of one run on one core, byte by byte", flush=True)

    def judge_report(self, name):
        tracks = self.folder / name
        page = (tracks / "report.html").read_text()
        assert f"{len(self.expected) + len(BROKEN)} films" in page and f"{len(BROKEN)} failed" in page
        for film in BROKEN:
            line = json.loads((tracks / f"{film}.json").read_text().splitlines()[-1])
            assert line["result"] == "failed" and line["error"], line
        assert len(list(tracks.rglob("*.png"))) == len(self.expected)

    def start_snakemake(self, name, *options):
        return subprocess.Popen([*self.snakemake, *options, "--config", f"films={self.films}",
                                 f"tracks={self.folder / name}"], cwd=self.folder)

    def await_films(self, process, name, count):
        """Until so many are done, and the process goes on."""
        def enough():
            assert process.poll() is None, f"{name} ended with {process.returncode} before {count} films were done"
            return len(list((self.folder / name).rglob("*.json"))) >= count
        wait_for(enough, f"{count} films of {name}", seconds=600)


def on_a_laptop(library):
    # Killed and started again.
    process = library.start_snakemake("laptop", "--cores", "2")
    library.await_films(process, "laptop", 10)
    process.kill()
    process.wait()
    unlocked = library.start_snakemake("laptop", "--cores", "2", "--unlock").wait()
    assert unlocked == 0
    assert library.start_snakemake("laptop", "--cores", "2", "--rerun-incomplete").wait() == 0
    library.judge("laptop")
    library.judge_report("laptop")


def running_jobs(node):
    return run("squeue", "--noheader", "--states=RUNNING", "--nodelist", node, "--format=%i").split()


def on_slurm(library, machines):
    process = library.start_snakemake("slurm", "--profile", str(library.profile), "--latency-wait", "5")
    library.await_films(process, "slurm", 5)
    wait_for(lambda: running_jobs(NODES[0]), "a job")
    job = running_jobs(NODES[0])[0]
    run("scancel", job)
    library.await_films(process, "slurm", 15)
    wait_for(lambda: running_jobs(NODES[1]), "a job")
    lost = running_jobs(NODES[1])
    machines.power_off(NODES[1])
    wait_for(lambda: run("sinfo", "--noheader", "--nodes", NODES[1], "--format=%T").startswith("down"),
             "a node that is down")
    time.sleep(5)
    machines.start(NODES[1])
    assert process.wait() == 0
    print(f"slurm: job {job} was cancelled, and {NODES[1]} died with job {' '.join(lost)}")
    library.judge("slurm")
    library.judge_report("slurm")


def on_two_hosts(library, machines):
    logins = {node: machines.start_ssh(node) for node in NODES}
    tracks = library.folder / "parallel"
    tracks.mkdir()
    log = library.folder / "joblog"
    process = subprocess.Popen(
        ["parallel", "--retries", "3", "--joblog", log,
         *(part for login in logins.values() for part in ("--sshlogin", f"1/{login}")),
         f"{library.spidartrack} record --jobs 1 --folder {tracks}"], stdin=subprocess.PIPE, text=True)
    process.stdin.write("\n".join(str(path) for path in sorted(library.films.rglob("*")) if path.is_file()))
    process.stdin.close()
    wait_for(lambda: log.exists() and len(log.read_text().splitlines()) > 20, "twenty films")
    machines.power_off(f"ssh {NODES[1]}")
    assert process.wait() == len(BROKEN)
    print(f"parallel: {NODES[1]} died")
    # Films that are named one by one have no subfolders.
    library.expected = {Path(path.name): track for path, track in library.expected.items()}
    library.judge("parallel")


def main():
    cluster.enter()
    program, snakefile = (Path(argument).resolve() for argument in sys.argv[1:])
    with tempfile.TemporaryDirectory(prefix="library.") as name:
        folder = Path(name)
        # What this test needs of its environment, for hosts that have none.
        (folder / "bin").mkdir()
        spidartrack = folder / "bin/spidartrack"
        settings = "".join(f"export {key}={shlex.quote(value)}\n" for key, value in os.environ.items()
                           if key.startswith("GST_"))
        spidartrack.write_text(f'#!/bin/sh\n{settings}exec {program} "$@"\n')
        spidartrack.chmod(0o755)
        os.environ["PATH"] = f"{folder / 'bin'}:{os.environ['PATH']}"
        library = Library(folder, str(spidartrack), snakefile)
        machines = cluster.Cluster(folder / "cluster")
        library.one_run()
        on_a_laptop(library)
        on_slurm(library, machines)
        on_two_hosts(library, machines)


if __name__ == "__main__":
    main()
