#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Writes the reference of the GStreamer elements, docs/elements.md, from the plugin itself.

    meson devenv -C build python3 ../docs/elements.py > docs/elements.md

Needs PyGObject. With --check FILE it compares instead, and exits with status 1 if FILE is not what
it would write."""
import argparse
import difflib
import sys

try:
    import gi
except ImportError:
    print("skipped: needs PyGObject (python3-gi)", file=sys.stderr)
    sys.exit(77)

gi.require_version("Gst", "1.0")
from gi.repository import GObject, Gst  # noqa: E402

ELEMENTS = ("spidarmotion", "spidarextract", "spidarsink", "spidardepth")

INTRODUCTION = """# Elements

For people who build pipelines. This page is written by `docs/elements.py` from the plugin, as
`gst-inspect-1.0` shows it, and a test compares the two. "Since" is the version of gst-spidar that had the
property first.
"""

# Of properties that came later than their element: (element, property): version.
SINCE = {}
FIRST_VERSION = "0.1"


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
    if spec.value_type.is_a(GObject.TYPE_ENUM):
        return ", ".join(value.value_nick for value in enum_values(spec).values())
    if spec.value_type == GObject.TYPE_BOOLEAN:
        return "true, false"
    if hasattr(spec, "minimum"):
        powers = {-(2**63): "-2⁶³", 2**63 - 1: "2⁶³ − 1", 2**64 - 1: "2⁶⁴ − 1", 2**31 - 1: "2³¹ − 1",
                  -(2**31): "-2³¹", 2**32 - 1: "2³² − 1"}

        def limit(value):
            if isinstance(value, float) and abs(value) > 1e300:
                return "∞" if value > 0 else "-∞"
            return powers.get(value, value_text(value))

        return f"{limit(spec.minimum)} … {limit(spec.maximum)}".replace("-", "−")
    return ""


def flags_text(spec):
    flags = []
    if not spec.flags & GObject.ParamFlags.WRITABLE:
        flags.append("read-only")
    if spec.flags & Gst.PARAM_CONTROLLABLE:
        flags.append("controllable")
    if spec.flags & Gst.PARAM_MUTABLE_PLAYING:
        flags.append("changeable in PLAYING")
    elif spec.flags & Gst.PARAM_MUTABLE_READY:
        flags.append("changeable in READY")
    return ", ".join(flags)


def describe(name):
    factory = Gst.ElementFactory.find(name)
    if factory is None:
        return []
    element = factory.create(None)
    lines = [f"## {name}", "", f"{factory.get_metadata('description')}.", "",
             f"Class: `{factory.get_metadata('klass')}`. Parent: `{GObject.type_name(GObject.type_parent(element.__gtype__))}`.",
             "", "### Pads", "", "| pad | direction | presence | caps |", "|---|---|---|---|"]
    # The factory lists them in another order when the registry has just been written.
    templates = sorted(factory.get_static_pad_templates(),
                       key=lambda template: (template.direction != Gst.PadDirection.SINK, template.name_template))
    for template in templates:
        caps = template.get_caps()
        kinds = sorted({caps.get_structure(i).get_name() for i in range(caps.get_size())})
        if caps.is_any():
            kinds = ["any"]
        lines.append(f"| `{template.name_template}` | {template.direction.value_nick} | "
                     f"{template.presence.value_nick} | {', '.join(f'`{kind}`' for kind in kinds)} |")
    own = [spec for spec in element.list_properties() if spec.owner_type == element.__gtype__]
    if own:
        lines += ["", "### Properties", "", "| property | default | values | access | since | meaning |",
                  "|---|---|---|---|---|---|"]
    for spec in sorted(own, key=lambda spec: spec.name):
        if spec.value_type.is_a(GObject.TYPE_ENUM):
            element.get_property(spec.name)
        blurb = " ".join(spec.blurb.split()).replace("|", "\\|")
        lines.append(f"| `{spec.name}` | {default_text(spec)} | {range_text(spec)} | {flags_text(spec)} | "
                     f"{SINCE.get((name, spec.name), FIRST_VERSION)} | {blurb} |")
    for spec in sorted(own, key=lambda spec: spec.name):
        if spec.value_type.is_a(GObject.TYPE_ENUM):
            lines += ["", f"Values of `{spec.name}`:", ""]
            lines += [f"- `{value.value_nick}`: {value.value_name}"
                      for value in enum_values(spec).values()]
    return lines + [""]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--check", metavar="FILE")
    options = parser.parse_args()
    Gst.init(None)
    page = "\n".join([INTRODUCTION] + [line for name in ELEMENTS for line in describe(name)])
    page = page.rstrip("\n") + "\n"
    if "## spidarmotion" not in page:
        sys.exit("elements.py: the element spidarmotion was not found; is GST_PLUGIN_PATH set?")
    if options.check is None:
        sys.stdout.write(page)
        return
    with open(options.check, encoding="utf-8") as file:
        committed = file.read()
    if committed != page:
        sys.stderr.writelines(difflib.unified_diff(committed.splitlines(True), page.splitlines(True),
                                                   options.check, "the plugin"))
        sys.exit(f"elements.py: {options.check} does not describe the plugin; write it again, see elements.py")


if __name__ == "__main__":
    main()
