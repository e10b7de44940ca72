#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Makes BUILD/report.pdf from docs/report.md and the pages that it names. `meson compile -C build report` runs it.
#   report.sh SOURCE BUILD
set -eu
source=$1
build=$2
for program in sphinx-build weasyprint; do
    if ! command -v "$program" >/dev/null; then
        echo "error: $program is not installed. The report needs, in Debian's names: python3-sphinx" \
            "python3-myst-parser weasyprint" >&2
        exit 1
    fi
done
rm -rf "$build/report"
# Links to pages that are not part of the report are left as text.
sphinx-build -b singlehtml -q -c "$source/docs" -d "$build/report-doctrees" -D root_doc=docs/report \
    -D html_theme=basic -D include_patterns="docs/report.md,docs/method.md,docs/results.md,docs/bibliography.md" \
    -D suppress_warnings=ref.myst "$source" "$build/report"
cat >"$build/report/print.css" <<'END'
@page { size: A4; margin: 22mm 20mm; @bottom-center { content: counter(page); font-size: 9pt; } }
body { font: 10pt/1.35 serif; }
h1, h2, h3 { font-family: sans-serif; line-height: 1.2; break-after: avoid; }
h1 { font-size: 16pt; } h2 { font-size: 12pt; } h3 { font-size: 10.5pt; }
table { border-collapse: collapse; font-size: 8.5pt; } th, td { padding: 1px 6px; border-bottom: .5px solid #999; }
pre { font-size: 8.5pt; break-inside: avoid; } img { max-width: 100%; }
.headerlink, .sphinxsidebar, .related, .footer { display: none; }
END
weasyprint -q -s "$build/report/print.css" "$build/report/docs/report.html" "$build/report.pdf"
echo "the report: $build/report.pdf"
