#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Renders the world and trains the network, from nothing:
#   core/motion/world/train.sh [FOLDER [BATCHES [STEPS]]]
# FOLDER (build/world) gets the photographs of Debian's packages, the samples and the weights; what is there already is not
# made again. It ends with a table of what each of the three seeds finds in films that it has not seen.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
# shellcheck source-path=SCRIPTDIR source=../../../tests/install.sh
. tests/install.sh
install_packages build world

work=$(mkdir -p "${1:-build/world}" && realpath "${1:-build/world}")
batches=${2:-1500} # of 24 samples
steps=${3:-20000}  # of 64 samples
world=core/motion/world
# The first number of a seed that is never used in training.
held=1000000

if [[ ! -f $work/bank.npz ]]; then
    mkdir -p "$work/packages"
    for package in plasma-workspace-wallpapers mate-backgrounds lomiri-wallpapers-16.04 lomiri-wallpapers-20.04 \
        gnome-backgrounds ukui-wallpapers python3-skimage tuxpaint-stamps-default; do
        (cd "$work/packages" && apt-get -qq download "$package" && dpkg -x "$package"_*.deb photographs)
    done
    /usr/bin/python3 $world/textures.py "$work/bank.npz" "$work/packages/photographs"
fi
[[ -f build/build.ninja ]] || meson setup build
ninja -C build core/motion-features
features=$PWD/build/core/motion-features

# Its buffers are large; malloc would give each back to the system, and fetch it again.
export OPENBLAS_NUM_THREADS=1 MALLOC_MMAP_THRESHOLD_=8589934592 MALLOC_TRIM_THRESHOLD_=17179869184
/usr/bin/python3 $world/samples.py "$work/bank.npz" "$features" "$work/held" $held $((held + 60)) --held
/usr/bin/python3 $world/samples.py "$work/bank.npz" "$features" "$work/samples" 0 "$batches"
/usr/bin/python3 $world/train.py "$work/samples" "$work/held" "$work" --steps "$steps"
echo "to use the weights of seed 1: $world/network.py core/motion/learned/block_network_weights.h $work/1.pt" \
    "'Seed 1, world $(cat $world/*.py | sha256sum | cut -c 1-12), $batches batches, $steps steps.'"
