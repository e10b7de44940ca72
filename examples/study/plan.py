# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Made answers with a known effect, and how often an experiment finds it."""

import math

import numpy as np
from scipy.special import expit
from scipy.stats import binom

from inference import difference
from trials import BLOCK, FIRST_GOOD

# Of a person without preference, each of the five steps is as likely.
THRESHOLDS = np.log([1 / 4, 2 / 3, 3 / 2, 4])
MOST_BLOCKS = 10
NODES, WEIGHTS = np.polynomial.hermite_e.hermegauss(40)


def made_answers(random, participants, clips, log_odds, spread, clip_spread):
    """Steps of each participant, clip and condition (the second one last), by the proportional odds of a higher step.

    `spread`: standard deviation between participants, of their level and of their effect; `clip_spread`: between clips,
    the same.
    """
    draw = lambda deviation, *shape: random.normal(0, deviation, shape)
    level = draw(spread, participants, 1, 1) + draw(clip_spread, 1, clips, 1)
    effect = log_odds + draw(spread, participants, 1, 1) + draw(clip_spread, 1, clips, 1)
    latent = level + effect * np.array([-0.5, 0.5]) + random.logistic(size=(participants, clips, 2))
    return 1 + np.searchsorted(THRESHOLDS, latent)


def shares_above(log_odds, spread, clip_spread):
    """For both conditions, how many answers are above each threshold, over all people and clips."""
    deviation = math.sqrt(1.25 * (spread**2 + clip_spread**2))  # of the level, and of half of the effect
    return [[float(WEIGHTS @ expit(side * log_odds + deviation * NODES - threshold) / WEIGHTS.sum())
             for threshold in THRESHOLDS] for side in (-0.5, 0.5)]


def true_difference(log_odds, spread, clip_spread):
    """In steps: what the mean of all people and clips differs by."""
    first, second = shares_above(log_odds, spread, clip_spread)
    return sum(second) - sum(first)


def difference_of(steps):
    return difference(steps[..., 1] - steps[..., 0])


def finds(steps, level):
    """That the second condition is higher."""
    found = difference_of(steps)
    return found.mean > 0 and found.p() < level


def effect_in_words(log_odds, spread, clip_spread):
    first, second = (side[FIRST_GOOD - 2] for side in shares_above(log_odds, spread, clip_spread))
    marginal = second / (1 - second) / (first / (1 - first))
    return (f"odds ratio {math.exp(log_odds):.3g} of a higher answer for one person and one clip; over all people and "
            f"clips {marginal:.2g}: {100 * first:.0f} % and {100 * second:.0f} % are average or better, and the means differ by "
            f"{true_difference(log_odds, spread, clip_spread):.2f} steps")


def plan(options):
    """Prints the power for more and more participants and clips, until it is enough."""
    if not options.odds_ratio > 1:
        raise ValueError(f"--odds-ratio {options.odds_ratio:g} is no effect to be found: give more than 1")
    if (not 0 < options.power < 1 or options.simulations < 1 or min(options.clips) < 1
            or min(options.spread, options.clip_spread) < 0):
        raise ValueError("--power is between 0 and 1, --spread and --clip-spread not negative, --clips and --simulations "
                         "at least 1")
    effect = np.log(options.odds_ratio), options.spread, options.clip_spread
    print(f"{effect_in_words(*effect)}\n\npower by participants and clips, {options.simulations} simulations each\n\n"
          "participants" + "".join(f"{clips:8} clips" for clips in options.clips))
    enough = {}
    for participants in range(BLOCK, (MOST_BLOCKS + 1) * BLOCK, BLOCK):
        power = {}
        for clips in options.clips:
            random = np.random.default_rng([participants, clips])
            power[clips] = sum(finds(made_answers(random, participants, clips, *effect), options.level)
                               for _ in range(options.simulations)) / options.simulations
            if power[clips] >= options.power:
                enough.setdefault(clips, participants)
        print(f"{participants:12}" + "".join(f"{each:14.2f}" for each in power.values()), flush=True)
        if len(enough) == len(options.clips):
            break
    half = binom.ppf(0.975, options.simulations, options.power) / options.simulations - options.power
    print()
    for clips in options.clips:
        if clips in enough:
            print(f"{enough[clips]} participants are enough with {clips} clips for a power of {options.power:g} "
                  f"(± {half:.2f}). Add those who will drop out, up to a multiple of {BLOCK}")
        else:
            print(f"with {clips} clips the power stays below {options.power:g} up to {MOST_BLOCKS * BLOCK} participants: "
                  "take more clips")
