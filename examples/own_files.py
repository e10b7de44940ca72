# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""No program writes over a file that it reads."""

import os


def require_other(output, *inputs):
    """Raises ValueError if the file to be written is one of those that are read, under whatever name or link."""
    for each in inputs:
        if os.path.exists(each) and os.path.exists(output) and os.path.samefile(output, each):
            raise ValueError(f"{output}: is {each}, which is read, and nothing is written over it; name another file")
