# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Surfaces and outlines of the rendered world: parts of photographs of Debian's packages, and made ones.

textures.py BANK FOLDER...: collects the photographs and cut-outs below the folders into one file. A fifth of them, by
the hash of their names, is only for validation."""

import glob
import hashlib
import os
import sys

import cv2
import numpy as np

from shares import TEXTURE, choose

PHOTO_px, CUTOUT_px = 800, 200  # longest sides that are kept


def is_held(name):
    """Whether a photograph is never used in training."""
    return hashlib.sha256(name.encode()).digest()[0] % 5 == 0


def collect(bank, folders):
    entries = {}
    for folder in folders:
        for path in sorted(glob.glob(f"{folder}/**/*", recursive=True)):
            if not path.lower().endswith((".jpg", ".jpeg", ".png", ".webp")) or "screenshot" in path:
                continue
            image = cv2.imread(path, cv2.IMREAD_UNCHANGED)
            if image is None or image.dtype != np.uint8 or image.ndim != 3 or min(image.shape[:2]) < 60:
                continue
            name = os.path.basename(path)
            grey = cv2.cvtColor(image[..., :3], cv2.COLOR_BGR2GRAY)
            has_outline = image.shape[2] == 4 and (image[..., 3] < 128).mean() > 0.1
            longest = CUTOUT_px if has_outline else PHOTO_px
            scale = min(1, longest / max(grey.shape))
            small = lambda x: cv2.resize(x, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
            if has_outline:
                both = np.stack([small(grey), small(image[..., 3]), small(grey)], -1)
                code = cv2.imencode(".png", both)[1]
                entries[f"cutout/{name}"] = code
            elif os.path.getsize(path) > 60000:
                entries[f"photo/{name}"] = cv2.imencode(".webp", small(grey), [cv2.IMWRITE_WEBP_QUALITY, 82])[1]
    np.savez(bank, **entries)
    kinds = [name.split("/")[0] for name in entries]
    print(
        f"{kinds.count('photo')} photographs, {kinds.count('cutout')} cut-outs, {os.path.getsize(bank) / 2**20:.1f} MiB"
    )


class Bank:
    """The photographs and cut-outs of training, or those of validation."""

    def __init__(self, path, held):
        self.photos, self.cutouts = [], []
        with np.load(path) as entries:
            for name in entries.files:
                if is_held(name) != held:
                    continue
                image = cv2.imdecode(entries[name], cv2.IMREAD_COLOR)
                if name.startswith("photo/"):
                    self.photos.append(image[..., 0].copy())
                else:
                    self.cutouts.append((image[..., 0].copy(), image[..., 1].copy()))


def cloud(rng, h, w, slope):
    """Noise with a spectrum of 1 / f^slope, grey, of mean 128."""
    n = 1 << (max(h, w, 16) - 1).bit_length()
    n = min(n, 256)
    f = np.hypot(np.fft.fftfreq(n)[:, None], np.fft.rfftfreq(n)[None])
    f[0, 0] = 1
    z = np.fft.irfft2(np.fft.rfft2(rng.normal(size=(n, n))) / f**slope, (n, n))
    z = np.clip(128 + 45 * z / z.std(), 0, 255).astype(np.uint8)
    return cv2.resize(z, (w, h), interpolation=cv2.INTER_CUBIC) if (h, w) != (n, n) else z


def gradient(rng, h, w, most):
    a, b = rng.uniform(-most, most, 2)
    return (np.linspace(0, a, w)[None] + np.linspace(0, b, h)[:, None] + rng.uniform(20, 220)).astype(np.float32)


def pattern(rng, h, w):
    """Stripes, tiles or spots."""
    t = np.full((h, w), int(rng.integers(40, 200)), np.uint8)
    step, other, style = int(rng.integers(6, 60)), int(rng.integers(0, 255)), rng.integers(4)
    if style in (0, 2):
        for x in range(0, w, step):
            t[:, x : x + max(1, int(step * rng.uniform(0.1, 0.5)))] = other
    if style in (1, 2):
        for y in range(0, h, step):
            t[y : y + max(1, int(step * 0.3))] = other
    if style == 3:
        for _ in range(int(rng.integers(5, 80))):
            cv2.circle(
                t, (int(rng.integers(w)), int(rng.integers(h))), int(rng.integers(2, 20)), int(rng.integers(0, 255)), -1
            )
    return cv2.GaussianBlur(t, (0, 0), rng.uniform(0.5, 1.5))


def photo(rng, bank, h, w):
    """A part of a photograph; of several the one with most detail, because much of photographs is plain."""
    best = -1
    for _ in range(int(rng.choice([1, 2, 4]))):
        p = bank.photos[rng.integers(len(bank.photos))]
        most = min(p.shape[0] / h, p.shape[1] / w)
        zoom = min(most, max(0.4, rng.uniform(0.3, 1) * most))
        ch, cw = max(8, int(h * zoom)), max(8, int(w * zoom))
        y, x = rng.integers(p.shape[0] - ch + 1), rng.integers(p.shape[1] - cw + 1)
        crop = p[y : y + ch, x : x + cw]
        few = crop[:: max(1, ch // 48), :: max(1, cw // 64)].astype(np.int16)
        detail = np.minimum(np.abs(np.diff(few, axis=1)), 12).mean()
        if detail > best:
            best, chosen, by = detail, crop, zoom
    t = cv2.resize(chosen, (w, h), interpolation=cv2.INTER_AREA if by > 1 else cv2.INTER_CUBIC)
    return t[:, ::-1] if rng.random() < 0.5 else t


def texture(rng, bank, h, w, kinds=TEXTURE):
    """A surface of h × w grey levels."""
    kind = choose(rng, kinds)
    if kind == "plain":
        return np.full((h, w), int(rng.uniform(20, 235)), np.uint8)
    if kind == "shaded":
        return np.clip(gradient(rng, h, w, 90), 0, 255).astype(np.uint8)
    t = (
        cloud(rng, h, w, rng.uniform(0.5, 1.8))
        if kind == "cloud"
        else pattern(rng, h, w) if kind == "pattern" else photo(rng, bank, h, w)
    )
    mean = float(t.mean())
    contrast = rng.uniform(0.3, 1.25)
    return cv2.convertScaleAbs(
        np.ascontiguousarray(t), alpha=contrast, beta=np.clip(mean + rng.normal(0, 30), 15, 240) - contrast * mean
    )


def outline(rng, h, w, kind=None):
    """The alpha of a box, an ellipse, a blob or something ragged, 0 … 255."""
    a = np.zeros((h, w), np.uint8)
    kind = kind or choose(rng, {"box": 1, "ellipse": 1, "blob": 1.4, "ragged": 1})
    if kind == "box":
        a[2:-2, 2:-2] = 255
    elif kind == "ellipse":
        cv2.ellipse(a, (w // 2, h // 2), (max(w // 2 - 3, 1), max(h // 2 - 3, 1)), 0, 0, 360, 255, -1, cv2.LINE_AA)
    else:
        t = np.linspace(0, 2 * np.pi, 72, endpoint=False)
        r = np.ones_like(t)
        for k in range(2, 6 if kind == "blob" else 15):
            r += rng.normal(0, 0.35 / k if kind == "blob" else 0.12) * np.cos(k * t + rng.uniform(0, 6.3))
        r = np.clip(r, 0.2, None) / r.max()
        points = np.stack([w / 2 + (w / 2 - 3) * r * np.cos(t), h / 2 + (h / 2 - 3) * r * np.sin(t)], 1)
        cv2.fillPoly(a, [points.astype(np.int32)], 255, cv2.LINE_AA)
    return a


if __name__ == "__main__":
    collect(sys.argv[1], sys.argv[2:])
