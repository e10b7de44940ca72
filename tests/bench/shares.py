# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Shares of frames with their intervals over films.

Frames of one film are alike, so their number says little: what was drawn is the films. Each resample draws as many films
as there are, with replacement, and divides the sums (percentile bootstrap, B. Efron and R. Tibshirani, An Introduction to
the Bootstrap, 1993, chapter 13). Of few films, such an interval is too narrow rather than too wide. Where no frame of any
film counts, or every one, resamples say nothing: then each film is a trial (C. Clopper and E. Pearson, 1934)."""

import random

RESAMPLES = 4000
LEVEL = 0.95


def interval(counts):
    """`counts`: (part, whole) of each film. Bounds of the share, or nothing without any frame or with a single film."""
    counts = [(part, whole) for part, whole in counts if whole]
    if len(counts) < 2:
        return None
    bound = ((1 - LEVEL) / 2) ** (1 / len(counts))
    if not any(part for part, _ in counts):
        return 0, 1 - bound
    if all(part == whole for part, whole in counts):
        return bound, 1
    source = random.Random(1)
    drawn = []
    for _ in range(RESAMPLES):
        films = source.choices(counts, k=len(counts))
        drawn.append(sum(part for part, _ in films) / sum(whole for _, whole in films))
    drawn.sort()
    tail = round((1 - LEVEL) / 2 * RESAMPLES)
    return drawn[tail], drawn[-1 - tail]


def share(counts):
    """In per cent, with its interval: 84.2 (71 to 93)."""
    part, whole = (sum(each[n] for each in counts) for n in (0, 1)) if counts else (0, 0)
    if not whole:
        return "-"
    bounds = interval(counts)
    return f"{100 * part / whole:.1f}" + (f" ({100 * bounds[0]:.0f} to {100 * bounds[1]:.0f})" if bounds else "")


def mean_of_films(counts):
    """In per cent, each film counting once however long it is, and how many films are below half: 75.2, 6 of 35."""
    each = [part / whole for part, whole in counts if whole]
    return f"{100 * sum(each) / len(each):.1f}, {sum(share < 0.5 for share in each)} of {len(each)}" if each else "-"


def right_less_false(right, false):
    """The share of the one less that of the other, in per cent, with its interval: 83.4 (75 to 89)."""
    right, false = ([(part, whole) for part, whole in counts if whole] for counts in (right, false))
    if not right or not false:
        return "-"
    of = lambda films: sum(part for part, _ in films) / sum(whole for _, whole in films)
    source = random.Random(1)
    drawn = sorted(of(source.choices(right, k=len(right))) - of(source.choices(false, k=len(false))) for _ in range(RESAMPLES))
    tail = round((1 - LEVEL) / 2 * RESAMPLES)
    return f"{100 * (of(right) - of(false)):.1f} ({100 * drawn[tail]:.0f} to {100 * drawn[-1 - tail]:.0f})"


def paired(first, second):
    """Mean difference of two methods' shares of the same films in per cent, and how likely so large a one is if they are
    alike: then each film's difference has either sign (R. Fisher, The Design of Experiments, 1935, section 21)."""
    differences = [a[0] / a[1] - b[0] / b[1] for a, b in zip(first, second) if a[1] and b[1]]
    if not differences:
        return "-"
    source, larger = random.Random(1), 0
    for _ in range(RESAMPLES):
        larger += abs(sum(source.choice((-1, 1)) * each for each in differences)) >= abs(sum(differences)) - 1e-9
    return f"{100 * sum(differences) / len(differences):+.1f}, p = {(larger + 1) / (RESAMPLES + 1):.4f}"


ANGLES_DEG = (5, 10, 15, 18.4, 20, 30, 45, 60)  # 18.4: what a hand tells apart (F. Barbagli, 2006)
FACTORS = (1.1, 1.25, 1.5, 2, 3)


def within(films, angle_deg, factor):
    """`films`: of each, angle in degrees and ratio of speeds for each frame, or nothing where no motion was found."""
    return share([(sum(frame is not None and frame[0] < angle_deg and 1 / factor < frame[1] < factor for frame in film),
                   len(film)) for film in films])


def curve(name, films):
    """How the share of right frames depends on what counts as right: by angle at a factor of 2, and by factor at 30°."""
    by_angle = " | ".join(within(films, angle, 2) for angle in ANGLES_DEG)
    by_factor = " | ".join(within(films, 30, factor) for factor in FACTORS)
    return f"| {name} | {by_angle} | {by_factor} |"


CURVE_COLUMNS = ["", *(f"{angle:g}°" for angle in ANGLES_DEG), *(f"×{factor:g}" for factor in FACTORS)]
