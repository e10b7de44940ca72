# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The report of the Snakefile beside this: a row for each film, those that failed first."""
import html
import json
import os
from pathlib import Path
from urllib.parse import quote

HEAD = """<!doctype html><meta charset="utf-8"><title>Haptic tracks</title>
<style>body{font:15px sans-serif;margin:2em}td,th{padding:.3em .8em;text-align:left;vertical-align:top}
tr{border-bottom:1px solid #ccc}table{border-collapse:collapse}img{width:32em}.failed{background:#fdd}</style>
"""


def row(line, folder):
    if line["result"] == "failed":
        return f'<tr class="failed"><td>{html.escape(line["film"])}<td colspan="4">{html.escape(line["error"])}\n'
    track = os.path.relpath(line["track"], folder)
    remark = html.escape(line.get("warning", ""))
    return (f'<tr><td>{html.escape(line["film"])}<br>{remark}<td>{line["duration_s"]:.0f} s<td>{line["felt"]:.0%}'
            f'<td>{line["largest_force_N"]:.1f} N<td><img loading="lazy" src="{quote(track)}.png" alt="">\n')


def write_report(names, output):
    # A job that was tried again appends; the last line counts. In JSON, U+2028 ends none.
    lines = [json.loads(Path(name).read_text(encoding="utf-8").rstrip("\n").split("\n")[-1]) for name in names]
    failed = [line for line in lines if line["result"] == "failed"]
    hours = sum(line.get("duration_s", 0) for line in lines) / 3600
    lines.sort(key=lambda line: (line["result"] != "failed", line["film"]))
    with open(output, "w", encoding="utf-8") as page:
        page.write(f"{HEAD}<h1>{len(lines)} films, {hours:.1f} hours, {len(failed)} failed</h1>\n<table>\n"
                   "<tr><th>film<th>length<th>felt<th>largest force<th>force over time\n")
        page.writelines(row(line, Path(output).parent) for line in lines)
        page.write("</table>\n")


write_report(snakemake.input, snakemake.output[0])  # noqa: F821, defined by Snakemake
