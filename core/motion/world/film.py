# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Renders films with exact truth, and makes of each what a lens, a sensor, an editor and a codec would."""

import subprocess

import cv2
import numpy as np

import shares
from camera import Camera, project
import objects
from motions import smooth_walk
from scene import Scene
from surfaces import IGNORED
from shares import choose

BLOCK_px = 16
MARGIN_px = 16  # around the film, from which samples are cut
RESTS_px, MOVES_px = 0.05, 0.2  # a frame: less is rest, more is motion, what is between is not judged
MOMENTS = 5  # of a motion blur, which are added up


class Film:
    """frames: n clean pictures with their margin; owners: what each pixel belongs to; moves, doubtful: of each frame
    and owner."""

    def __init__(self, rng, bank, size, frames):
        self.size = size
        w, h = size[0] + MARGIN_px, size[1] + MARGIN_px
        scene = Scene(rng, bank, (w, h), frames)
        scene.scenery()
        count = choose(rng, shares.OBJECTS)
        for number in range(count):
            objects.add(scene, shares.AREA[1] if number == 0 else 0.08)
        camera = Camera(rng, scene.f, scene.kind, scene.far, frames, scene.targets[0] if scene.targets else None)
        self.kinds = (camera.mode, scene.kind, str(count))
        surfaces = sorted(scene.surfaces, key=lambda s: -s.depth)
        self.own_motion(surfaces, camera, frames, (w, h), scene.owner)
        self.render(rng, surfaces, camera, frames, (w, h))

    def own_motion(self, surfaces, camera, frames, size, owners):
        """How far each surface that moves by itself moves, px a frame, apart from what the camera does."""
        own = np.zeros((frames, 256), np.float32)
        for surface in surfaces:
            if not 0 < surface.owner < IGNORED:
                continue
            for k in range(1, frames):
                view = camera.at(k)
                (o0, u0, v0), (o1, u1, v1) = surface.corner(k - 1), surface.corner(k)
                most = 0.5 * surface.wave_px
                for a, b in ((0.5, 0.5), (0.15, 0.15), (0.85, 0.85)):
                    p0, p1 = project(view, o0 + a * u0 + b * v0, size), project(view, o1 + a * u1 + b * v1, size)
                    if p0 is not None and p1 is not None:
                        most = max(most, float(np.hypot(*(p1 - p0))))
                own[k, surface.owner] = most
        own[0] = own[min(1, frames - 1)]
        lasting = np.maximum(own, np.maximum(np.roll(own, 1, 0), np.roll(own, -1, 0)))  # what swings turns back
        lasting[0], lasting[-1] = own[:2].max(0), own[-2:].max(0)
        self.moves = lasting > MOVES_px
        self.doubtful = (lasting > RESTS_px) & ~self.moves | self.moves & (own < MOVES_px / 2)
        self.doubtful[:, IGNORED] = True

    def render(self, rng, surfaces, camera, frames, size):
        w, h = size
        blurred = rng.random() < shares.MOTION_BLUR
        interlaced = not blurred and rng.random() < shares.INTERLACED
        exposure = rng.uniform(0.2, 0.8)
        lens = rng.normal(0, 0.06) if rng.random() < shares.LENS else 0
        turns = camera.mode in ("hand", "follow", "travel", "pan", "orbit")
        rolling = rng.uniform(0.2, 1) if turns and rng.random() < shares.ROLLING_SHUTTER else 0
        gy, gx = np.mgrid[0:h, 0:w].astype(np.float32)
        r2 = ((gx - w / 2) ** 2 + (gy - h / 2) ** 2) / (w / 2) ** 2
        lens_x, lens_y = w / 2 + (gx - w / 2) * (1 + lens * (r2 - 0.5)), h / 2 + (gy - h / 2) * (1 + lens * (r2 - 0.5))

        # In front of a camera at rest, what is behind all that moves is drawn once.
        first = next((k for k, s in enumerate(surfaces) if s.owner != 0), len(surfaces)) if camera.is_still else 0
        behind = np.full((h, w), 110, np.uint8)
        for surface in surfaces[:first]:
            surface.draw(camera.at(0), 0, behind, None)

        def picture(t, owners):
            image = behind.copy()
            view = camera.at(t)
            for surface in surfaces[first:]:
                surface.draw(view, t, image, owners)
            return image

        self.frames, self.owners = [], []
        for k in range(frames):
            owners = np.zeros((h, w), np.uint8)
            if blurred:
                moments = np.linspace(-exposure / 2, exposure / 2, MOMENTS)
                image = np.mean(
                    [picture(k + m, owners if k_m == MOMENTS // 2 else None) for k_m, m in enumerate(moments)], 0
                ).astype(np.uint8)
            else:
                image = picture(k, owners)
                if interlaced:
                    image[1::2] = picture(k + 0.5, None)[1::2]
            if lens or rolling:
                map_x, map_y = lens_x, lens_y
                if rolling:  # rows are taken one after the other
                    (R0, _, f0), (R1, _, _) = camera.at(k), camera.at(k + 1)
                    turn = R1 @ R0.T
                    late = (gy / h - 0.5) * rolling
                    map_x, map_y = (lens_x - late * f0 * turn[0, 2]).astype(np.float32), (
                        lens_y - late * f0 * turn[1, 2]
                    ).astype(np.float32)
                image = cv2.remap(image, map_x, map_y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
                owners = cv2.remap(owners, map_x, map_y, cv2.INTER_NEAREST, borderMode=cv2.BORDER_REPLICATE)
            self.frames.append(image)
            self.owners.append(owners)


def graphics(rng, size, frames):
    """What belongs to the screen: functions that draw it into (image, mask, k)."""
    w, h = size
    kind = choose(rng, shares.GRAPHICS)
    letters = lambda n: "".join(rng.choice(list("ABCDEFGHIKLMNOPRSTUVWabcdefghiknoprstu 0123456789"), n))
    grey, opaque = int(rng.choice([255, 235, 20])), float(rng.choice([1.0, 1.0, 0.6, 0.35]))

    def blend(image, mask, over, drawn):
        cv2.addWeighted(over, opaque, image, 1 - opaque, 0, image)
        mask |= drawn > 0

    def text(lines, x, y, scale, thick, box, changes):
        def draw(image, mask, k):
            over, drawn = image.copy(), np.zeros_like(image)
            for n, line in enumerate(lines):
                line = line + str(k // 3) if changes else line
                at = (x, y + int(n * 34 * scale))
                if box:
                    for target, value in ((over, 255 - grey), (drawn, 255)):
                        cv2.rectangle(
                            target,
                            (x - 4, at[1] - int(26 * scale)),
                            (x + int(19 * scale * len(line)), at[1] + 7),
                            value,
                            -1,
                        )
                for target, value in ((over, grey), (drawn, 255)):
                    cv2.putText(target, line, at, cv2.FONT_HERSHEY_SIMPLEX, scale, value, thick, cv2.LINE_AA)
            blend(image, mask, over, drawn)

        return draw

    if kind == "caption":
        lines = [letters(int(rng.integers(4, 26))) for _ in range(int(rng.choice([1, 2, 2, 4])))]
        y = int(rng.choice([rng.uniform(0.1, 0.25), rng.uniform(0.75, 0.93)]) * h)
        until = frames if rng.random() < 0.7 else int(rng.integers(2, frames))
        inner = text(
            lines,
            int(rng.uniform(5, 0.4 * w)),
            y,
            rng.uniform(0.35, 1.1),
            int(rng.integers(1, 4)),
            rng.random() < 0.3,
            False,
        )
        return [lambda image, mask, k: inner(image, mask, k) if k < until else None]
    if kind == "clock":
        return [
            text(
                [letters(3)],
                int(rng.uniform(5, 0.7 * w)),
                int(rng.choice([24, h - 12])),
                rng.uniform(0.4, 0.8),
                1,
                rng.random() < 0.5,
                True,
            )
        ]
    if kind == "hud":
        return [
            text(
                [letters(int(rng.integers(3, 10)))],
                int(rng.uniform(5, 0.7 * w)),
                int(rng.uniform(20, h - 8)),
                rng.uniform(0.3, 0.6),
                1,
                False,
                rng.random() < 0.3,
            )
            for _ in range(int(rng.integers(3, 9)))
        ]
    if kind == "bars":
        n = int(rng.integers(8, 56))
        side, both = int(rng.integers(2)), rng.random() < 0.85

        def bars(image, mask, k):
            for part in ((slice(None, n), slice(-n, None)) if both else (slice(-n, None),)):
                at = (part, slice(None)) if side else (slice(None), part)
                image[at] = 16
                mask[at] = True

        return [bars]
    if kind in ("logo", "inset", "cursor"):
        lh, lw = {
            "logo": (int(rng.integers(16, 60)), int(rng.integers(16, 80))),
            "inset": (int(rng.integers(40, 100)), int(rng.integers(50, 150))),
            "cursor": (12, 9),
        }[kind]
        picture = cv2.resize(
            rng.integers(0, 255, (lh // 8 + 2, lw // 8 + 2)).astype(np.uint8), (lw, lh), interpolation=cv2.INTER_CUBIC
        )
        inside = np.full((lh, lw), 255, np.uint8)
        if kind == "logo" and rng.random() < 0.6:
            picture[:] = grey
            inside = np.zeros((lh, lw), np.uint8)
            cv2.ellipse(
                inside, (lw // 2, lh // 2), (lw // 2 - 2, lh // 2 - 2), 0, 0, 360, 255, int(rng.choice([-1, 4]))
            )
            cv2.putText(inside, letters(2), (3, lh - 4), cv2.FONT_HERSHEY_SIMPLEX, lh / 40, 255, 2, cv2.LINE_AA)
        x, y = int(rng.choice([6, w - lw - 6])), int(rng.choice([6, h - lh - 6]))
        walk = (
            np.stack([smooth_walk(rng, frames + 1, rng.uniform(1, 6), 3) for _ in range(2)], 1)
            if kind == "cursor"
            else None
        )

        def logo(image, mask, k):
            cx, cy = (
                (x, y)
                if walk is None
                else (int(np.clip(w / 2 + walk[k, 0], 0, w - lw)), int(np.clip(h / 2 + walk[k, 1], 0, h - lh)))
            )
            a = cv2.convertScaleAbs(inside, alpha=opaque)
            to = image[cy : cy + lh, cx : cx + lw]
            to[:] = cv2.add(cv2.multiply(picture, a, scale=1 / 255), cv2.multiply(to, 255 - a, scale=1 / 255))
            mask[cy : cy + lh, cx : cx + lw] |= inside > 0

        return [logo]
    return []


class Noise:
    """Gaussian noise to cut from; made once."""

    def __init__(self, rng):
        fine = rng.normal(0, 1, (900, 900)).astype(np.float32)
        coarse = cv2.resize(
            rng.normal(0, 1.3, (450, 450)).astype(np.float32), (900, 900), interpolation=cv2.INTER_LINEAR
        )
        self.pictures = [fine, coarse]

    def cut(self, rng, size, coarse):
        y, x = rng.integers(900 - size[1]), rng.integers(900 - size[0])
        return self.pictures[int(coarse)][y : y + size[1], x : x + size[0]]


def sample(rng, film, noise):
    """One of the films that a film becomes: cut, reversed, degraded. Returns its pictures and, of each block, how much
    of it (moves by itself, is not judged, is the still scene, is graphics), of n × rows × columns × 4."""
    w, h = film.size
    n = len(film.frames)
    x, y = rng.integers(0, MARGIN_px + 1, 2)
    order = range(n - 1, -1, -1) if rng.random() < 0.4 else range(n)
    soft = rng.uniform(0.5, 3.5) if rng.random() < shares.DEFOCUS else 0
    contrast, lift = (rng.uniform(0.2, 1), rng.uniform(0, 60)) if rng.random() < shares.LOW_CONTRAST else (1, 0)
    gain = np.ones(n)
    if rng.random() < shares.EXPOSURE:
        gain += smooth_walk(rng, n, rng.uniform(0, 0.03), 2)
    if rng.random() < shares.FLICKER:
        gain += rng.normal(0, 0.03, n)
    sigma = rng.uniform(0, 1) * choose(rng, shares.NOISE)
    coarse = rng.random() < shares.COARSE_NOISE
    by_light = rng.random() < 0.3
    mjpeg = int(rng.integers(25, 92)) if rng.random() < shares.MJPEG else 0
    overlays = graphics(rng, film.size, n)
    rows, columns = h // BLOCK_px, w // BLOCK_px
    left, top = (w - columns * BLOCK_px) // 2, (h - rows * BLOCK_px) // 2
    pictures, labels = [], np.zeros((n, rows, columns, 4), np.float16)
    for j, k in enumerate(order):
        image = film.frames[k][y : y + h, x : x + w]
        owners = film.owners[k][y : y + h, x : x + w]
        if soft:
            image = cv2.GaussianBlur(image, (0, 0), soft)
        image = image.astype(np.float32) * (contrast * gain[j]) + lift * gain[j]
        if sigma:
            grain = sigma * noise.cut(rng, film.size, coarse)
            image += grain * np.sqrt(image / 128 + 0.2) if by_light else grain
        image = np.clip(image + 0.5, 0, 255).astype(np.uint8)
        mask = np.zeros((h, w), bool)
        for overlay in overlays:
            overlay(image, mask, j)
        if mjpeg:
            image = cv2.imdecode(
                cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, mjpeg])[1], cv2.IMREAD_GRAYSCALE
            )
        pictures.append(image)
        tables = np.zeros((3, 256), np.uint8)
        tables[0], tables[1], tables[2, 0] = 255 * film.moves[k], 255 * film.doubtful[k], 255
        inside = owners[top : top + rows * BLOCK_px, left : left + columns * BLOCK_px]
        covered = 255 * mask[top : top + rows * BLOCK_px, left : left + columns * BLOCK_px].astype(np.uint8)
        for channel in range(4):
            values = covered if channel == 3 else cv2.LUT(inside, tables[channel])
            if channel < 3 and overlays:
                values[covered > 0] = 0
            labels[j, :, :, channel] = cv2.resize(values, (columns, rows), interpolation=cv2.INTER_AREA) / np.float32(
                255
            )
    return pictures, labels


def coded(rng, films, size):
    """Films as a codec leaves them: all of them with one quality, each from a key frame on."""
    code = choose(rng, shares.CODE)
    if code == "none":
        return films
    n = films.shape[1]
    if code == "x264":
        options = [
            "-c:v",
            "libx264",
            "-preset",
            "superfast",
            "-crf",
            str(int(rng.integers(16, 38))),
            "-x264-params",
            f"keyint={n}:min-keyint={n}:scenecut=0:rc-lookahead=4",
        ]
    else:
        options = [
            "-c:v",
            "mpeg2video",
            "-q:v",
            str(int(rng.integers(2, 24))),
            "-g",
            str(n),
            "-sc_threshold",
            "1000000000",
        ]
    shape = f"{size[0]}x{size[1]}"
    quiet = ["ffmpeg", "-v", "error", "-threads", "1"]
    raw = ["-f", "rawvideo", "-pix_fmt", "yuv420p"]
    luma = films.reshape(-1, size[0] * size[1])
    colourless = np.full((len(luma), luma.shape[1] // 2), 128, np.uint8)
    pictures = np.concatenate([luma, colourless], 1)
    code = subprocess.run(
        [*quiet, *raw, "-s", shape, "-r", "24", "-i", "-", *options, "-threads", "1", "-f", "matroska", "-"],
        input=pictures.tobytes(),
        stdout=subprocess.PIPE,
        check=True,
    ).stdout
    back = subprocess.run([*quiet, "-i", "-", *raw, "-"], input=code, stdout=subprocess.PIPE, check=True).stdout
    return np.frombuffer(back, np.uint8).reshape(len(luma), -1)[:, : luma.shape[1]].reshape(films.shape)
