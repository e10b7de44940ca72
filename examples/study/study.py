#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The paper's experiment with people: which controller feels better, and what haptics add.

`plan` says how many participants an effect needs, and `design` in what the conditions differ for some clips. `run`
asks for consent, for reasons to exclude the participant, and for a test of the emergency stop; then it plays clips
and asks. It goes on where this participant stopped. `register` fixes what `run` will do, and prints that for a
registry. `threshold` measures what a participant tells apart at least. `report` prints shares, means and what differs,
`export` writes a folder for R and others, and `withdraw` removes a participant. docs/study.md says more.

Needs python3-gi, gir1.2-gstreamer-1.0, gir1.2-gst-plugins-base-1.0 and python3-scipy, and GST_PLUGIN_PATH as in
docs/start.md.
"""

import os
import platform
import signal
import sys
import time
from contextlib import contextmanager, nullcontext
from dataclasses import asdict
from pathlib import Path

import chain
import perception
from briefing import GENTLE_N, Stopped, TakesNoPart, ask, brief, debrief, describe, read_line
from options import parse
from chain import utc_now
from records import (COLUMNS, PRESENTATION_COLUMNS, THRESHOLD_COLUMNS, Participants, append_row, clips_of, digest_of_file, names_of_clips,
                     read_answers, read_merged, read_rows, read_settings, require_same, write_settings)
from trials import CONDITIONS, QUESTIONS, Trial, analysis_of, open_questions, schedule

sys.path.append(str(Path(__file__).resolve().parents[1]))
from own_files import require_other  # noqa: E402

PRACTISED = ("with", "without")  # what a participant may expect at most and at least
ATTEMPTS = 3  # presentations of a trial whose force is not delivered, before somebody has to look for the cause


class Study:
    """GStreamer takes a moment, and not every command needs it: this class does."""

    def __init__(self, options, properties):
        import clip_player
        import preview

        self.options, self.clip_player, self.preview = options, clip_player, preview
        self.output = "headless" if options.headless else "window"
        self.streams = self.open_streams() if options.lsl else None
        self.extra = dict(question.split("=", 1) for question in options.question)
        asked = {name for questions in QUESTIONS.values() for name in questions} | set(self.extra)
        if options.primary not in asked:
            raise ValueError(f"--primary {options.primary} is not asked: give one of {', '.join(sorted(asked))}")
        self.analysis = analysis_of(options.primary)
        self.properties = [f"max-force={GENTLE_N:g}", *(preview.PAPER if options.paper else []), *properties]
        files = options.clips + [options.practice] * bool(options.practice)
        for file in files:  # all clips and properties are right before the first one is shown
            clip_player.uri_of(file)
            require_other(options.answers, file)
        self.old = read_settings(options.answers) if options.answers else None
        names, self.digests = names_of_clips(files, (self.old or {}).get("clips_sha256", {}))
        self.files = {name: file for file, name in names.items()}
        self.practice = names.get(options.practice, "")
        filter_ = clip_player.make_filter(self.properties)
        self.device, self.profile, self.limit_N = (
            filter_.get_property(name) for name in ("device", "profile", "max-force"))

    @staticmethod
    def open_streams():
        import lsl

        return lsl.Streams(lsl.load(), platform.node())

    def mark(self, text):
        if self.streams:
            self.streams.mark(text, time.monotonic_ns())

    def measure(self, name, alphas, progress):
        return self.preview.measure(self.files[name], self.properties, self.limit_N, not self.options.paper, alphas, progress)

    def design(self):
        """For each clip and alpha, what differs, and the alpha to take. Raises ValueError if too little differs."""
        is_given = self.options.paper or any(each.startswith("alpha=") for each in self.properties)
        clips = [name for name in self.files if name != self.practice]
        progress = self.preview.Progress(clips)
        found = {name: self.measure(name, [None] if is_given else self.preview.ALPHAS_S_PX, progress) for name in clips}
        if self.options.command == "design":
            print(self.preview.table(found))
        return found, self.preview.choose(found, self.options.accept_alike)

    def settings(self, alpha):
        """With what the study is made; all that must stay the same. A file is known by its content, wherever it is."""
        profile = Path(self.profile or "")
        return {
            "version": self.clip_player.plugin_version(), "host": platform.node(), "seed": self.options.seed,
            "participants": self.options.participants or (self.old or {}).get("participants"),
            "paper": self.options.paper, "properties": [each for each in self.properties if not each.startswith("profile=")],
            "alpha_s_px": alpha, "accept_alike": self.options.accept_alike, "analysis": self.analysis, "device": self.device,
            "profile": profile.name, "profile_sha256": digest_of_file(profile) if profile.is_file() else "",
            "questions": QUESTIONS | {"every clip": self.extra}, "noise_volume": self.options.noise,
            "practice": self.practice, "clips_sha256": self.digests}

    def begin(self):
        """What differs in each clip: as measured when the study began. Prints none of it: the participant may look on."""
        if self.old is None:
            clips, alpha = self.design()
            if self.practice:
                clips[self.practice] = self.measure(self.practice, [alpha], self.preview.Progress([self.practice]))
            with chain.session(self.options.answers):
                write_settings(self.options.answers, self.settings(alpha), {name: asdict(each[alpha]) for name, each in clips.items()})
        else:
            require_same(self.options.answers, self.old, self.settings(alpha := self.old.get("alpha_s_px")))
        self.properties += self.preview.properties_of(alpha)
        self.old = read_settings(self.options.answers)
        clips = read_settings(self.options.answers, "preview")
        return {name: self.preview.Clip(**values) for name, values in clips.items()}

    def player(self):
        return self.clip_player.Player(self.properties, self.output, self.streams)

    def noise(self):
        return self.clip_player.noise(self.options.noise, self.output)

    @contextmanager
    def taut(self):
        with self.player():
            yield

    def trace_name(self, trial):
        """A name that no earlier trace has: a trial that was stopped is played again."""
        folder, played = Path(self.options.answers + ".traces"), chain.named(self.options.answers, "clip")
        folder.mkdir(parents=True, exist_ok=True)
        name, again = f"{self.options.participant}-{trial.number}", ""
        while name + again in played:
            again = f"-{int(again[1:] or 1) + 1}"
        chain.add(self.options.answers, "clip", name + again)
        return folder / (name + again)

    def present(self, player, trial, clip):
        """Plays the clip of a trial; returns why it does not count, or nothing. Raises RuntimeError."""
        from delivery import judge

        trace = self.trace_name(trial)
        frames, ticks, screen = (f"{trace}{kind}.csv" for kind in ("", ".haptic", ".screen"))
        force = self.preview.force_of(trial.condition)
        share, problem = 0.0, "stopped"
        try:
            properties = ["mute=false", *self.preview.PROPERTIES[trial.condition], f"trace={frames}",
                          f"max-force={clip.max_force_N[force]:.6f}"]
            self.mark(f"begin trial {trial.number} code {trial.code}")
            if not player.play(self.files[trial.clip], properties, trial.condition == "sham", ticks, screen):
                raise Stopped
            others = {self.preview.force_of(each) for each in CONDITIONS[trial.part]} - {force}
            share, problem = judge(ticks, frames, screen, clip.frames[force], trial.condition == "without",
                                   [clip.frames[each] for each in sorted(others)])
        except RuntimeError as error:
            problem = str(error)
            raise
        finally:
            self.mark(f"end trial {trial.number}")
            for file in filter(os.path.exists, (frames, ticks, screen)):
                chain.add_file(self.options.answers, f".traces/{Path(file).name}")
            append_row(self.options.answers, ".presentations", PRESENTATION_COLUMNS,
                       [self.options.participant, trial.number, trace.name, f"{share:.3f}", problem, utc_now()])
        return problem

    def practise(self, player, clips):
        """With the questions, whose answers are not kept. Only before anything was shown."""
        shown = read_rows(self.options.answers + ".presentations")
        if not self.practice or any(row["participant"] == self.options.participant for row in shown):
            return
        print("\nto try it out; these answers are not kept")
        for condition in PRACTISED:
            if read_line("return: play, q: stop here and go on another time > ") == "q":
                raise Stopped
            self.present(player, Trial(0, "haptics", condition, "", self.practice), clips[self.practice])
            for text in (QUESTIONS["haptics"] | self.extra).values():
                ask(text)

    def run_trial(self, player, trial, clip, questions):
        for attempt in range(ATTEMPTS):
            if attempt:
                print("what was to be felt did not reach the hand as it should; the clip is played again")
            if read_line("return: play, q: stop here and go on another time > ") == "q":
                raise Stopped
            problem = self.present(player, trial, clip)
            if not problem:
                break
        else:
            raise RuntimeError(f"trial {trial.number} failed {ATTEMPTS} times, and its answers would say nothing; "
                               f"{self.options.answers}.presentations says why. When the cause is gone, the same command "
                               "goes on here")
        for name, text in questions.items():
            append_row(self.options.answers, "", COLUMNS,
                       [self.options.participant, trial.number, trial.part, trial.condition, trial.code, trial.clip,
                        name, ask(text), utc_now()])

    def require_device(self):
        """Raises ValueError, before anything is asked or written."""
        if self.device == "none":
            raise ValueError("device=none renders no force: give the device that is felt, or device=sim to rehearse")
        if self.device.startswith(("usb", "uart")) and not self.profile:
            raise ValueError(f"device={self.device} needs profile=NAME or profile=FILE.toml: it belongs to the data, and "
                             "what is remembered for a board may change")

    def prepare(self):
        """What must be right before a participant holds the grip. Raises TakesNoPart."""
        answers, is_simulated = self.options.answers, self.device.startswith("sim")
        brief(answers, self.options.participant, self.limit_N, None if is_simulated else self.taut)
        describe(answers, self.options.participant)
        if not is_simulated and read_line("Hold the grip at the centre of its frame, not turned, until the first force. "
                                          "return: open the device, q: stop here > ") == "q":
            raise Stopped

    def measure_thresholds(self):
        """The participant's own least force, change of it, turn and delay, in three minutes each."""
        import gst_spidar
        from moving_square import MovingSquare

        self.prepare()
        with self.noise(), gst_spidar.Device(self.device, self.profile or "") as device:
            device.set_limits(self.limit_N, 0.0)
            device.wait_until_running(10)
            print("Keep the hand where it is. A force to the right comes twice; at times one of them is none.")
            found, trials = {}, 0
            for name in self.options.blocks or perception.THRESHOLDS:
                with MovingSquare(self.output) if name == "late_ms" else nullcontext() as picture:
                    staircase, present, question = perception.blocks(device, self.limit_N, picture)[name]
                    known = perception.measure(present, staircase, lambda: ask(question, ["first", "second"]))
                found[name], trials = "" if known is None else f"{known:.4g}", trials + staircase.trials
        Participants(self.options.answers).register(self.options.participant)
        append_row(self.options.answers, ".thresholds", THRESHOLD_COLUMNS,
                   [self.options.participant, *(found.get(name, "") for name in perception.THRESHOLDS), trials, utc_now()])
        print("thank you")

    def run(self):
        options = self.options
        clips, participants = self.begin(), Participants(options.answers)
        trials = schedule(clips_of(self.old), participants.index_of(options.participant), options.seed)
        questions = open_questions(read_answers(options.answers), options.participant, trials, self.extra)
        with chain.session(options.answers):
            self.prepare()
            with self.noise(), self.player() as player:
                participants.register(options.participant)
                self.practise(player, clips)
                for trial, still_open in zip(trials, questions):
                    if still_open:
                        print(f"\nclip {trial.number} of {len(trials)}, code {trial.code}")
                        self.run_trial(player, trial, clips[trial.clip], still_open)
            debrief(options.answers, options.participant)
        print("that was all; thank you")


def execute(options, properties):
    if options.command == "plan":
        from plan import plan  # SciPy takes a moment

        plan(options)
    elif options.command == "report":
        from report import report

        print(report(read_merged(options.answers), options.answers, options.exploratory))
    elif options.command == "export":
        from export import export

        export(options.answers, options.folder)
    elif options.command == "register":
        import registration

        Study(options, properties).begin()
        print(registration.text(read_settings(options.answers), *chain.registered(options.answers)))
    elif options.command == "withdraw":
        from export import exports_with

        Participants(options.answers).withdraw(options.participant)
        print(f"{options.participant} is removed; the next participant takes this place")
        for exported in exports_with(options.answers, options.participant):
            print(exported)
    elif options.command == "threshold":
        study = Study(options, properties)
        study.require_device()
        with chain.session(options.answers):
            study.measure_thresholds()
    elif options.command == "design":
        _, alpha = Study(options, properties).design()
        print("\nrun takes " + ("the alpha that is given" if alpha is None else f"alpha={alpha:g} s/px"))
    else:
        study = Study(options, properties)
        study.require_device()
        study.run()


def main(arguments):
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl-C
    options, properties = parse(__doc__, arguments)
    try:
        execute(options, properties)
    except (Stopped, KeyboardInterrupt):
        print("\nstopped; the same command goes on here")
    except TakesNoPart as reason:
        print(reason)
        return 1
    except (OSError, RuntimeError, ValueError) as error:
        what = f"{error.filename}: {error.strerror}" if getattr(error, "filename", None) else error
        what = f"{what}; nothing is registered, and a code above is void" if options.command == "register" else what
        print(f"error: {what}", file=sys.stderr)
        return 2 if isinstance(error, ValueError) else 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
