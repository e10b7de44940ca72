# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Made answers with a known effect, and how often an experiment finds it."""

import numpy as np
from scipy.stats import binom

from ordinal import Model
from report import sign_test
from trials import BLOCK

# Of a person without preference, each of the five steps is as likely.
THRESHOLDS = np.log([1 / 4, 2 / 3, 3 / 2, 4])
MOST_BLOCKS = 20


def made_answers(random, participants, clips, log_odds, spread):
    """Steps of each participant, clip and condition (the second one last)."""
    level = random.normal(0, spread, (participants, 1, 1))
    effect = log_odds + random.normal(0, spread, (participants, 1, 1))
    latent = level + effect * np.array([-0.5, 0.5]) + random.logistic(size=(participants, clips, 2))
    return 1 + np.searchsorted(THRESHOLDS, latent)


def model_of(steps):
    participant, clip, condition = np.indices(steps.shape)
    return Model(steps.ravel(), condition.ravel() == 1, participant.ravel(), clip.ravel())


def sign_test_finds(steps, level):
    """That the second condition is higher."""
    difference = np.sign((steps[..., 1] - steps[..., 0]).sum(axis=1))
    p, _ = sign_test(int((difference > 0).sum()), int((difference < 0).sum()))
    return p < level and difference.sum() > 0


def model_finds(steps, level):
    """The same, by the ordinal model."""
    if steps.min() == steps.max():
        return False
    model = model_of(steps)
    p, free = model.p()
    return p < level and free.x[model.levels - 1] > 0


def plan(options):
    """Prints the power for more and more participants, until it is enough for both tests."""
    if not options.odds_ratio > 1:
        raise ValueError(f"--odds-ratio {options.odds_ratio:g} is no effect to be found: give more than 1")
    if not 0 < options.power < 1 or options.simulations < 1 or options.clips < 1 or options.spread < 0:
        raise ValueError("--power is between 0 and 1, --spread not negative, --clips and --simulations are at least 1")
    print(f"odds ratio {options.odds_ratio:g}, {options.clips} clips, {options.simulations} simulations of each number\n\n"
          "participants   power of the sign test   of the ordinal model")
    for participants in range(BLOCK, (MOST_BLOCKS + 1) * BLOCK, BLOCK):
        random = np.random.default_rng(participants)
        made = [made_answers(random, participants, options.clips, np.log(options.odds_ratio), options.spread)
                for _ in range(options.simulations)]
        power = [sum(finds(steps, options.level) for steps in made) / options.simulations
                 for finds in (sign_test_finds, model_finds)]
        print(f"{participants:12} {power[0]:24.2f} {power[1]:22.2f}", flush=True)
        if min(power) >= options.power:
            half = binom.ppf(0.975, options.simulations, options.power) / options.simulations - options.power
            print(f"\n{participants} participants are enough for a power of {options.power:g}, as far as "
                  f"{options.simulations} simulations tell (± {half:.2f}). Add those who will drop out, up to a "
                  f"multiple of {BLOCK}.")
            return
    print(f"\nthe power stays below {options.power:g} up to {MOST_BLOCKS * BLOCK} participants: the effect is too small")
