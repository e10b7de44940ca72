#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Makes films with the true motion of their object, for real_films.py, from the frames of a data set.

  truth.py FOLDER OUT [--fps 24] [--clips real_films/clips.tsv]

FOLDER holds sequences in either of two layouts, at any depth (links to folders are not followed):
  masks, as in DAVIS: JPEGImages/[480p/]NAME/*.jpg and Annotations/[480p/]NAME/*.png, a mask for each
    frame, where every value but 0 is the object;
  boxes, as in OTB and VOT: NAME/img/*.jpg (or imgs, or NAME/*.jpg) and NAME/groundtruth*.txt, a line
    for each frame with x, y, width, height, or the corners x1, y1, x2, y2, ….
For each sequence, OUT gets the film NAME.mkv, its frames as they are, and NAME.csv: lines `frame,x,y`,
the motion of the object against the background since the frame before, in pixels of the film. With --clips, OUT
gets those of the table that FOLDER has, under names that do not tell what moves: their frames, cut as it says. Pictures
that are not those of the table are named.

The motion is measured twice: by Lucas-Kanade on corners of the object, and by the centre of its mask or
box, smoothed over three frames. Each is taken against a homography that is fitted robustly to corners
outside. Where the mask is cut off by the border or changes by more than 15 % in area, the centre says
nothing, and the corners count alone if they agree with each other. A frame is left out where the two
disagree, or where the homography explains less than 60 % of the corners. Needs ffmpeg and
python3-opencv."""

import argparse
import csv
import hashlib
import re
import subprocess
import sys
from pathlib import Path

try:
    import cv2
    import numpy as np
except ImportError:
    sys.exit("truth.py: needs OpenCV for Python (python3-opencv), for the interpreter that runs it")

LINES = 480  # lengths below are in px of a frame of so many lines
MARGIN_PX = 12  # around the mask, as what is close to its edge belongs to neither side
AGREE_PX, AGREE_SHARE = 0.8, 0.35  # how far the two measurements may differ
ALONE_PX, ALONE_SHARE = 0.5, 0.3  # median deviation of the corners from their median
LEAST_INLIERS = 0.6
MOST_GROWTH = 0.15  # of the area in a frame, as a logarithm
LEAST_CORNERS = 12  # on the object
LEAST_OUTSIDE = 40
PICTURES = {".jpg", ".jpeg", ".png"}


def pictures_of(folder):
    return sorted(f for f in folder.iterdir() if f.suffix.lower() in PICTURES) if folder.is_dir() else []


def find_sequences(folder):
    """Name, frames and a list of masks or an array of boxes of each sequence."""
    for annotations in sorted(folder.rglob("Annotations")):
        images = annotations.parent / "JPEGImages"
        for inside in sorted({f.parent for f in annotations.rglob("*.png")}):
            frames = pictures_of(images / inside.relative_to(annotations))
            masks = pictures_of(inside)
            if not frames:
                print(f"truth.py: {inside}: there are no frames for these masks in {images}", file=sys.stderr)
            elif len(frames) != len(masks):
                print(f"truth.py: {inside}: {len(masks)} masks for {len(frames)} frames", file=sys.stderr)
            else:
                name = inside.name if inside != annotations else annotations.parent.name
                yield name, frames, masks
    for truth in sorted(folder.rglob("groundtruth*.txt")):
        home = truth.parent
        frames = pictures_of(home / "img") or pictures_of(home / "imgs") or pictures_of(home)
        boxes = read_boxes(truth)
        if frames and abs(len(frames) - len(boxes)) <= 2:
            yield home.name, frames[: len(boxes)], boxes[: len(frames)]
        else:
            print(f"truth.py: {truth}: {len(boxes)} boxes for {len(frames)} frames", file=sys.stderr)


def read_boxes(file):
    """Corners of the box around each line's numbers."""
    boxes = []
    for line in file.read_text().splitlines():
        values = [float(v) for v in re.split(r"[,\s]+", line.strip()) if v]
        if len(values) == 4:
            x, y, width, height = values
            boxes.append((x, y, x + width, y + height))
        elif len(values) >= 6:
            boxes.append((min(values[0::2]), min(values[1::2]), max(values[0::2]), max(values[1::2])))
    return np.array(boxes)


class Objects:
    """Where the object is: `mask(n)` of the frame, `centre(n)` and `area(n)` of what it is measured by."""

    def __init__(self, given, size):
        self.given, self.size = given, size
        self.is_box = isinstance(given, np.ndarray)
        self.known = {}

    def mask(self, n):
        if n not in self.known:
            height, width = self.size
            if self.is_box:
                mask = np.zeros((height, width), np.uint8)
                x0, y0, x1, y1 = np.round(self.given[n]).astype(int)
                mask[max(y0, 0):max(y1, 0), max(x0, 0):max(x1, 0)] = 255
            else:
                mask = cv2.imread(str(self.given[n]), cv2.IMREAD_UNCHANGED)
                mask = mask.max(axis=2) if mask.ndim == 3 else mask
                mask = cv2.resize((mask > 0).astype(np.uint8) * 255, (width, height),
                                  interpolation=cv2.INTER_NEAREST)
            self.known = {k: v for k, v in self.known.items() if k == n - 1}
            self.known[n] = mask
        return self.known[n]

    def centre_and_area(self, n):
        """Nothing where the border cuts it off."""
        mask = self.mask(n)
        if self.is_box:
            x0, y0, x1, y1 = self.given[n]
            cut_off = x0 < 1 or y0 < 1 or x1 > self.size[1] - 1 or y1 > self.size[0] - 1
            return None if cut_off or x1 <= x0 or y1 <= y0 else ((x0 + x1) / 2, (y0 + y1) / 2, (x1 - x0) * (y1 - y0))
        if any(edge.any() for edge in (mask[0], mask[-1], mask[:, 0], mask[:, -1])) or not mask.any():
            return None
        m = cv2.moments(mask, True)
        return m["m10"] / m["m00"], m["m01"] / m["m00"], m["m00"]

    def inside(self, n):
        """What certainly shows the object: a box also contains what is behind it."""
        mask = self.mask(n)
        if not self.is_box:
            return mask
        x0, y0, x1, y1 = self.given[n]
        part = np.zeros_like(mask)
        dx, dy = (x1 - x0) / 5, (y1 - y0) / 5
        part[max(int(y0 + dy), 0):max(int(y1 - dy), 0), max(int(x0 + dx), 0):max(int(x1 - dx), 0)] = 255
        return part


def follow(before, now, mask, count):
    """Corners of `before` and where they are in `now`: those that return to within half a pixel."""
    corners = cv2.goodFeaturesToTrack(before, count, 0.005, 5, mask=mask)
    if corners is None:
        return np.empty((0, 2)), np.empty((0, 2))
    window = {"winSize": (15, 15), "maxLevel": 4}
    there, found, _ = cv2.calcOpticalFlowPyrLK(before, now, corners, None, **window)
    back, returned, _ = cv2.calcOpticalFlowPyrLK(now, before, there, None, **window)
    good = (found[:, 0] > 0) & (returned[:, 0] > 0) & (np.linalg.norm(corners - back, axis=2)[:, 0] < 0.5)
    return corners[good, 0], there[good, 0]


def moved_by(homography, points):
    return cv2.perspectiveTransform(np.asarray(points, np.float64).reshape(-1, 1, 2), homography)[:, 0]


def smooth(values):
    """With a Gaussian of one frame, over those that are known; a gap stays where little is known."""
    kernel = np.exp(-0.5 * np.arange(-3, 4) ** 2.0)
    known = ~np.isnan(values[:, 0])
    weight = np.convolve(known.astype(float), kernel, "same")
    sums = [np.convolve(np.where(known, values[:, j], 0), kernel, "same") for j in (0, 1)]
    return np.where(weight[:, None] > 1.2, np.stack(sums, 1) / np.maximum(weight, 1e-9)[:, None], np.nan)


def measure(frames, objects, unit):
    """Motion of the object in each frame, NaN where it is not certain."""
    n = len(frames)
    by_corners, by_centre = np.full((n, 2), np.nan), np.full((n, 2), np.nan)
    certain, alone = np.zeros(n, bool), np.zeros(n, bool)
    around = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (int(2 * MARGIN_PX * unit) + 1,) * 2)
    before = gray_of(frames[0])
    for i in range(1, n):
        now = gray_of(frames[i])
        inside, was = objects.inside(i - 1), objects.centre_and_area(i - 1)
        outside = 255 - cv2.dilate(objects.mask(i - 1), around)
        here = objects.centre_and_area(i)
        a, b = follow(before, now, outside, 600)
        if len(a) >= LEAST_OUTSIDE:
            homography, inliers = cv2.findHomography(a, b, cv2.USAC_MAGSAC, unit)
            if homography is not None:
                certain[i] = inliers.mean() > LEAST_INLIERS
                p, q = follow(before, now, inside, 200)
                if len(p) >= LEAST_CORNERS:
                    relative = q - moved_by(homography, p)
                    by_corners[i] = np.median(relative, axis=0)
                    apart = np.median(np.linalg.norm(relative - by_corners[i], axis=1))
                    alone[i] = apart < ALONE_SHARE * np.linalg.norm(by_corners[i]) + ALONE_PX * unit
                if was and here and abs(np.log(here[2] / was[2])) < MOST_GROWTH:
                    by_centre[i] = here[:2] - moved_by(homography, [was[:2]])[0]
        before = now
    by_centre = smooth(by_centre)
    size = np.fmax(np.linalg.norm(by_centre, axis=1), np.linalg.norm(by_corners, axis=1))
    apart = np.linalg.norm(by_centre - by_corners, axis=1)
    agree = certain & (apart < np.fmax(AGREE_PX * unit, AGREE_SHARE * size))
    alone &= certain & np.isnan(by_centre[:, 0])
    either = np.where(alone[:, None], by_corners, np.nan)
    return np.where(agree[:, None], (by_centre + by_corners) / 2, either)


def gray_of(file):
    return cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)


def make_film(frames, film, fps, crop=None):
    """The frames as they are, if they are JPEG; a cut, and other frames, are coded without loss."""
    jpeg = all(f.suffix.lower() in (".jpg", ".jpeg") for f in frames)
    coding = ["-c", "copy"] if jpeg and not crop else ["-c:v", "ffv1", "-pix_fmt", "yuv420p"]
    if crop:
        coding = ["-vf", "crop={2}:{3}:{0}:{1}".format(*crop), *coding]
    subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", str(fps), "-i", "-",
                    *coding, film], check=True, input=b"".join(f.read_bytes() for f in frames))


def write_film(name, frames, given, arguments, has_object=True, crop=None):
    """The film, and its truth if it has an object."""
    make_film(frames, arguments.out / f"{name}.mkv", arguments.fps, crop)
    if has_object:
        size = gray_of(frames[0]).shape
        motion = measure(frames, Objects(given, size), size[0] / LINES)
        known = [n for n in range(len(frames)) if not np.isnan(motion[n, 0])]
        lines = [f"{n},{motion[n, 0]:.3f},{motion[n, 1]:.3f}\n" for n in known]
        (arguments.out / f"{name}.csv").write_text("".join(lines))
        print(f"{name}: {len(frames)} frames, motion known in {len(known)}")


def write_clips(sequence, frames, given, arguments):
    """Those of the table."""
    with open(arguments.clips, encoding="utf-8", newline="") as table:
        rows = [row for row in csv.DictReader(table, delimiter="\t") if row["sequence"] == sequence]
    for row in rows:
        if "-" not in row["frames"]:
            print(f"{row['film']}: which {row['frames']} frames of {sequence} it has is not known")
            continue
        first, last = map(int, row["frames"].split("-"))
        part = slice(first - 1, last)
        crop = None if row["crop"] == "-" else tuple(int(row["crop"].split(":")[n]) for n in (2, 3, 0, 1))
        digest = hashlib.sha256(b"".join(frame.read_bytes() for frame in frames[part])).hexdigest()
        if row["sha256"] not in ("-", digest[:16]):
            print(f"{row['film']}: the pictures of {sequence} are not those of {arguments.clips}")
        write_film(row["film"], frames[part], given[part], arguments, row["moves"] == "object", crop)


def main():
    parser = argparse.ArgumentParser(usage="truth.py FOLDER OUT [--fps 24] [--clips TABLE]")
    parser.add_argument("folder", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--fps", type=float, default=24)
    parser.add_argument("--clips", type=Path)
    arguments = parser.parse_args()
    if not arguments.folder.is_dir():
        sys.exit(f"truth.py: {arguments.folder} is not a folder")
    arguments.out.mkdir(parents=True, exist_ok=True)
    made = 0
    for name, frames, given in find_sequences(arguments.folder):
        made += 1
        (write_clips if arguments.clips else write_film)(name, frames, given, arguments)
    if made == 0:
        sys.exit(f"truth.py: {arguments.folder} has neither Annotations with masks nor groundtruth*.txt with boxes")


if __name__ == "__main__":
    main()
