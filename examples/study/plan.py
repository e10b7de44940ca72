# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Made answers with a known effect, and how often an experiment finds it."""

import math
import sys

import numpy as np
from scipy.special import expit
from scipy.stats import beta

from inference import MANY_CLIPS, difference
from trials import ANALYSIS, BLOCK, FIRST_GOOD, analysis_of, families

# Of a person without preference, each of the five steps is as likely.
THRESHOLDS = np.log([1 / 4, 2 / 3, 3 / 2, 4])
BLOCKS = (1, 2, 3, 4, 6, 8, 10)  # of participants
NODES, WEIGHTS = np.polynomial.hermite_e.hermegauss(40)
LARGEST_ODDS_RATIO, WIDEST = 1e6, 20  # beyond these, all answers are bad or very good
STUDIES = 500  # simulated at once; then as many as before, until the power is known to be above or below the aim
# Of an interval of the power. A table has some ten rows, each of which is looked at up to six times.
DOUBT = 0.001


def made_clips(random, clips, log_odds, clip_spread, studies=()):
    """Level and effect of each clip, log odds. `studies`: (N,) for a stack of N of them."""
    return [center + random.normal(0, clip_spread, (*studies, 1, clips, 1)) for center in (0, log_odds)]


def answers_to(random, participants, level, effect, spread):
    """Steps of each participant, clip and condition (the second one last), by the proportional odds of a higher step.

    `spread`: standard deviation between participants, of their level and of their effect.
    """
    *studies, _, clips, _ = level.shape
    person = lambda: random.normal(0, spread, (*studies, participants, 1, 1))
    latent = level + person() + (effect + person()) * np.array([-0.5, 0.5])
    return 1 + np.searchsorted(THRESHOLDS, latent + random.logistic(size=(*studies, participants, clips, 2)))


def made_answers(random, participants, clips, log_odds, spread, clip_spread, studies=()):
    return answers_to(random, participants, *made_clips(random, clips, log_odds, clip_spread, studies), spread)


def shares_above(center, deviation):
    """How many answers are above each threshold, where the log odds have a normal distribution."""
    latent = np.asarray(center)[..., None, None] + deviation * NODES - THRESHOLDS[:, None]
    return expit(latent) @ WEIGHTS / WEIGHTS.sum()


def shares_of(log_odds, spread, clip_spread):
    """For both conditions, over all people and clips: of the level, and of half of the effect."""
    return [shares_above(side * log_odds, math.sqrt(1.25 * (spread**2 + clip_spread**2))) for side in (-0.5, 0.5)]


def true_difference(log_odds, spread, clip_spread):
    """In steps: what the mean of all people and clips differs by."""
    first, second = shares_of(log_odds, spread, clip_spread)
    return float(sum(second) - sum(first))


def difference_for(level, effect, spread):
    """In steps: what the mean of all people differs by for these clips."""
    first, second = (shares_above(level + side * effect, math.sqrt(1.25) * spread).sum(axis=-1) for side in (-0.5, 0.5))
    return (second - first).mean(axis=(-3, -2, -1))


def difference_of(steps):
    return difference(steps[..., 1] - steps[..., 0])


def effect_in_words(log_odds, spread, clip_spread):
    first, second = (side[FIRST_GOOD - 2] for side in shares_of(log_odds, spread, clip_spread))
    marginal = second / (1 - second) / (first / (1 - first))
    return (f"odds ratio {math.exp(log_odds):.3g} of a higher answer for one person and one clip; over all people and "
            f"clips {marginal:.2g}: {100 * first:.0f} % and {100 * second:.0f} % are average or better, and the means differ by "
            f"{true_difference(log_odds, spread, clip_spread):.2f} steps")


def interval(found, studies):
    """Of a share, by C. Clopper and E. Pearson."""
    return (beta.ppf(DOUBT / 2, found, studies - found + 1) if found else 0.0,
            beta.ppf(1 - DOUBT / 2, found + 1, studies - found) if found < studies else 1.0)


def simulated(participants, clips, log_odds, options, numbers):
    """How many studies were made, in how many of these the primary outcome is found, in how many a secondary one, and in
    how many what is equal is found to be.

    By the first step of Holm's correction, the level divided by `numbers`, of comparisons in a family: that others are
    found only adds to it.
    """
    random = np.random.default_rng([participants, clips])
    found, studies = np.zeros(3, int), 0
    while True:
        for _ in range(max(1, studies // STUDIES)):
            made = lambda effect: difference_of(made_answers(random, participants, clips, effect, options.spread,
                                                             options.clip_spread, (STUDIES,)))
            one, none = made(log_odds), made(0)
            p = np.where(one.mean > 0, one.p(), 1)
            found += [(p < options.level / numbers["primary"]).sum(), (p < options.level / numbers["secondary"]).sum(),
                      (none.p_of_equivalence(ANALYSIS["margin_steps"]) < options.level / numbers["equal"]).sum()]
            studies += STUDIES
        low, high = interval(found[0], studies)
        if low > options.power or high < options.power or studies >= options.simulations:
            return studies, found
        if sys.stderr.isatty():
            print(f"\r{participants} × {clips}: {studies} studies …\r", end="", file=sys.stderr, flush=True)


def plan(options):
    """Prints the power for more and more participants and clips, until it is known to be enough."""
    if not 1 < options.odds_ratio <= LARGEST_ODDS_RATIO:
        raise ValueError(f"--odds-ratio {options.odds_ratio:g} is no effect to be found: give more than 1, and at most "
                         f"{LARGEST_ODDS_RATIO:g}")
    for name, value, most in (("spread", options.spread, WIDEST), ("clip-spread", options.clip_spread, WIDEST)):
        if not 0 <= value <= most:
            raise ValueError(f"--{name} {value:g}: give log odds from 0 to {most:g}")
    for name, value in ("power", options.power), ("level", options.level):
        if not 0 < value < 1:
            raise ValueError(f"--{name} {value:g}: give a probability between 0 and 1")
    if options.simulations < 1 or min(options.clips) < 1:
        raise ValueError("--clips and --simulations: give at least 1")
    numbers = {family: max(1, len(pairs)) for family, pairs in families(analysis_of(options.primary)).items()}
    log_odds = math.log(options.odds_ratio)
    print(effect_in_words(log_odds, options.spread, options.clip_spread) + "\n\npower: to find the primary outcome, with its "
          f"interval; one of {numbers['secondary']} secondary ones;\nand that conditions which are equal are so within "
          f"{ANALYSIS['margin_steps']:g} steps\n\n" f"clips participants  {options.primary:>22}  secondary  equal  studies")
    said = []
    for clips in options.clips:
        verdict = (f"with {clips} clips the power stays below {options.power:g} up to {BLOCKS[-1] * BLOCK} participants: "
                   "take more clips")
        for participants in (BLOCK * blocks for blocks in BLOCKS):
            studies, found = simulated(participants, clips, log_odds, options, numbers)
            low, high = interval(found[0], studies)
            primary, secondary, equal = found / studies
            print(f"{clips:5} {participants:12}  {f'{primary:.2f} ({low:.2f} to {high:.2f})':>22} {secondary:10.2f} "
                  f"{equal:6.2f} {studies:8}", flush=True)
            if low > options.power:
                verdict = (f"{participants} participants are enough with {clips} clips for a power of {options.power:g}. Add "
                           f"those who will drop out, up to a multiple of {BLOCK}")
                break
        said.append(verdict)
        if clips < MANY_CLIPS:
            said.append(f"with {clips} clips, what is found is of these clips; from {MANY_CLIPS} on, of others like them")
    print("\n" + "\n".join(said))
