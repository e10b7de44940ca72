#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Prints which presentations of the study count (examples/study/delivery.py), as they were and doctored:

  tests/bench/study_delivery.py [--keep FOLDER] [--times N] FILM...

plays each film N times (4) with each controller, with the sham and without haptics, on the simulated device, in the shell
of `meson devenv`. What did not count although nothing was doctored is named. Each presentation in which neither ticks nor
pictures were late by more than JITTER_MS is then doctored in each way and size. --keep: traces that are there are taken,
and others are left there."""

import argparse
import csv
import json
import os
import sys
import tempfile
from collections import Counter
from dataclasses import asdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "study"))

import numpy as np  # noqa: E402

import delivery  # noqa: E402

MS_NS = delivery.MS_NS
CONDITIONS = {"linear": "nonlinear", "nonlinear": "linear", "sham": "nonlinear"}  # and what each is compared with
X, Y, Z, TORQUE_X, TORQUE_Z = 0, 1, 2, 3, 5


class Presentation:
    """Of its ticks: time of the clip, s, what was delivered, wanted, and would be with the other condition; and the times
    at which frames were on the screen."""

    def __init__(self, ticks, screen, wanted, other, source):
        self.rows, self.screen, self.source = ticks, screen, source
        self.running_ns = np.array([int(row["running_ns"]) for row in ticks])
        self.monotonic_ns = np.array([int(row["monotonic_ns"]) for row in ticks])
        self.got = np.array([[float(row[f"delivered_{name}"]) for name in delivery.WRENCH] for row in ticks])
        self.wanted, self.other = (delivery.between(each, self.running_ns) for each in (wanted, other))
        self.t_s = self.running_ns / 1e9
        self.is_acknowledged = np.ones(len(ticks), bool)

    def part(self, length_s, least_N=0.0):
        """Somewhere, where so much is to be felt all the time, if there is such a place."""
        begins = self.source.uniform(0.3, self.t_s[-1] - length_s - 0.3, 200)
        strong = [begin for begin in begins
                  if delivery.size(self.wanted[self.within(begin, length_s), :3]).min(initial=9) >= least_N]
        return self.within((strong or begins)[0], length_s)

    def within(self, begin_s, length_s):
        return (self.t_s >= begin_s) & (self.t_s < begin_s + length_s)

    def at(self, time_s, values=None):
        """What was delivered at other times of the clip."""
        values = self.got if values is None else values
        return np.stack([np.interp(time_s, self.t_s, each) for each in values.T], axis=1)

    def judged(self, wanted, other):
        names = ["running_ns", "monotonic_ns", *(f"delivered_{name}" for name in delivery.WRENCH)]
        ticks = [row | dict(zip(names, values)) | {"acknowledged": str(int(known))} for row, known, *values in
                 zip(self.rows, self.is_acknowledged, self.running_ns, self.monotonic_ns, *self.got.T)]
        frames = [{"device_no_force_reason": "none"}]
        return judged(ticks, frames, self.screen, wanted, False, [other])


def of_rows(call, files, *more):
    """A function of delivery.py, of rows instead of files."""
    before, delivery.rows_of = delivery.rows_of, files.get
    try:
        return call(*files, *more)
    finally:
        delivery.rows_of = before


def judged(ticks, frames, screen, *more):
    return of_rows(delivery.judge, {"ticks": ticks, "frames": frames, "screen": screen}, *more)


def is_undisturbed(ticks, screen, wanted):
    hand = of_rows(delivery.Hand, {"ticks": ticks, "screen": screen}, wanted, False)
    return max(abs(hand.picture_lag_ms).max(), hand.waited_ms()) <= delivery.JITTER_MS + 1


def added(p, part, axis, amount):
    p.got[part, axis] += amount[part] if np.ndim(amount) else amount


def scaled(p, part, factor):
    p.got[part] *= factor


def shifted(p, time_s):
    p.got = p.at(time_s)


def turned(p, part, degrees):
    angle = np.radians(degrees)
    p.got[part, :2] = p.got[part, :2] @ [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]


def screen_stops(p, ms):
    """The sink takes so much longer for one frame; it shows those that waited one after another."""
    shown = [int(row["shown_ns"]) for row in p.screen if row["shown_ns"]]
    begin_ns = shown[int(p.source.integers(5, len(shown) - 20))]
    free_ns = begin_ns + ms * MS_NS
    p.screen = [row | {"shown_ns": str(max(int(row["shown_ns"]), free_ns) if int(row["shown_ns"]) > begin_ns else
                                       row["shown_ns"])} for row in p.screen if row["shown_ns"]]


def screen_late(p, ms, after_s=0):
    """From the begin, or more and more until so long after it."""
    part = lambda row: int(row["running_ns"]) / 1e9 / after_s if after_s else 1
    p.screen = [row | {"shown_ns": str(int(row["shown_ns"]) + int(part(row) * ms * MS_NS))} for row in p.screen if row["shown_ns"]]


def longer(p, times):
    later = lambda running_ns: ((times - 1) * running_ns).astype(int)
    p.monotonic_ns = p.monotonic_ns + later(p.running_ns)
    p.screen = [row | {"shown_ns": str(int(row["shown_ns"]) + int(later(np.array(int(row["running_ns"])))))}
                for row in p.screen if row["shown_ns"]]


def both_stop(p, ms):
    """Picture and force: the clip's time stands still."""
    begin_ns = p.running_ns[len(p.running_ns) // 2]
    p.monotonic_ns = p.monotonic_ns + ms * MS_NS * (p.running_ns >= begin_ns)
    p.screen = [row | {"shown_ns": str(int(row["shown_ns"]) + ms * MS_NS * (int(row["running_ns"]) >= begin_ns))}
                for row in p.screen if row["shown_ns"]]


def held(p, part):
    p.got[part] = p.got[np.flatnonzero(part)[0]]


def sampled(p, step_s):
    shifted(p, p.t_s // step_s * step_s)


def smoothed(p, length_s):
    from scipy.ndimage import uniform_filter1d

    p.got = uniform_filter1d(p.got, round(1000 * length_s), axis=0)


def not_answered(p, part):
    p.is_acknowledged = ~part


def everywhere(p):
    return np.ones(len(p.t_s), bool)


def wave(p, hz):
    return np.sin(2 * np.pi * hz * p.t_s)


# What the page allows comes first.
KINDS = [
    ("late by so many ms", (30, 40, 60, 80), lambda p, ms: shifted(p, p.t_s - ms / 1000)),
    ("early by so many ms", (30, 40, 60, 80), lambda p, ms: shifted(p, p.t_s + ms / 1000)),
    ("times", (0.92, 1.1, 0.8, 1.25), lambda p, factor: scaled(p, everywhere(p), factor)),
    ("turned by so many degrees", (15, 25, 90), lambda p, degrees: turned(p, everywhere(p), degrees)),
    ("clip and force stop for so many ms", (60, 150), both_stop),
    ("cut off at so much of the largest", (0.9, 0.7), lambda p, part: np.clip(p.got, -part * abs(p.got).max(), part * abs(p.got).max(), out=p.got)),
    ("the screen stops for so many ms", (150, 200, 250), screen_stops),
    ("the screen is late, or early, by so many ms", (60, 90, 200, -60, -90), screen_late),
    ("the screen is late, or early, by so many ms at the end, evenly", (400, -400), lambda p, ms: screen_late(p, ms, p.t_s[-1])),
    ("the clip takes so many times as long", (0.5, 0.8, 0.9, 1.1, 1.5), longer),
    ("torque that nobody wanted, N m", (0.005, 0.02), lambda p, amount: added(p, everywhere(p), TORQUE_X, amount)),
    ("torque against the wanted one", (1,), lambda p, _: scaled(p, (slice(None), slice(3, 6)), -1)),
    ("more in z, N", (0.1, 0.15), lambda p, amount: added(p, everywhere(p), Z, amount)),
    ("more in x, N", (0.1,), lambda p, amount: added(p, everywhere(p), X, amount)),
    ("drifts by so much until the end, N", (0.2,), lambda p, amount: added(p, everywhere(p), X, amount * p.t_s / p.t_s[-1])),
    ("0.1 N more at so many Hz", (0.3, 1, 3, 30, 250), lambda p, hz: added(p, everywhere(p), Y, 0.1 * wave(p, hz))),
    ("0.2 N more at 5 Hz, for so many s", (1, 0.3), lambda p, s: added(p, p.part(s), Y, 0.2 * wave(p, 5))),
    ("0.15 N more at 60 Hz, for so many s", (1, 0.2), lambda p, s: added(p, p.part(s), Y, 0.15 * wave(p, 60))),
    ("noise of so many N rms", (0.1,), lambda p, amount: added(p, everywhere(p), X, p.source.normal(0, amount, len(p.t_s)))),
    ("against the motion for so many s", (0.1, 0.15, 0.3), lambda p, s: scaled(p, p.part(s), -1)),
    ("none for so many s, where 0.3 N are wanted", (0.03, 0.1), lambda p, s: scaled(p, p.part(s, 0.3), 0)),
    ("stands at its value for so many s", (0.15, 0.3), lambda p, s: held(p, p.part(s))),
    ("turned by 40° in so much of the time", (0.3,), lambda p, part: turned(p, p.t_s % 1 < part, 40)),
    ("a knock of 1 N for so many s", (0.005, 0.02), lambda p, s: added(p, p.part(s), X, 1)),
    ("stretched by so much", (0.02, -0.02), lambda p, part: shifted(p, p.t_s / (1 + part))),
    ("so much of the other condition", (0.3, 0.45, 1), lambda p, part: p.got.__iadd__(part * (p.other - p.wanted))),
    ("falls to so much until the end", (0.6,), lambda p, part: scaled(p, everywhere(p), np.linspace(1, part, len(p.t_s))[:, None])),
    ("a value each so many s", (0.1, 0.2), sampled),
    ("a mean over so many s", (0.2,), smoothed),
    ("nothing at the begin for so many s", (0.3,), lambda p, s: scaled(p, p.within(0, s), 0)),
    ("nothing at the end for so many s", (0.3,), lambda p, s: scaled(p, p.within(p.t_s[-1] - s, s), 0)),
    ("no answer of the device for so many s", (0.15,), lambda p, s: not_answered(p, p.part(s))),
    ("no number in one tick", (1,), lambda p, _: added(p, np.arange(len(p.t_s)) == 1000, X, np.nan)),
]


def play(film, folder, times):
    """Traces of a film, and what its preview found, kept in `folder`."""
    import clip_player
    import preview

    measured = folder / f"{Path(film).stem}.json"
    if measured.exists():
        return json.loads(measured.read_text())
    properties = ["max-force=1"]
    by_alpha = {film: preview.measure(film, properties, 1, True, preview.ALPHAS_S_PX, preview.Progress([film]))}
    alpha = preview.choose(by_alpha, True)
    clip = by_alpha[film][alpha]
    with clip_player.Player([*properties, "device=sim", *preview.properties_of(alpha)], "headless") as player:
        for n in range(times):
            for condition in *CONDITIONS, "without":
                most_N = clip.max_force_N[preview.force_of(condition)]
                frames, ticks, screen = files(folder, film, condition, n)
                player.play(film, ["mute=false", *preview.PROPERTIES[condition], f"trace={frames}", f"max-force={most_N:.6f}"],
                            condition == "sham", ticks, screen)
    measured.write_text(json.dumps(asdict(clip)))
    return asdict(clip)


def files(folder, film, condition, n):
    return [str(folder / f"{Path(film).stem}-{condition}-{n}{kind}.csv") for kind in ("", ".haptic", ".screen")]


def presentations(films, folder, times):
    """Of each: rows of frames, ticks and screen, its condition, wanted wrenches and those of the other condition."""
    for film in films:
        clip = play(film, folder, times)
        for condition in *CONDITIONS, "without":
            for n in range(times):
                frames, ticks, screen = (delivery.rows_of(path) for path in files(folder, film, condition, n))
                own, other = (clip["frames"][each] for each in ("nonlinear", "linear")) if condition == "without" else (
                    clip["frames"][condition], clip["frames"][CONDITIONS[condition]])
                yield frames, [row for row in ticks if row["playing"] == "1"], screen, condition == "without", own, other


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--times", type=int, default=4)
    parser.add_argument("films", nargs="+")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if options.keep:
            options.keep.mkdir(exist_ok=True)
        problems, undisturbed, accepted, count = [], [], Counter(), Counter()
        for n, (frames, ticks, screen, is_muted, own, other) in enumerate(
                presentations(options.films, options.keep or Path(folder), options.times)):
            problems.append(judged(ticks, frames, screen, own, is_muted, [other])[1])
            if not is_undisturbed(ticks, screen, own):
                continue
            undisturbed.append(problems[-1])
            for kind, sizes, doctor in KINDS if not is_muted else ():
                for size in sizes:
                    one = Presentation(ticks, screen, own, other, np.random.default_rng([n, len(kind)]))
                    doctor(one, size)
                    accepted[kind, size] += not one.judged(own, other)[1]
                    count[kind, size] += 1
    print(f"as they were: {problems.count('')} of {len(problems)} accepted, and of those that nothing disturbed "
          f"{undisturbed.count('')} of {len(undisturbed)}; a load of {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
    for problem in filter(None, problems):
        print(f"  {problem}")
    print("\n| kind | sizes | accepted |\n|---|---|---|")
    for kind, sizes, _ in KINDS if count else ():
        print(f"| {kind} | {', '.join(f'{size:g}' for size in sizes)} | {', '.join(str(accepted[kind, size]) for size in sizes)}"
              f" of {count[kind, sizes[0]]} |")


if __name__ == "__main__":
    main()
