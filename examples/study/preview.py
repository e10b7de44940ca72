# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What the conditions of a study differ in, clip by clip, before anybody feels them."""

import csv
import math
import statistics
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from clip_player import analyse, make_filter
from delivery import WRENCH
from perception import FELT_N, told_apart

# Of the frames in which something is felt. Below this, the two controllers are the same for most of a clip, and an
# answer to which is better says nothing.
LEAST_APART = 0.5
ALPHAS_S_PX = (0.0025, 0.005, 0.01, 0.02, 0.04)  # from the default of motion=object on, by factors of two
PAPER = ["motion=mean", "filter-min-cutoff=0", "alpha=0.01"]  # docs/method.md; α is that of equation 15
FORCES = ("linear", "nonlinear", "sham")  # the conditions with a force of their own; "with" has that of "nonlinear"
PROPERTIES = {
    "linear": ["controller=linear"],
    "nonlinear": ["controller=nonlinear"],
    "without": ["controller=nonlinear", "mute=true"],  # the strings are taut but exert no force
    "with": ["controller=nonlinear"],
    "sham": ["controller=nonlinear"],
}


def force_of(condition):
    return "nonlinear" if condition in ("with", "without") else condition


@dataclass
class Clip:
    """Of a clip: root mean square of its force, N, at the limit of the study; max-force with which it is played, N."""
    felt: float  # share of the frames in which one of the controllers is felt
    apart: float  # share of these in which a hand can tell the controllers apart, as they are played
    difference: float  # median of these, of the larger force
    stronger: float  # share of these in which the nonlinear force is the larger one
    rms_N: dict
    max_force_N: dict
    frames: dict = field(default_factory=dict)  # by force, of each frame: time, ns, and its wrench as it is played, N and N m


def root_mean_square(values):
    return math.sqrt(statistics.fmean(value**2 for value in values))


def compare(forces_N, limit_N, is_matched):
    """`forces_N`: of each of FORCES, its amount in each frame, with max-force at `limit_N`."""
    rms_N = {name: root_mean_square(values) for name, values in forces_N.items()}
    target_N = min(rms_N.values())
    gain = {name: target_N / rms if is_matched and rms else 1.0 for name, rms in rms_N.items()}
    frames = [(gain["linear"] * linear, gain["nonlinear"] * nonlinear)
              for linear, nonlinear in zip(forces_N["linear"], forces_N["nonlinear"])]
    felt, differences, apart = told_apart(frames)
    if not differences:
        return Clip(0, 0, 0, 0, rms_N, {name: limit_N for name in FORCES})
    stronger = [nonlinear > linear for linear, nonlinear in frames if max(linear, nonlinear) >= FELT_N]
    return Clip(felt, apart, statistics.median(differences), statistics.fmean(stronger), rms_N,
                {name: limit_N * gain[name] for name in FORCES})


class Progress:
    """On standard error: what is looked at, and on a terminal also how far that is."""

    def __init__(self, clips):
        self.left, self.count, self.is_terminal = list(clips), len(clips), sys.stderr.isatty()

    def begin(self, clip):
        text = f"looking at {clip} ({self.count - len(self.left) + 1} of {self.count}) …"
        del self.left[:1]
        print(text, end="" if self.is_terminal else "\n", file=sys.stderr, flush=True)
        return lambda percent: self.is_terminal and print(f"\r{text} {percent} %", end="", file=sys.stderr, flush=True)

    def end(self):
        if self.is_terminal:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


def read_trace(trace):
    """Force, N, and torque, N m, of each frame, and the time, ns, of its motion: halfway since the frame before. Last the
    end of the clip, where they are at rest."""
    with open(trace, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    times_ns = [int(row["running_time_ns"]) for row in rows]
    end = [[2 * times_ns[-1] - times_ns[-2:][0], *[0.0] * len(WRENCH)]] if rows else []
    return [[(before_ns + time_ns) // 2, *(float(row[name]) for name in WRENCH)]
            for before_ns, time_ns, row in zip(times_ns[:1] + times_ns, times_ns, rows)] + end


def all_frames(clip, properties, limit_N, alphas, tell):
    """read_trace() by force and alpha, without a device. The clip is decoded once: that takes longer than to analyse it."""
    with tempfile.TemporaryDirectory() as folder:
        upright, turned, traces = [], [], {}
        for name, alpha in [("linear", None), *((name, alpha) for alpha in alphas for name in FORCES[1:])]:
            traces[name, alpha] = trace = Path(folder, f"{len(traces)}.csv")
            (turned if name == "sham" else upright).append(
                make_filter([*properties, *properties_of(alpha), *PROPERTIES[name], "device=none", f"max-force={limit_N:g}",
                             f"trace={trace}"]))
        analyse(clip, upright, turned, tell)
        return {key: read_trace(trace) for key, trace in traces.items()}


def measure(clip, properties, limit_N, is_matched, alphas, progress):
    """Analyses a clip with each controller: a Clip by alpha. `alphas`: None is the alpha of the properties."""
    by_force, found = all_frames(clip, properties, limit_N, alphas, progress.begin(clip)), {}
    progress.end()
    for alpha in alphas:
        frames = {"linear": by_force["linear", None]} | {name: by_force[name, alpha] for name in FORCES[1:]}
        found[alpha] = compare({name: [math.hypot(*row[1:4]) for row in rows[:-1]]
                                for name, rows in frames.items()}, limit_N, is_matched)
        # A wrench is proportional to max-force.
        gain = {name: max_N / limit_N for name, max_N in found[alpha].max_force_N.items()}
        found[alpha].frames = {name: [[time_ns, *(gain[name] * each for each in wrench)]
                                      for time_ns, *wrench in rows] for name, rows in frames.items()}
    return found


def properties_of(alpha):
    return [] if alpha is None else [f"alpha={alpha:g}"]


def choose(clips, accept_alike=False):
    """The smallest alpha with which enough frames of each clip differ, or the one with which the worst has most, of those that
    any alpha helps. Raises ValueError that names the clips at fault."""
    most = {name: max(clip.apart for clip in by_alpha.values()) for name, by_alpha in clips.items()}
    helped = [name for name in clips if most[name] >= LEAST_APART] or list(clips)
    worst = lambda alpha: min(clips[name][alpha].apart for name in helped)
    alphas = list(next(iter(clips.values())))
    alpha = next((alpha for alpha in alphas if worst(alpha) >= LEAST_APART), max(alphas, key=worst))
    still = [name for name, by_alpha in clips.items() if not any(clip.felt for clip in by_alpha.values())]
    if still:
        raise ValueError(f"{', '.join(still)}: no frame of it has a force that a hand feels ({FELT_N:g} N); choose another clip, in which "
                         "something moves, or other properties")
    alike = {name: most[name] for name in clips if most[name] < LEAST_APART} or {
        name: clips[name][alpha].apart for name in clips if clips[name][alpha].apart < LEAST_APART}
    if alike and not accept_alike:
        shares = "; ".join(f"{name}: linear and nonlinear can be told apart in {100 * share:.0f} % of the frames that are felt"
                           for name, share in alike.items())
        raise ValueError(f"{shares}; at least {100 * LEAST_APART:.0f} % are needed: choose a clip in which slow and fast motion "
                         "alternate (at a steady speed both are the same), or say --accept-alike")
    return alpha


def table(clips):
    lines = ["felt: frames in which something is felt. apart: of these, how many a hand tells apart (11 %). differ: the",
             "median difference. stronger: how many are stronger with nonlinear. N rms as measured; N max(-force) as played.", "",
             " " * 48 + "  ".join(f"{name:>16}" for name in FORCES),
             "alpha    felt %  apart %  differ %  stronger %   " + "  ".join(f"{'N rms':>7} {'N max':>8}" for _ in FORCES) +
             "  clip"]
    for name, by_alpha in clips.items():
        for alpha, clip in by_alpha.items():
            forces = "  ".join(f"{clip.rms_N[each]:7.3f} {clip.max_force_N[each]:8.3f}" for each in FORCES)
            lines.append(f"{'given' if alpha is None else f'{alpha:g}':7}{100 * clip.felt:8.0f} {100 * clip.apart:8.0f} "
                         f"{100 * clip.difference:9.0f} {100 * clip.stronger:11.0f}   {forces}  {name}")
    return "\n".join(lines)
