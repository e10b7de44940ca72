#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""train.py TRAIN VALIDATION OUT [--seeds 1,2,3] [--batch N] [--steps N] [--seconds S]: trains the network on what
samples.py has left in TRAIN, once for each seed, from nothing; writes OUT/SEED.pt, and prints how it does on
VALIDATION. On a GPU if there is one; the seeds then share the data and run at the same time."""

import argparse
import copy
import glob
import time
import zipfile
from multiprocessing.pool import ThreadPool

import numpy as np
import torch
import torch.nn.functional as F

from network import IN, Net

FRAMES_TOGETHER = 14  # of a clip that counts as one of a batch
RATE = 4e-3
AVERAGED = 0.998  # weight of the past in the average of the weights
FIRST_FRAMES = 3  # of a clip, in which the memory is still empty
# Inputs that change sign when left and right, or up and down, change places.
SIGN_X = [0, 2, 4, 12, 21, 34, 36]
SIGN_Y = [1, 3, 5, 12, 22, 34, 37]
TEXTURE, PIXELS = 10, 15  # inputs: texture of the block; how much better its own motion fits than the camera's
LITTLE_TEXTURE, LITTLE_EVIDENCE = 0.3, 0.3


class Clips:
    """All clips of one size and length: x B, N, rows, columns, IN; y B, N, rows, columns, 4; origin B, N, blocks;
    known B, N; only for validation: flags and kinds."""

    def __init__(self, paths, count, shape, device, pool, validates):
        frames, rows, columns = shape
        make = lambda *sizes, dtype: torch.empty(count, frames, *sizes, dtype=dtype, device=device)
        self.x = make(rows, columns, IN, dtype=torch.float16)
        self.y = make(rows, columns, 4, dtype=torch.float16)
        self.origin = make(rows * columns, dtype=torch.int16)
        self.known = make(dtype=torch.float32)
        self.flags, self.kinds = [None] * len(paths), [None] * len(paths)
        each = count // len(paths)

        def read(n):
            with np.load(paths[n]) as z:
                to = slice(n * each, (n + 1) * each)
                self.x[to] = torch.from_numpy(z["x"]).reshape(each, frames, rows, columns, IN)
                self.y[to] = torch.from_numpy(z["y"])
                self.origin[to] = torch.from_numpy(z["origin"])
                self.known[to] = torch.from_numpy(z["known"].astype(np.float32))
                if validates:
                    self.flags[n], self.kinds[n] = z["flags"].reshape(each, *shape), z["kinds"]

        list(pool.map(read, range(len(paths))))
        self.flags, self.kinds = (np.concatenate(a) if validates else None for a in (self.flags, self.kinds))

    def __len__(self):
        return len(self.x)


def load(folder, device, validates):
    """The clips in a folder, by their size and length."""
    groups = {}
    with ThreadPool() as pool:
        paths = sorted(glob.glob(f"{folder}/*.npz"))
        for path, shape in zip(paths, pool.map(shape_of, paths)):
            groups.setdefault(shape, []).append(path)
        return [
            Clips(paths, len(paths) * shape[0], shape[1:4], device, pool, validates)
            for shape, paths in sorted(groups.items())
        ]


def shape_of(path):
    with zipfile.ZipFile(path) as z, z.open("y.npy") as y:
        np.lib.format.read_magic(y)
        return np.lib.format.read_array_header_1_0(y)[0]


def targets(x, y):
    """What each output should be, and how much that counts: B, N, rows, columns, 3 each."""
    moving, doubtful, still, graphics = y.unbind(-1)
    one, zero = torch.ones_like(moving), torch.zeros_like(moving)
    t_moves = (moving >= 0.3).float()
    # A plain block moves as the little of an object that it shows: only what shows none is at rest.
    w_moves = torch.where((moving >= 0.3) | ((moving < 0.005) & (doubtful < 0.1)), one, zero)
    # Where there is nothing to see, only what is around tells: it counts less.
    w_moves = w_moves * torch.where(shows_nothing(x), 0.2 * one, one)
    area = (t_moves * w_moves).sum((2, 3), keepdim=True)  # a block of a small object counts more
    w_moves = w_moves * torch.where(t_moves > 0.5, torch.clamp(30 / torch.clamp(area, min=3), 0.5, 4), one)
    t_votes = (still >= 0.9).float()
    w_votes = torch.where((still >= 0.9) | (still < 0.5), one, zero)
    t_graphics = (graphics >= 0.3).float()
    w_graphics = torch.where((graphics >= 0.3) | (graphics < 0.02), one, zero)
    return torch.stack([t_moves, t_votes, t_graphics], -1), torch.stack([w_moves, 0.3 * w_votes, 0.3 * w_graphics], -1)


def shows_nothing(x):
    return (x[..., TEXTURE] < LITTLE_TEXTURE) & (x[..., PIXELS].abs() < LITTLE_EVIDENCE)


def mirrored(x, y, origin, rng):
    rows, columns = x.shape[2:4]
    if rng.random() < 0.5:
        sign = x.new_ones(IN)
        sign[SIGN_X] = -1
        x, y = x.flip(3) * sign, y.flip(3)
        o = origin.reshape(*x.shape[:4]).flip(3)
        origin = (o - o % columns + (columns - 1 - o % columns)).flatten(2)
    if rng.random() < 0.15:
        sign = x.new_ones(IN)
        sign[SIGN_Y] = -1
        x, y = x.flip(2) * sign, y.flip(2)
        o = origin.reshape(*x.shape[:4]).flip(2)
        origin = ((rows - 1 - o // columns) * columns + o % columns).flatten(2)
    return x, y, origin


def learn(seed, sets, batch, steps, seconds, out, device):
    torch.manual_seed(seed)
    rng = np.random.default_rng(seed)
    net = Net().to(device)
    average = copy.deepcopy(net)
    optimizer = torch.optim.AdamW(net.parameters(), lr=RATE, weight_decay=1e-4)
    frames = np.array([len(s) * s.x.shape[1] for s in sets], float)
    begin, step = time.monotonic(), 0
    while True:
        done = max(step / steps, (time.monotonic() - begin) / seconds)
        if done >= 1:
            break
        for group in optimizer.param_groups:
            group["lr"] = RATE * min(1, (step + 1) / 100) * (0.5 * (1 + np.cos(np.pi * done)) + 0.005)
        clips = sets[rng.choice(len(sets), p=frames / frames.sum())]
        count = max(2, min(len(clips), batch * FRAMES_TOGETHER // clips.x.shape[1]))
        i = torch.from_numpy(rng.choice(len(clips), count, replace=False)).to(device)
        x, y, origin = mirrored(clips.x[i].float(), clips.y[i].float(), clips.origin[i].long(), rng)
        known = clips.known[i]
        t, w = targets(x, y)
        w = (
            w
            * known[:, :, None, None, None]
            * torch.clamp(torch.arange(x.shape[1], device=device) / FIRST_FRAMES, 0, 1)[None, :, None, None, None]
        )
        logits = net(x, origin, known)
        loss = (F.binary_cross_entropy_with_logits(logits, t, reduction="none") * w).sum() / w[..., 0].sum()
        optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(net.parameters(), 1.0)
        optimizer.step()
        with torch.no_grad():
            kept = min(AVERAGED, step / (step + 10))
            for a, b in zip(average.parameters(), net.parameters()):
                a.lerp_(b, 1 - kept)
        step += 1
        if step % 500 == 0:
            print(f"seed {seed}, step {step}, {time.monotonic() - begin:.0f} s: loss {loss.item():.4f}", flush=True)
    print(f"seed {seed}: {step} steps in {time.monotonic() - begin:.0f} s", flush=True)
    torch.save({k: v.cpu() for k, v in average.state_dict().items()}, f"{out}/{seed}.pt")


@torch.no_grad()
def answers(net, sets):
    """Of the blocks that are judged: probability to move, truth, what the rules say, its film's kinds."""
    ps, ts, rules, kinds = [], [], [], []
    for clips in sets:
        for i in range(0, len(clips), 32):
            b = slice(i, i + 32)
            x, y, known = clips.x[b].float(), clips.y[b].float(), clips.known[b]
            p = torch.sigmoid(net(x, clips.origin[b].long(), known)[..., 0])
            t, w = targets(x, y)
            judged = (w[..., 0] > 0) & ~shows_nothing(x) & (known[:, :, None, None] > 0)
            judged[:, :FIRST_FRAMES] = False
            judged = judged.cpu().numpy()
            ps.append(p.cpu().numpy()[judged])
            ts.append(t[..., 0].cpu().numpy()[judged] > 0.5)
            rules.append((clips.flags[b][judged] & 1) > 0)
            kinds.append(np.repeat(clips.kinds[b], judged.reshape(len(judged), -1).sum(1)))
    return (np.concatenate(a) for a in (ps, ts, rules, kinds))


def validation(net, sets):
    """A table of the shares of moving blocks found / of the others falsely found, by the network where 1 % of all
    others are, and by the rules."""
    p, t, rules, kinds = answers(net, sets)

    def row(title, found, judged=np.ones(len(p), bool)):
        shares = [f"{of[m & judged].mean():.4f}" if (m & judged).any() else "-" for of in found for m in (t, ~t)]
        return f"  {title:20s} {shares[0]} / {shares[1]}   rules {shares[2]} / {shares[3]}"

    def at_false_share(share):
        return float(np.quantile(p[~t], 1 - share))

    least = at_false_share(0.01)
    lines = [
        f"probability {least:.3f} on",
        row("all", (p > least, rules)),
        row("at .5", (p > 0.5, rules)),
        row("at the rules' share", (p > at_false_share(rules[~t].mean()), rules)),
    ]
    names, number = np.unique(kinds, return_inverse=True)
    words = np.array([name.split() for name in names])
    for column, title in enumerate(("camera", "scene", "objects")):
        for word in sorted(set(words[:, column])):
            lines.append(row(f"{title} {word}", (p > least, rules), (words[:, column] == word)[number]))
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("train")
    parser.add_argument("validation")
    parser.add_argument("out")
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--batch", type=int, default=64, help="clips")
    parser.add_argument("--steps", type=int, default=20000)
    parser.add_argument("--seconds", type=float, default=1e9)
    arguments = parser.parse_args()
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    begin = time.monotonic()
    sets, held = load(arguments.train, device, False), load(arguments.validation, device, True)
    weights = sum(p.numel() for p in Net().parameters())
    read_s = time.monotonic() - begin
    print(
        f"{sum(map(len, sets))} clips, {sum(map(len, held))} held back, {weights} weights; read in {read_s:.0f} s",
        flush=True,
    )
    seeds = [int(s) for s in arguments.seeds.split(",")]
    rest = (sets, arguments.batch, arguments.steps, arguments.seconds, arguments.out, device)
    if device.type == "cuda":
        context = torch.multiprocessing.get_context("spawn")
        workers = [context.Process(target=learn, args=(seed, *rest)) for seed in seeds]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
    else:
        for seed in seeds:
            learn(seed, *rest)
    for seed in seeds:
        net = Net().to(device)
        net.load_state_dict(torch.load(f"{arguments.out}/{seed}.pt"))
        print(f"seed {seed}: {validation(net, held)}", flush=True)


if __name__ == "__main__":
    main()
