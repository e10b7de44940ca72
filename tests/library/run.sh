#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Installs Slurm, Snakemake and what else the test needs (Debian, as root), and runs it.
#   tests/library/run.sh SPIDARTRACK SNAKEFILE
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source-path=SCRIPTDIR source=../../tests/install.sh
. "$here/../install.sh"
install_packages test library
exec /usr/bin/python3 "$here/test_library.py" "$@"
