#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""samples.py BANK FEATURES OUT FIRST LAST [--held] [--processes N] [--seconds S]: for each seed from FIRST to LAST - 1,
renders a batch of films and keeps what the program FEATURES (motion-features of the build) measures of their blocks
beside the truth: OUT/SEED.npz. Files that are there are left as they are. With --held, photographs are those of
validation. With --seconds, no batch is begun after that time."""

import argparse
import multiprocessing
import os
import subprocess
import time

import cv2
import numpy as np

import shares
from film import BLOCK_px, Film, Noise, coded, sample
from shares import choose
from textures import Bank

INPUTS = 44
FILMS, SAMPLES, FRAMES = 6, 4, 14  # a batch: films, samples of each, frames of a sample
LONG_EVERY, LONG_FILMS, LONG_FRAMES = 8, 2, 42  # every so many batches are of long films

RECORD = np.dtype([("x", np.float16, INPUTS), ("origin", np.int16), ("flags", np.uint8)])


def measured(program, films, size):
    """What the program says of each picture: features, origins, flags; and of which pictures it says anything."""
    n, frames = films.shape[:2]
    rows, columns = size[1] // BLOCK_px, size[0] // BLOCK_px
    blocks = rows * columns
    raw = subprocess.run(
        [program, str(size[0]), str(size[1]), str(frames)],
        input=films.tobytes(),
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        check=True,
    ).stdout
    records = np.zeros((n, frames, blocks), RECORD)
    known = np.zeros((n, frames), bool)
    at = 0
    for i in range(n):
        for k in range(frames):
            known[i, k] = raw[at] == 1
            at += 1
            if known[i, k]:
                records[i, k] = np.frombuffer(raw, RECORD, blocks, at)
                at += blocks * RECORD.itemsize
    if at != len(raw):
        raise RuntimeError(f"{program} wrote {len(raw)} bytes, {at} were expected")
    return records, known


def batch(seed, bank, noise, program):
    rng = np.random.default_rng(seed)
    size = choose(rng, shares.SIZES)
    is_long = seed % LONG_EVERY == 0
    films, frames = (LONG_FILMS, LONG_FRAMES) if is_long else (FILMS, FRAMES)
    pictures, labels, kinds = [], [], []
    for _ in range(films):
        film = Film(rng, bank, size, frames)
        for _ in range(SAMPLES):
            p, y = sample(rng, film, noise)
            pictures.append(p)
            labels.append(y)
            kinds.append(" ".join(film.kinds))
    records, known = measured(program, coded(rng, np.array(pictures), size), size)
    return {
        "x": records["x"],
        "origin": records["origin"],
        "flags": records["flags"],
        "known": known,
        "y": np.array(labels),
        "kinds": np.array(kinds),
    }


def work(arguments, seeds, end):
    cv2.setNumThreads(1)
    bank, noise = Bank(arguments.bank, arguments.held), Noise(np.random.default_rng(0))
    while True:
        with seeds.get_lock():
            seed = seeds.value
            seeds.value += 1
        if seed >= arguments.last or time.monotonic() > end:
            return
        path = f"{arguments.out}/{seed}.npz"
        if os.path.exists(path):
            continue
        part = f"{path}.part.npz"
        np.savez(part, **batch(seed, bank, noise, arguments.features))
        os.rename(part, path)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bank")
    parser.add_argument("features")
    parser.add_argument("out")
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--held", action="store_true")
    parser.add_argument("--processes", type=int, default=os.cpu_count())
    parser.add_argument("--seconds", type=float, default=1e9)
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    begin = time.monotonic()
    seeds = multiprocessing.Value("q", arguments.first)
    workers = [
        multiprocessing.Process(target=work, args=(arguments, seeds, begin + arguments.seconds))
        for _ in range(arguments.processes)
    ]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    if any(worker.exitcode for worker in workers):
        raise SystemExit("error: a batch could not be rendered, see above")
    print(f"{len(os.listdir(arguments.out))} batches in {time.monotonic() - begin:.0f} s")


if __name__ == "__main__":
    main()
