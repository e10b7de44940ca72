# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What a study will do, as a text for a registry such as OSF or AsPredicted, before its first participant."""

from inference import MANY_CLIPS
from records import clips_of, digest_of
from trials import CONDITIONS, PAIRS, QUESTIONS, families


def text(settings, time_utc, code):
    """`settings`: as they are kept beside the answers, whose digest the text names; `time_utc`, `code`: of the chain."""
    analysis = settings["analysis"]
    pairs = {question: ", ".join(" against ".join(pair) for pair in PAIRS[part])
             for part, questions in QUESTIONS.items() for question in questions}
    primary, own = analysis["primary"], settings["questions"]["every clip"]
    everywhere = ", ".join(" against ".join(pair) for part in PAIRS.values() for pair in part)
    pairs |= dict.fromkeys(own, everywhere)
    named = dict.fromkeys([question for question, *_ in families(analysis)["secondary"]] + list(own))
    secondary = [name for name in named if name != primary]
    asked = {name: each for questions in settings["questions"].values() for name, each in questions.items()}
    lines = [
        "Hypothesis", f"{primary}: the answers differ between {pairs[primary]}.", "",
        "Design", "Within participants: everyone rates every clip in each condition: "
        + "; ".join(", ".join(conditions) for conditions in CONDITIONS.values())
        + f". Orders are balanced over multiples of twelve and drawn with the seed {settings['seed']}; only codes are shown.", "",
        "Sample", f"{settings['participants']} participants, {len(clips_of(settings))} clips.", "",
        "Measures, from bad (1) to very good (5)", *(f"{name}: {each}" for name, each in asked.items()), "",
        "Analysis", f"Of the differences, by this version's report: quasi-F over people and clips; below {MANY_CLIPS} clips, "
        f"t over people, of these clips; level {analysis['level']:g}, Holm's correction in each family.",
        f"Primary: {primary} ({pairs[primary]}).", f"Secondary: {', '.join(secondary) or 'none'}.",
        f"Equal within {analysis['margin_steps']:g} steps, by two one-sided tests: {', '.join(analysis['equal']) or 'none'}.", "",
        "Exclusions", *analysis["exclusions"], "",
        "Materials", f"gst-spidar {settings['version']}, device {settings['device']}"
        + (f" with profile {settings['profile']}" if settings["profile"] else "") + f", {' '.join(settings['properties'])}"
        + (f" alpha={settings['alpha_s_px']:g}" if settings["alpha_s_px"] is not None else ""),
        *(f"{clip}: SHA-256 {digest}" for clip, digest in settings["clips_sha256"].items()),
        f"Settings: SHA-256 {digest_of(settings)}; in the chain of digests at {time_utc}, whose code was then {code}"]
    return "\n".join(lines)
