#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Makes the site of the pages in BUILD/site, with the reference of the public headers in BUILD/site/api. A warning is an
# error. `meson compile -C build docs` runs it.
#   site.sh SOURCE BUILD
set -eu
source=$1
build=$2
for program in doxygen sphinx-build; do
    if ! command -v "$program" >/dev/null; then
        echo "error: $program is not installed. The site needs, in Debian's names: doxygen python3-sphinx" \
            "python3-myst-parser, and for its theme furo" >&2
        exit 1
    fi
done
rm -rf "$build/site"
mkdir -p "$build/site/api"
doxygen "$build/Doxyfile"
sphinx-build -b html -W --keep-going -q -c "$source/docs" -d "$build/doctrees" "$source" "$build/site"
cat >"$build/site/index.html" <<'END'
<!DOCTYPE html><meta charset="utf-8"><title>gst-spidar</title>
<meta http-equiv="refresh" content="0; url=docs/README.html"><a href="docs/README.html">gst-spidar</a>
END
# A page that loads something from the net would not work without it.
if grep -rnE '<(script|link|img)[^>]*(src|href)="(https?:)?//' "$build/site" --include='*.html' |
    grep -v 'rel="canonical"'; then
    echo "error: the pages above load something from the net" >&2
    exit 1
fi
echo "the site: $build/site/index.html"
