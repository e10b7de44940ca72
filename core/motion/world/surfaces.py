# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Surfaces in three dimensions. Lengths are in metres, times in frames; the camera of the first frame is near the
origin and looks along z, x is right, y down."""

import cv2
import numpy as np

# What a pixel belongs to, in the picture of owners; 1 … 200 are surfaces that move by themselves.
STILL, IGNORED, RESTLESS = 0, 254, 255
OWNED = 40  # alpha from which on a pixel belongs to a surface: the soft edge of a ball moves with it


def pyramid(grey, alpha):
    levels = [(grey, alpha)]
    while min(levels[-1][0].shape[:2]) > 24:
        levels.append(
            tuple(
                None if x is None else cv2.resize(x, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
                for x in levels[-1]
            )
        )
    return levels


class Surface:
    """A flat piece: corner o, sides u and v; what is behind has a larger depth. `path(t)` shifts it, `turn` = (joint,
    amplitude, rate, phase) swings it in its plane, `spin` = (centre, rate) turns it, `wave(grey, t)` bends its
    texture, by at most `wave_px` a frame."""

    def __init__(
        self, grey, alpha, o, u, v, depth, owner=STILL, path=None, turn=None, spin=None, wave=None, wave_px=0.0
    ):
        self.levels = pyramid(grey, alpha)
        self.o, self.u, self.v = (np.asarray(x, float) for x in (o, u, v))
        self.depth, self.owner = float(depth), owner
        self.path, self.turn, self.spin, self.wave, self.wave_px = path, turn, spin, wave, wave_px

    def corner(self, t):
        o, u, v = self.o, self.u, self.v
        for motion in (self.turn, self.spin):
            if motion is None:
                continue
            about, angle = (
                (motion[0], motion[1] * np.sin(motion[2] * t + motion[3]))
                if motion is self.turn
                else (motion[0], motion[1] * t)
            )
            c, s = np.cos(angle), np.sin(angle)
            R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
            o, u, v = about + R @ (o - about), R @ u, R @ v
        return (o if self.path is None else o + self.path(t)), u, v

    def draw(self, camera, t, image, owners):
        R, c, f = camera
        h, w = image.shape
        o, u, v = self.corner(t)
        q = np.stack([R @ u, R @ v, R @ (o - c)], 1)
        z = q[2, 2] + np.array([0, q[2, 0], q[2, 0] + q[2, 1], q[2, 1]])
        if z.min() < 0.25:
            return
        K = np.array([[f, 0, w / 2], [0, f, h / 2], [0, 0, 1.0]])
        p = (K @ q @ np.array([[0, 1, 1, 0], [0, 0, 1, 1], [1, 1, 1, 1.0]]))[:2] / z
        x0, y0 = max(int(np.floor(p[0].min())), 0), max(int(np.floor(p[1].min())), 0)
        x1, y1 = min(int(np.ceil(p[0].max())) + 1, w), min(int(np.ceil(p[1].max())) + 1, h)
        if x1 <= x0 or y1 <= y0:
            return
        wide = max(np.hypot(*(p[:, 1] - p[:, 0])), np.hypot(*(p[:, 2] - p[:, 3])), 1)
        level = int(np.clip(np.round(np.log2(self.levels[0][0].shape[1] / wide) - 0.1), 0, len(self.levels) - 1))
        grey, alpha = self.levels[level]
        if self.wave is not None:
            grey = self.wave(grey, t)
        M = (
            np.array([[1, 0, -x0], [0, 1, -y0], [0, 0, 1.0]])
            @ K
            @ q
            @ np.diag([1 / grey.shape[1], 1 / grey.shape[0], 1])
        )
        size = (x1 - x0, y1 - y0)
        to = image[y0:y1, x0:x1]
        part = cv2.warpPerspective(grey, M, size, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        if alpha is None and covers(M, grey.shape, size):
            to[:] = part
            if owners is not None:
                owners[y0:y1, x0:x1] = self.owner
            return
        a = cv2.warpPerspective(
            np.full(grey.shape, 255, np.uint8) if alpha is None else alpha, M, size, flags=cv2.INTER_LINEAR
        )
        if self.owner == IGNORED and self.wave is None:  # a shadow or a reflection darkens what is below
            to[:] = cv2.multiply(to, 255 - cv2.convertScaleAbs(a, alpha=0.6), scale=1 / 255)
        else:
            to[:] = cv2.add(cv2.multiply(part, a, scale=1 / 255), cv2.multiply(to, 255 - a, scale=1 / 255))
        if owners is not None:
            owners[y0:y1, x0:x1][a > OWNED] = self.owner


def covers(M, shape, size):
    """Whether a warped texture fills the whole of its target."""
    back = np.linalg.inv(M)
    p = back @ np.array([[0, size[0], size[0], 0], [0, 0, size[1], size[1]], [1, 1, 1, 1.0]])
    x, y = p[0] / p[2], p[1] / p[2]
    return (p[2] > 0).all() and x.min() >= 0 and y.min() >= 0 and x.max() <= shape[1] and y.max() <= shape[0]


class Relief:
    """A rough surface that fills the picture: `depths` of a grid of corners."""

    def __init__(self, grey, depths, f, size, sides=1.15):
        self.depth, self.owner, self.path = 9e5, STILL, None
        ny, nx = depths.shape
        x, y = np.meshgrid(np.linspace(-sides, sides, nx) * size[0] / f, np.linspace(-sides, sides, ny) * size[1] / f)
        self.corners = np.stack([x * depths, y * depths, depths], -1)
        self.grey = grey

    def draw(self, camera, t, image, owners):
        """Cell by cell, from far to near."""
        R, c, f = camera
        h, w = image.shape
        q = (self.corners - c) @ R.T
        z = np.maximum(q[..., 2], 0.25)
        px, py = f * q[..., 0] / z + w / 2, f * q[..., 1] / z + h / 2
        ny, nx = z.shape
        th, tw = (self.grey.shape[0] - 1) / (ny - 1), (self.grey.shape[1] - 1) / (nx - 1)
        order = np.argsort(-(z[:-1, :-1] + z[1:, 1:]).ravel())
        for k in order:
            j, i = divmod(int(k), nx - 1)
            to = np.float32(
                [
                    [px[j, i], py[j, i]],
                    [px[j, i + 1], py[j, i + 1]],
                    [px[j + 1, i + 1], py[j + 1, i + 1]],
                    [px[j + 1, i], py[j + 1, i]],
                ]
            )
            x0, y0 = max(int(to[:, 0].min()) - 1, 0), max(int(to[:, 1].min()) - 1, 0)
            x1, y1 = min(int(to[:, 0].max()) + 2, w), min(int(to[:, 1].max()) + 2, h)
            if x1 <= x0 or y1 <= y0:
                continue
            at = np.float32(
                [[i * tw, j * th], [(i + 1) * tw, j * th], [(i + 1) * tw, (j + 1) * th], [i * tw, (j + 1) * th]]
            )
            to -= np.float32([x0, y0])
            M = cv2.getPerspectiveTransform(at, to)
            part = cv2.warpPerspective(
                self.grey, M, (x1 - x0, y1 - y0), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
            )
            inside = np.zeros(part.shape, np.uint8)
            cv2.fillConvexPoly(inside, np.round(to * 16).astype(np.int32), 1, shift=4)
            cv2.copyTo(part, inside, image[y0:y1, x0:x1])
