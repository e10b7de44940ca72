#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Writes the reference of the GStreamer elements from the plugin itself: docs/elements.md and docs/elements/.

    meson devenv -C build python3 ../docs/elements.py

Units and meanings of messages, statistics and traces, which GObject does not know, are in docs/fields.toml; the fields
themselves are those of a film that this program plays. Needs PyGObject. With --check it writes nothing, and exits with
status 1 if a page is not what it would write."""
import argparse
import difflib
import json
import re
import sys
import tempfile
import tomllib
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
ASKED = ("`gst-inspect-1.0 --exists` asks for version 1.0, and the plugin has the version of the project: ask with "
         "`--atleast-version=0.1`.\n")
PRESETS = ("`spidarmotion` has the presets `paper`, `film` and `gentle` (`@preset=film` in a launch line, "
           "`gst_preset_load_preset()`), which set motion, controller, filter and gains. GStreamer finds "
           "them where its own data are, and in `GST_PRESET_PATH`. A preset replaces what the launch line sets, wherever it "
           "stands, but `max-force`. `spidar-feel`, `spidartrack` and `examples/play.sh` take `preset=film`.\n")
CHANGES = ("In brackets: default and range. A property can be changed while playing, unless it says *in READY* (only in the states "
           "NULL and READY) or *in NULL*: then a later change is refused with a warning. *Controllable*: a `GstControlSource` can "
           "drive it.\n")
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
    """What fields.toml says, and which of it has been used."""

    def __init__(self):
        with open(DOCS / "fields.toml", "rb") as file:
            tables = tomllib.load(file)
        self.tables = {name: table for name, table in tables.items() if name != "stats"}
        self.tables |= {f"stats.{name}": table for name, table in tables["stats"].items()}
        self.used = set()
        self.missing = []

    def row(self, table, name):
        """Unit and meaning."""
        if name not in self.tables[table]:
            self.missing.append(f"[{table}] {name}")
            return "", ""
        self.used.add((table, name))
        return self.tables[table][name]

    def wrong(self):
        rest = [f"[{table}] {name}" for table, rows in self.tables.items() for name in rows
                if (table, name) not in self.used]
        return [f"fields.toml does not describe {name}" for name in self.missing] + [
            f"fields.toml describes {name}, which no element has" for name in rest]


def fields_of(structure):
    """Name and type of each field, in their order."""
    names = [structure.nth_field_name(i) for i in range(structure.n_fields())]
    return {name: TYPES.get(structure.get_field_type(name).name, structure.get_field_type(name).name) for name in names}


def json_fields(value, prefix=""):
    """The names of the fields of a line of JSON, with those inside."""
    names = []
    for name, inside in value.items():
        if isinstance(inside, dict):
            names += json_fields(inside, f"{prefix}{name}.")
        elif isinstance(inside, list) and inside and isinstance(inside[0], dict):
            names += json_fields(inside[0], f"{prefix}{name}[].")
        else:
            names.append(prefix + name)
    return names


def play(pipeline):
    """Messages, by their names, and statistics of the element `m` while a pipeline plays: {name: type} of the fields of
    each."""
    playing = Gst.parse_launch(pipeline)
    bus, messages, stats = playing.get_bus(), {}, {}
    element = playing.get_by_name("m")
    playing.set_state(Gst.State.PLAYING)
    while True:
        message = bus.timed_pop_filtered(60 * Gst.SECOND, Gst.MessageType.ELEMENT | Gst.MessageType.EOS | Gst.MessageType.ERROR)
        if message is None or message.type == Gst.MessageType.ERROR:
            sys.exit(f"elements.py: this does not play: {pipeline}")
        if message.type == Gst.MessageType.EOS:
            break
        if message.src == element:
            found = message.get_structure()
            messages[found.get_name()] = messages.get(found.get_name(), {}) | fields_of(found)
    stats |= fields_of(element.get_property("stats"))
    playing.set_state(Gst.State.NULL)
    return messages, stats


def table(columns, rows):
    return ["| " + " | ".join(columns) + " |", "|---" * len(columns) + "|"] + ["| " + " | ".join(row) + " |" for row in rows]


def field_list(fields, where, names, types=None):
    """Neighbours of one meaning on one line."""
    rows = []
    for name in names:
        unit, meaning = fields.row(where, name)
        facts = ", ".join(filter(None, [types[name] if types else "", unit]))
        rows.append((f"`{name}`", f"{f' ({facts})' if facts else ''}: {meaning}"))
    return [f"- {', '.join(name for name, _ in alike)}{words}" for words, alike in groupby(rows, key=lambda row: row[1])]


def stats_lists(fields, stats, parts):
    """A list for each part of fields.toml; a field that none of them has belongs to the first."""
    lines = []
    for part, words in parts.items():
        others = {name for other in parts if other != part for name in fields.tables[other]}
        names = [name for name in stats if name in fields.tables[part] or (part == next(iter(parts)) and name not in others)]
        lines += ["", words, "", *field_list(fields, part, names, stats)]
    return lines


def shorter(columns):
    """Fields that differ only in an axis, a number or a quantile, as one with a star."""
    names = []
    for column in columns:
        name = re.sub(r"^(.*(?:force|torque|position|velocity))([_-])[xyz](?=[_-]|$)", r"\1\2*", column)
        name = re.sub(r"^orientation_[wxyz]$", "orientation_*", re.sub(r"^tension_\d+_N$", "tension_*_N", name))
        name = re.sub(r"^(.*)-(?:median|p\d+|max)$", r"\1-*", name)
        if name not in names:
            names.append(name)
    return names


def shorter_types(types):
    return {shorter([name])[0]: kind for name, kind in types.items()}


def observed(fields):
    """The sections that GObject does not know, by element. Objects and reasons depend on the film, so it is one in
    which an object moves, and the camera does not."""
    ball = "videotestsrc num-buffers=20 pattern=ball ! video/x-raw,width=320,height=240"
    with tempfile.TemporaryDirectory() as folder:
        csv, lines, ticks = (f"{folder}/{name}" for name in ("trace.csv", "trace.jsonl", "ticks.csv"))
        messages, stats = play(f"{ball} ! spidarmotion name=m trace={csv} haptic-trace={ticks} ! fakesink sync=true")
        more, touching = play(f"{ball} ! spidarmotion name=m touch=luma trace={lines} ! fakesink sync=true")
        # A film without motion has a reason.
        still, unfelt = play("videotestsrc num-buffers=5 pattern=black ! spidarmotion name=m ! fakesink sync=true")
        device, stats = messages["spidar-device"], stats | touching | unfelt
        messages = messages["spidar-motion"] | more["spidar-motion"] | still["spidar-motion"]
        track = "audiotestsrc num-buffers=2 wave=silence ! audio/x-raw,format=F32LE,rate=1000,channels=6,channel-mask=(bitmask)0x3f"
        _, track_stats = play(f"{track} ! spidarsink accept-unmarked=true name=m")
        header = Path(csv).read_text(encoding="utf-8").split("\n")[0].split(",")
        tick_header = Path(ticks).read_text(encoding="utf-8").split("\n")[0].split(",")
        objects = [json.loads(line) for line in Path(lines).read_text(encoding="utf-8").splitlines()]
    fullest = max((json_fields(line) for line in objects), key=len)
    messages, stats, track_stats = (shorter_types(types) for types in (messages, stats, track_stats))
    haptic = ["", "## Columns of `haptic-trace`", "",
              "One line for each millisecond. A star stands for an axis, or for the number of a string.", "",
              *field_list(fields, "haptic-trace", shorter(tick_header))]
    motion = ["", "## Messages", "", "With `post-messages`, an element message `spidar-motion` for each frame, when it is analysed: "
              "before a queue up to a second before it is shown. Use it at its `running-time`, as "
              "[motion_messages.py](../../examples/motion_messages.py) and [gtk_arrow.py](../../examples/gtk_arrow.py) do. "
              "A star stands for x, y and z:", "",
              *field_list(fields, "message", messages, messages), "",
              "When the device is opened, cannot be opened, is lost or comes back, an element message `spidar-device`. The codes "
              "of the warning or error that goes with it are `NOT_FOUND`, `BUSY`, `NOT_AUTHORIZED`, `SETTINGS` (its name, "
              "its profile, its firmware) or `OPEN_READ_WRITE` of `GST_RESOURCE_ERROR`, and `WRITE` when it is lost:", "",
              *field_list(fields, "device-message", device, device), "", "## Fields of `stats`",
              *stats_lists(fields, stats, {"stats.video": "Of the video:", "stats.device": "Of the device, while there is one:"}),
              "", "## Columns of `trace`", "", "CSV, one line for each frame:", "", *field_list(fields, "trace", shorter(header)),
              "", "JSON, one line for each frame, if the name ends in `.jsonl`; lists of two or three numbers are vectors:", "",
              *field_list(fields, "json", fullest), *haptic]
    of_track = {name: kind for name, kind in track_stats.items() if name not in fields.tables["stats.device"]}
    sink = ["", "## Messages", "", "Those of [spidarmotion](spidarmotion.md#messages); `spidar-motion` for each 40 ms of the track, "
            "whose file is `track`, or where there is none, the name of the element.",
            "", "## Fields of `stats`", *stats_lists(fields, of_track, {"stats.track": "Of the track:"}), "",
            "Of the device: those of [spidarmotion](spidarmotion.md#fields-of-stats).", "",
            "## Columns of `haptic-trace`", "", "Those of [spidarmotion](spidarmotion.md#columns-of-haptic-trace)."]
    return {"spidarmotion": motion, "spidarsink": sink}


def describe(name):
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
    if own:
        lines += ["", "## Properties", "", CHANGES]
    for spec in sorted(own, key=lambda spec: spec.name):
        if spec.value_type.is_a(GObject.TYPE_ENUM):
            element.get_property(spec.name)
        lines += property_lines(spec)
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
    written, rows = {}, []
    for name in ELEMENTS:
        if Gst.ElementFactory.find(name) is None:
            sys.exit(f"elements.py: the element {name} was not found; is GST_PLUGIN_PATH set?")
    sections = observed(fields)
    for name in ELEMENTS:
        lines = describe(name)
        lines += sections.get(name, [])
        written[f"elements/{name}.md"] = "\n".join(lines).rstrip("\n") + "\n"
        rows.append([f"[{name}](elements/{name}.md)", Gst.ElementFactory.find(name).get_metadata("description") + "."])
    written["elements.md"] = "\n".join([
        "# Elements", "", WRITTEN, *table(["element", "what it does"], rows), "", ASKED, PRESETS.rstrip("\n"), ""])
    return written


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    Gst.init(None)
    fields = Fields()
    written = pages(fields)
    wrong = fields.wrong()
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
