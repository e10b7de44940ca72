#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Writes the reference of the GStreamer elements from the plugin itself: docs/elements.md and docs/elements/.

    meson devenv -C build python3 ../docs/elements.py

The fields of messages, statistics and traces, which GObject does not know, are those that tests/docs/print_fields
prints from the rows they are made of. Needs PyGObject. With --check it writes nothing, and exits with
status 1 if a page is not what it would write."""
import argparse
import difflib
import subprocess
import sys
from itertools import groupby
from pathlib import Path

try:
    import gi
except ImportError:
    print("skipped: needs PyGObject (python3-gi)", file=sys.stderr)
    sys.exit(77)

gi.require_version("Gst", "1.0")
from gi.repository import GObject, Gst  # noqa: E402

ELEMENTS = ("spidarmotion", "spidarextract", "spidarsink")
DOCS = Path(__file__).resolve().parent
WRITTEN = "Written by `docs/elements.py` from the plugin; a test compares the two.\n"
ASKED = "Add `--atleast-version=0.1` to `gst-inspect-1.0 --exists`, which otherwise asks for version 1.0.\n"
PRESETS = ("`spidarmotion` has the presets `paper`, `film` and `gentle` (`@preset=film` in a launch line, `preset=film` for "
           "`spidar-feel`, `spidartrack` and `examples/play.sh`), which set motion, controller, filter and gains. GStreamer "
           "finds them where its own data are, and in `GST_PRESET_PATH`. A preset replaces what the launch line sets, except "
           "`max-force`.\n")
CHANGES = ("In brackets: default and range. A property can be changed while playing, unless it says *in READY* (only in the states "
           "NULL and READY) or *in NULL*. *Controllable*: a `GstControlSource` can drive it.\n")
TYPES = {"gchararray": "string", "gdouble": "double", "gboolean": "boolean", "guint64": "uint64", "guint": "uint",
         "gint": "int", "gint64": "int64", "GstValueArray": "array"}


def value_text(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:g}"
    if value is None or value == "":
        return "none"
    return str(value)


def enum_values(spec):
    """The values of an enum property, by number. PyGObject knows them once it has read such a property."""
    return spec.value_type.pytype.__enum_values__


def default_text(spec):
    if not spec.flags & GObject.ParamFlags.WRITABLE:
        return ""
    if spec.value_type.is_a(GObject.TYPE_ENUM):
        return enum_values(spec)[int(spec.default_value)].value_nick
    return value_text(spec.default_value)


def range_text(spec):
    """The values that a property takes."""
    if hasattr(spec, "minimum"):
        powers = {-(2**63): "-2⁶³", 2**63 - 1: "2⁶³ − 1", 2**64 - 1: "2⁶⁴ − 1", 2**31 - 1: "2³¹ − 1",
                  -(2**31): "-2³¹", 2**32 - 1: "2³² − 1"}

        def limit(value):
            if isinstance(value, float) and abs(value) > 1e300:
                return "∞" if value > 0 else "-∞"
            return powers.get(value, value_text(value))

        return f"{limit(spec.minimum)} … {limit(spec.maximum)}".replace("-", "−")
    return ""


def access_text(spec):
    if not spec.flags & GObject.ParamFlags.WRITABLE:
        return "read-only"
    if spec.flags & Gst.PARAM_CONTROLLABLE:
        return "controllable"
    if spec.flags & Gst.PARAM_MUTABLE_PLAYING:
        return ""
    return "in READY" if spec.flags & Gst.PARAM_MUTABLE_READY else "in NULL"


def property_lines(spec):
    """An item of a list, with the values of an enumeration below it."""
    default = default_text(spec)
    facts = [default, range_text(spec), access_text(spec)]
    blurb = " ".join(spec.blurb.split())
    lines = [f"- `{spec.name}` ({', '.join(fact for fact in facts if fact)}): {blurb}"]
    if spec.value_type.is_a(GObject.TYPE_ENUM):
        lines += [f"  - `{value.value_nick}`: {value.value_name}" for value in enum_values(spec).values()]
    return lines


class Fields:
    """The rows that print_fields prints."""

    def __init__(self, program):
        self.lists, self.seen = {}, set()
        for line in subprocess.run([program], check=True, capture_output=True, encoding="utf-8").stdout.splitlines():
            name, *row = line.split("\t")
            self.lists.setdefault(name, []).append(row)

    def items(self, name, without=()):
        """A list of the fields, neighbours of one meaning on one line, and those that the message has on the last one."""
        rows, again = [], []
        for key, label, facts, meaning in self.lists[name]:
            if [key, label, facts, meaning] in without:
                continue
            if name != "message" and (key, meaning) in self.seen:
                again.append(f"`{label}`")
                continue
            self.seen.add((key, meaning))
            facts = facts.removeprefix("uint64").removeprefix(", ")
            rows.append((f"`{label}`", f"{facts and f' ({facts})'}: {meaning}"))
        lines = [f"- {', '.join(label for label, _ in alike)}{words}" for words, alike in groupby(rows, key=lambda row: row[1])]
        return lines + ([f"- {', '.join(again)}: as in the message"] if again else [])


def table(columns, rows):
    return ["| " + " | ".join(columns) + " |", "|---" * len(columns) + "|"] + ["| " + " | ".join(row) + " |" for row in rows]


def field_sections(fields):
    """The sections that GObject does not know, by element."""
    motion = ["", "## Messages", "", "With `post-messages`, an element message `spidar-motion` for each frame, when it is analysed: up "
              "to a second before a queue shows it. Use it at its `running-time`, as "
              "[motion_messages.py](../../examples/motion_messages.py) does. A star stands for x, y and z, and a field without "
              "a type is a uint64:", "",
              *fields.items("message"), "",
              "When the device is opened, refused, lost or back, an element message `spidar-device`. The codes of "
              "the warning or error that goes with it are `NOT_FOUND`, `BUSY`, `NOT_AUTHORIZED`, `SETTINGS` (its name, "
              "its profile, its firmware) or `OPEN_READ_WRITE` of `GST_RESOURCE_ERROR`, and `WRITE` when it is lost:", "",
              *fields.items("device-message"), "", "## Fields of `stats`",
              "", "Of the video:", "", *fields.items("stats", without=fields.lists["stats.device"]),
              "", "Of the device, while there is one:", "", *fields.items("stats.device"),
              "", "## Columns of `trace`", "", "CSV, one line for each frame:", "", *fields.items("trace"),
              "", "JSON, one line for each frame, if the name ends in `.jsonl`; lists of two or three numbers are vectors:", "",
              *fields.items("json"), "", "## Columns of `haptic-trace`", "",
              "One line for each millisecond. A star stands for an axis, or for the number of a string.", "",
              *fields.items("haptic-trace")]
    sink = ["", "## Messages", "", "Those of [spidarmotion](spidarmotion.md#messages); `spidar-motion` for each 40 ms of the track, "
            "whose file is `track`, or where there is none, the name of the element.",
            "", "## Fields of `stats`", "", "Of the track:", "", *fields.items("stats.track"), "",
            "Of the device: those of [spidarmotion](spidarmotion.md#fields-of-stats).", "",
            "## Columns of `haptic-trace`", "", "Those of [spidarmotion](spidarmotion.md#columns-of-haptic-trace)."]
    return {"spidarmotion": motion, "spidarsink": sink}


def describe(name, described):
    """A page without its fields. `described`: the properties that the pages before it have, which are not described again."""
    factory = Gst.ElementFactory.find(name)
    element = factory.create(None)
    lines = [f"# {name}", "", WRITTEN, f"{factory.get_metadata('description')}.", "", "## Pads", ""]
    # The factory lists them in another order when the registry has just been written.
    templates = sorted(factory.get_static_pad_templates(),
                       key=lambda template: (template.direction != Gst.PadDirection.SINK, template.name_template))
    for template in templates:
        caps = template.get_caps()
        kinds = sorted({caps.get_structure(i).get_name() for i in range(caps.get_size())})
        if caps.is_any():
            kinds = ["any"]
        lines.append(f"- `{template.name_template}`: {template.direction.value_nick}, "
                     f"{', '.join(f'`{kind}`' for kind in kinds)}")
    own = [spec for spec in element.list_properties() if spec.owner_type == element.__gtype__]
    items = {}
    for spec in sorted(own, key=lambda spec: spec.name):
        if spec.value_type.is_a(GObject.TYPE_ENUM):
            element.get_property(spec.name)
        items[spec.name] = property_lines(spec)
    if own:
        known = ", ".join(f"`{key}`" for key, item in items.items() if item in described)
        lines += ["", "## Properties", "", CHANGES if not described else
                  f"Written as [those of spidarmotion](spidarmotion.md#properties), which also describe {known}.\n"]
        lines += [line for item in items.values() if item not in described for line in item]
        described += items.values()
    signals = [GObject.signal_query(signal, element.__gtype__) for signal in GObject.signal_list_names(element.__gtype__)]
    if signals:
        lines += ["", "## Signals", ""]
    for signal in signals:
        kind = "action" if signal.signal_flags & GObject.SignalFlags.ACTION else "notification"
        arguments = ", ".join(TYPES.get(of.name, of.name) for of in signal.param_types)
        lines.append(f"- `{signal.signal_name}` ({kind}): {arguments} → {TYPES.get(signal.return_type.name, signal.return_type.name)}")
    return lines


def pages(fields):
    """Text by file name."""
    written, rows, described = {}, [], []
    for name in ELEMENTS:
        if Gst.ElementFactory.find(name) is None:
            sys.exit(f"elements.py: the element {name} was not found; is GST_PLUGIN_PATH set?")
    sections = field_sections(fields)
    for name in ELEMENTS:
        lines = describe(name, described)
        lines += sections.get(name, [])
        written[f"elements/{name}.md"] = "\n".join(lines).rstrip("\n") + "\n"
        rows.append([f"[{name}](elements/{name}.md)", Gst.ElementFactory.find(name).get_metadata("description") + "."])
    written["elements.md"] = "\n".join([
        "# Elements", "", WRITTEN, *table(["element", "what it does"], rows), "", ASKED, PRESETS.rstrip("\n"), ""])
    return written


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--fields", default="tests/docs/print_fields", help="the program; default: that of the build folder it runs in")
    options = parser.parse_args()
    Gst.init(None)
    written, wrong = pages(Fields(options.fields)), []
    for name, text in written.items():
        path = DOCS / name
        if not options.check:
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
        elif (committed := path.read_text(encoding="utf-8") if path.exists() else "") != text:
            sys.stderr.writelines(difflib.unified_diff(committed.splitlines(True), text.splitlines(True), name, "the plugin"))
            wrong.append(f"docs/{name} does not describe the plugin; write it again, see elements.py")
    if wrong:
        sys.exit("".join(f"elements.py: {line}\n" for line in wrong))


if __name__ == "__main__":
    main()
