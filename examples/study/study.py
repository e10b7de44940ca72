#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The paper's experiment with people: which controller feels better, and what haptics add.

`run` asks for consent, for reasons to exclude the participant, and for a test of the emergency stop; then it plays
clips and asks. It goes on where this participant stopped. `report` prints shares, means and a sign test of all answers.
ANSWERS.csv.briefings keeps what was asked before, ANSWERS.csv.traces/ what was felt. docs/study.md says more.

Needs python3-gi, gir1.2-gstreamer-1.0 and python3-scipy, and GST_PLUGIN_PATH as in docs/start.md.
"""

import argparse
import signal
import sys
from contextlib import contextmanager
from pathlib import Path

from briefing import GENTLE_N, Stopped, TakesNoPart, ask, brief, read_line
from trials import COLUMNS, append_row, index_of, open_questions, read_answers, schedule, utc_now

PROPERTIES = {
    "linear": ["controller=linear"],
    "nonlinear": ["controller=nonlinear"],
    "without": ["controller=nonlinear", "mute=true"],  # the strings are taut but exert no force
    "with": ["controller=nonlinear"],
}


class Study:
    def __init__(self, options, properties):
        self.options = options
        self.extra = dict(question.split("=", 1) for question in options.question)
        self.properties = [f"max-force={GENTLE_N:g}", *properties]

    def player(self, clip, properties=()):
        from clip_player import ClipPlayer  # GStreamer takes a moment, and the report does not need it

        return ClipPlayer(clip, [*self.properties, *properties], self.options.headless)

    @contextmanager
    def taut(self):
        with self.player(self.options.clips[0], ["mute=true"]) as player:
            player.pause()
            yield

    def brief(self, device, force_N):
        is_simulated = device == "none" or device.startswith("sim")
        brief(self.options.answers + ".briefings", self.options.participant, force_N,
              None if is_simulated else self.taut)

    def trace_name(self, trial):
        """A name that no earlier trace has: a trial that was stopped is played again."""
        folder = Path(self.options.answers + ".traces")
        folder.mkdir(parents=True, exist_ok=True)
        name, again = f"{self.options.participant}-{trial.number}", ""
        while (folder / f"{name}{again}.csv").exists():
            again = f"-{int(again[1:] or 1) + 1}"
        return folder / (name + again)

    def run_trial(self, trial, questions):
        if read_line("return: play, q: stop here and go on another time > ") == "q":
            raise Stopped
        trace = self.trace_name(trial)
        traces = [f"trace={trace}.csv", f"haptic-trace={trace}.haptic.csv"]
        with self.player(trial.clip, PROPERTIES[trial.condition] + traces) as player:
            if not player.play():
                raise Stopped
        for name, text in questions.items():
            append_row(self.options.answers, COLUMNS,
                       [self.options.participant, trial.number, trial.part, trial.condition, trial.code, trial.clip,
                        name, ask(text), utc_now()])

    def run(self):
        options = self.options
        for clip in options.clips:  # all clips and properties are right before the first one is shown
            with self.player(clip) as player:
                device, force_N = player.filter.get_property("device"), player.filter.get_property("max-force")
        answers = read_answers(options.answers)
        trials = schedule(options.clips, index_of(answers, options.participant), options.seed)
        questions = open_questions(answers, options.participant, trials, self.extra)
        self.brief(device, force_N)
        for trial, still_open in zip(trials, questions):
            if still_open:
                print(f"\nclip {trial.number} of {len(trials)}, code {trial.code}")
                self.run_trial(trial, still_open)
        print("\nthat was all; thank you")


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    run = commands.add_parser(
        "run", usage="study.py run [option...] ANSWERS.csv PARTICIPANT CLIP... [-- name=value...]",
        epilog="name=value: properties of spidarmotion, the same for all clips. Without max-force the largest force is "
        f"{GENTLE_N:g} N, and more must be confirmed.")
    run.add_argument("answers", metavar="ANSWERS.csv")
    run.add_argument("participant", metavar="PARTICIPANT")
    run.add_argument("clips", metavar="CLIP", nargs="+")
    run.add_argument("--seed", type=int, default=1, help="another random order of clips; the same for all of a study")
    run.add_argument("--question", metavar="NAME=TEXT", action="append", default=[],
                     help="one more question after each clip, on the same five steps")
    run.add_argument("--headless", action="store_true", help="no window for the video")
    commands.add_parser("report").add_argument("answers", metavar="ANSWERS.csv")
    split = arguments.index("--") if "--" in arguments else len(arguments)
    options, properties = parser.parse_args(arguments[:split]), arguments[split + 1:]
    if options.command == "report":
        return options, properties
    if not options.participant or "/" in options.participant:
        parser.error(f'"{options.participant}" cannot be a part of a file name: give the participant a code')
    for question in options.question:
        if not all(question.partition("=")):
            parser.error(f"--question {question} is not NAME=TEXT")
    return options, properties


def main(arguments):
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl-C
    options, properties = parse(arguments)
    try:
        if options.command == "report":
            from report import report  # SciPy takes a moment

            answers = read_answers(options.answers)
            if not answers:
                raise ValueError(f"{options.answers}: there are no answers in it")
            print(report(answers))
        else:
            Study(options, properties).run()
    except (Stopped, KeyboardInterrupt):
        print("\nstopped; the same command goes on here")
    except TakesNoPart as reason:
        print(reason)
        return 1
    except (OSError, RuntimeError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2 if isinstance(error, ValueError) else 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
