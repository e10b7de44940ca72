# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A cumulative link mixed model (proportional odds) of answers on an ordinal scale, by maximum likelihood.

P(answer ≤ k) = logistic(θ_k − η), η = (β + w_p) x + c_clip + u_p, where x is ½ for the second condition and −½ for the
first, and u_p ~ N(0, σ²), w_p ~ N(0, τ²) belong to the participant. The integral over u and w is a Gauss–Hermite
quadrature. A. Agresti, Categorical Data Analysis, 3rd edition 2013, sections 8.2 and 10.3. Neither SciPy nor statsmodels
has such a model.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize
from scipy.special import expit
from scipy.stats import chi2, norm

NODES = 15, 11  # of u and of w: with twice as many, β changes by less than 0.01 in made experiments
MOST_LOG_ODDS = 10.0  # where all of one condition are higher, the estimate would be infinite
MOST_LOG_GAP = 4.0  # of thresholds, which are then 55 apart: nothing is between them
MOST_LOG_SPREAD, LEAST_LOG_SPREAD = 2.0, -3.0  # standard deviations of 0.05 to 7.4: beyond, the answers no longer change
TINY = 1e-300


@dataclass
class Fit:
    log_odds: float  # β: how much higher the second condition is
    standard_error: float
    p: float  # likelihood ratio, two-sided
    spread: tuple  # σ and τ

    def interval(self, level=0.95):
        half = norm.ppf(0.5 + level / 2) * self.standard_error
        return self.log_odds - half, self.log_odds + half


class Model:
    """`answers`: 1 to 5; `is_second`: of the two conditions; `participants` and `clips`: anything that names them."""

    def __init__(self, answers, is_second, participants, clips):
        answers = np.asarray(answers)
        self.level = np.unique(answers, return_inverse=True)[1]  # steps that nobody used have no threshold
        self.levels = self.level.max() + 1
        self.x = np.where(np.asarray(is_second, bool), 0.5, -0.5)
        participant = np.unique(participants, return_inverse=True)[1]
        clip = np.unique(clips, return_inverse=True)[1]
        order = np.argsort(participant, kind="stable")
        self.level, self.x, clip = self.level[order], self.x[order], clip[order]
        self.begin = np.flatnonzero(np.r_[True, np.diff(participant[order]) > 0])
        self.of = np.repeat(np.arange(len(self.begin)), np.diff(np.r_[self.begin, len(order)]))
        columns = np.eye(clip.max() + 1)[clip]
        self.clips = columns[:, 1:] - columns[:, :1]  # effects that sum to zero
        points, weights = zip(*(np.polynomial.hermite_e.hermegauss(n) for n in NODES))
        self.u, self.w = (grid.ravel() for grid in np.meshgrid(*points, indexing="ij"))
        self.log_weight = np.log(np.outer(*weights).ravel() / (2 * np.pi))

    def thresholds(self, parameters):
        return np.cumsum(np.r_[parameters[0], np.exp(parameters[1:self.levels - 1])])

    def minus_log_likelihood(self, parameters, beta=None):
        """With its gradient. `beta`: held at this value."""
        parameters = np.array(parameters)
        n = self.levels - 1
        if beta is not None:
            parameters = np.insert(parameters, n, beta)
        theta = np.r_[-np.inf, self.thresholds(parameters), np.inf]
        sigma, tau = np.exp(parameters[-2:])
        fixed = parameters[n] * self.x + self.clips @ parameters[n + 1:-2]
        eta = fixed[:, None] + sigma * self.u + tau * self.x[:, None] * self.w
        above, below = expit(theta[self.level + 1][:, None] - eta), expit(theta[self.level][:, None] - eta)
        p = np.maximum(above - below, TINY)
        log_p = np.add.reduceat(np.log(p), self.begin) + self.log_weight
        top = log_p.max(axis=1, keepdims=True)
        each = np.exp(log_p - top)
        total = each.sum(axis=1, keepdims=True)
        weight = (each / total)[self.of] / p
        upper, lower = weight * above * (1 - above), weight * below * (1 - below)
        by_eta = lower - upper
        by_theta = [upper[self.level == k].sum() - lower[self.level == k + 1].sum() for k in range(n)]
        # Each gap moves all thresholds above it.
        moved = np.cumsum(by_theta[::-1])[::-1]
        by_answer = by_eta.sum(axis=1)
        gradient = np.r_[moved[0], moved[1:] * np.exp(parameters[1:n]), by_answer @ self.x, by_answer @ self.clips,
                         sigma * (by_eta @ self.u).sum(), tau * (self.x @ (by_eta @ self.w))]
        if beta is not None:
            gradient = np.delete(gradient, n)
        return -(np.log(total) + top).sum(), -gradient

    def start(self):
        shares = np.cumsum(np.bincount(self.level))[:-1] / len(self.level)
        theta = np.log(shares / (1 - shares))
        return np.r_[theta[0], np.log(np.diff(theta)), np.zeros(1 + self.clips.shape[1]), np.log(0.5), np.log(0.5)]

    def minimum(self, start, beta=None):
        bounds = [(None, None)] * len(start)
        bounds[1:self.levels - 1] = [(None, MOST_LOG_GAP)] * (self.levels - 2)
        bounds[-2:] = [(LEAST_LOG_SPREAD, MOST_LOG_SPREAD)] * 2
        if beta is None:
            bounds[self.levels - 1] = (-MOST_LOG_ODDS, MOST_LOG_ODDS)
        return minimize(self.minus_log_likelihood, start, args=(beta,), jac=True, method="L-BFGS-B", bounds=bounds)

    def p(self):
        """Of no effect."""
        start = self.start()
        free, null = self.minimum(start), self.minimum(np.delete(start, self.levels - 1), 0.0)
        return chi2.sf(max(0.0, 2 * (null.fun - free.fun)), 1), free

    def fit(self):
        if self.levels < 2:
            return Fit(0.0, np.inf, 1.0, (0.0, 0.0))
        p, free = self.p()
        step = 1e-4
        hessian = np.array([(self.minus_log_likelihood(free.x + step * row)[1]
                             - self.minus_log_likelihood(free.x - step * row)[1]) / (2 * step)
                            for row in np.eye(len(free.x))])
        # A spread at its bound is no longer estimated.
        inner = [i for i in range(len(free.x) - 2)] + [i for i in (-2, -1) if free.x[i] > LEAST_LOG_SPREAD + 0.01]
        variance = np.linalg.pinv(hessian[np.ix_(inner, inner)])[self.levels - 1, self.levels - 1]
        is_bounded = abs(free.x[self.levels - 1]) > MOST_LOG_ODDS - 0.01
        error = np.inf if is_bounded or not variance > 0 else np.sqrt(variance)
        return Fit(free.x[self.levels - 1], error, p, tuple(np.exp(free.x[-2:])))
