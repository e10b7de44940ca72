#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The network of core/motion/learned/block_network in PyTorch. `network.py FILE [WEIGHTS.pt [NOTE...]]`
writes the C++ header with its weights, random ones if none are given; each NOTE is a line of its comment: where
the weights come from."""

import copy
import sys

import torch
import torch.nn.functional as F
from torch import nn

IN, HIDDEN, STATE, LAST, OUT = 44, 24, 16, 16, 3
DILATIONS = (1, 2, 4)
PADDED_OUT = 8  # outputs that a vector holds

# The check that header() writes.
CHECK_FRAMES, CHECK_ROWS, CHECK_COLUMNS = 4, 5, 7


def around(h, weight, bias, apart):
    """Three by three blocks, each channel by itself; h: B, rows, columns, channels."""
    y = F.conv2d(h.permute(0, 3, 1, 2), weight, bias, padding=apart, dilation=apart, groups=h.shape[-1])
    return y.permute(0, 2, 3, 1)


class Net(nn.Module):
    """Blocks are rows of matrices, which is fast on processors."""

    def __init__(self):
        super().__init__()
        self.first = nn.Linear(IN, HIDDEN)
        self.deep = nn.ModuleList([nn.Conv2d(HIDDEN, HIDDEN, 3, groups=HIDDEN) for _ in DILATIONS])
        self.flat = nn.ModuleList([nn.Linear(HIDDEN, HIDDEN) for _ in DILATIONS])
        self.whole = nn.Linear(2 * HIDDEN, HIDDEN)
        self.gate = nn.Linear(HIDDEN + STATE, STATE)
        self.news = nn.Linear(HIDDEN + STATE, STATE)
        self.spread = nn.Conv2d(STATE, STATE, 3, groups=STATE)
        self.last = nn.Linear(HIDDEN + STATE, LAST)
        self.answer = nn.Linear(LAST, OUT)

    def look(self, x):
        """What each block of one picture shows; x: B, rows, columns, IN."""
        h = F.relu(self.first(x))
        for k, (deep, flat) in enumerate(zip(self.deep, self.flat)):
            h = h + F.relu(flat(around(h, deep.weight, deep.bias, DILATIONS[k])))
            if k == 1:
                whole = torch.cat([h.mean((1, 2)), h.amax((1, 2))], 1)
                h = h + F.relu(self.whole(whole))[:, None, None]
        return h

    def remember(self, h, origin, known):
        """The memory of each block, which moves along with its content; h: B, N, blocks, HIDDEN."""
        both = torch.cat([self.gate.weight, self.news.weight])
        bias = torch.cat([self.gate.bias, self.news.bias])
        of_h = F.linear(h, both[:, :HIDDEN], bias)
        state = h.new_zeros(h.shape[0], h.shape[2], STATE)
        states = []
        for k, of_picture in enumerate(of_h.unbind(1)):
            is_known = known[:, k, None, None]
            state = torch.gather(state, 1, origin[:, k, :, None].expand(-1, -1, STATE)) * is_known
            gate, news = (of_picture + F.linear(state, both[:, HIDDEN:])).split(STATE, -1)
            state = (state + torch.sigmoid(gate) * (torch.tanh(news) - state)) * is_known
            states.append(state)
        return torch.stack(states, 1)

    def memory(self, x, origin, known):
        """What each block shows and what is remembered of it: B, N, rows, columns, HIDDEN + STATE."""
        batch, frames, rows, columns = x.shape[:4]
        h = self.look(x.flatten(0, 1))
        s = self.remember(h.reshape(batch, frames, rows * columns, HIDDEN), origin, known)
        s = s.reshape(batch * frames, rows, columns, STATE)
        s = s + around(s, self.spread.weight, self.spread.bias, 1)
        return torch.cat([h, s], -1).reshape(batch, frames, rows, columns, HIDDEN + STATE)

    def forward(self, x, origin, known, with_memory=False):
        """Logits, B, N, rows, columns, OUT: moves by itself, may vote for the camera, belongs to the screen.

        x: B, N, rows, columns, IN; origin, int64: B, N, rows · columns; known, 1 or 0: B, N. With
        `with_memory`: (logits, memory())."""
        memory = self.memory(x, origin, known)
        logits = self.answer(F.relu(self.last(memory)))
        return (logits, memory) if with_memory else logits


def check_inputs():
    """The same as in tests/core/test_block_network.cpp: features, origins."""
    blocks = CHECK_ROWS * CHECK_COLUMNS
    k = torch.arange(CHECK_FRAMES * blocks * IN, dtype=torch.float64)
    x = torch.sin(0.37 * k + 0.001 * (k % 101) ** 2).float()
    i = torch.arange(CHECK_FRAMES)[:, None] * 3 + torch.arange(blocks)[None] * 5
    x = x.reshape(1, CHECK_FRAMES, CHECK_ROWS, CHECK_COLUMNS, IN)
    return x, (i % blocks).reshape(1, CHECK_FRAMES, blocks)


def written(value):
    """A weight as it is written."""
    text = f"{value:.5g}"
    return text if "." in text or "e" in text else text + ".0"


def array(name, rows):
    lines = ",\n".join("    " + ", ".join(written(v) + "f" for v in row) for row in rows.tolist())
    return f"alignas(32) constexpr float {name}[] = {{\n{lines}}};\n"


def rounded(net):
    """The network with its weights as they are written."""
    result = copy.deepcopy(net).cpu().float().eval()
    with torch.no_grad():
        for weights in result.parameters():
            flat = [float(written(v)) for v in weights.flatten().tolist()]
            weights.copy_(torch.tensor(flat).reshape(weights.shape))
    return result


def header(net, path, notes=()):
    """Writes the weights, input by input, and what the network answers to check_inputs()."""
    net = rounded(net)
    parts = []

    def layer(name, weight, bias):
        parts.append(array(f"k{name}", weight) + array(f"k{name}Bias", bias[None]))

    def taps(conv):
        return conv.weight[:, 0].permute(1, 2, 0).reshape(9, -1)

    with torch.no_grad():
        layer("First", net.first.weight.T, net.first.bias)
        for k, (deep, flat) in enumerate(zip(net.deep, net.flat)):
            layer(f"Deep{k}", taps(deep), deep.bias)
            layer(f"Flat{k}", flat.weight.T, flat.bias)
        layer("Whole", net.whole.weight.T, net.whole.bias)
        layer("GateAndNews", torch.cat([net.gate.weight, net.news.weight]).T, torch.cat([net.gate.bias, net.news.bias]))
        layer("Spread", taps(net.spread), net.spread.bias)
        layer("LastLayer", net.last.weight.T, net.last.bias)
        padding = (0, PADDED_OUT - OUT)
        layer("Answer", F.pad(net.answer.weight.T, padding), F.pad(net.answer.bias, padding))
        x, origin = check_inputs()
        answers = torch.sigmoid(net(x, origin, torch.ones(1, CHECK_FRAMES)))
        check = array("kAnswers", answers.reshape(CHECK_FRAMES, -1))
    with open(path, "w", encoding="utf-8") as file:
        file.write(
            "// SPDX-License-Identifier: LGPL-2.1-or-later\n// Copyright 2026 the gst-spidar authors\n"
            "// clang-format off\n// Written by core/motion/world/network.py: edit that.\n"
            + "".join(f"// {note}\n" for note in notes)
            + "#pragma once\n\n"
            "namespace spidar::network_weights {\n\n"
            f"constexpr int kIn = {IN}, kHidden = {HIDDEN}, kState = {STATE}, kLast = {LAST}, kOut = {OUT},\n"
            f"              kPaddedOut = {PADDED_OUT};\n" + "".join(parts) + "\n"
            "/// What PyTorch answers, see tests/core/test_block_network.cpp.\nnamespace check {\n"
            f"constexpr int kFrames = {CHECK_FRAMES}, kRows = {CHECK_ROWS}, kColumns = {CHECK_COLUMNS};\n"
            + check
            + "}  // namespace check\n\n}  // namespace spidar::network_weights\n"
        )


def main():
    torch.manual_seed(1)
    net = Net()
    if len(sys.argv) > 2:
        net.load_state_dict(torch.load(sys.argv[2], map_location="cpu"))
    header(net, sys.argv[1], sys.argv[3:])


if __name__ == "__main__":
    main()
