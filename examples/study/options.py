# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The command line of study.py."""

import argparse

from briefing import GENTLE_N
from perception import THRESHOLDS
from trials import ANALYSIS

NOISE = 0.1  # volume; how loud that is, the laboratory sets at the headphones until nobody hears the motors


def parse(description, arguments):
    """The options, and what comes after --: properties."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    end = ("name=value: properties of spidarmotion, the same for all clips. Without max-force the largest force is "
           f"{GENTLE_N:g} N, and more must be confirmed.")
    plan = commands.add_parser("plan", help="how many participants an effect needs")
    plan.add_argument("--odds-ratio", type=float, required=True,
                      help="the least that is worth finding, of a higher answer, for one person and one clip")
    plan.add_argument("--primary", default=ANALYSIS["primary"], metavar="NAME", help="as of run (movement)")
    plan.add_argument("--clips", type=int, nargs="+", default=[4, 6, 12], help="numbers of clips (4 6 12)")
    plan.add_argument("--spread", type=float, default=1,
                      help="standard deviation between participants, of their level and of their effect, as log odds (1)")
    plan.add_argument("--clip-spread", type=float, default=0.8, help="the same, between clips (0.8)")
    plan.add_argument("--power", type=float, default=0.8)
    plan.add_argument("--level", type=float, default=0.05, help="of the test")
    plan.add_argument("--simulations", type=int, default=16000,
                      help="at most, of each design; fewer where the power is known before (16000)")
    design = commands.add_parser("design", help="in what the conditions of these clips differ", epilog=end,
                                 usage="study.py design [--paper] [--accept-alike] CLIP... [-- name=value...]")
    run = commands.add_parser(
        "run", help="a participant's session: consent, practice, clips and questions", usage="study.py run [option...] ANSWERS.csv PARTICIPANT CLIP... [-- name=value...]", epilog=end)
    threshold = commands.add_parser("threshold", help="the participant's own least force, change, turn and delay of it", epilog=end,
                                    usage="study.py threshold [option...] ANSWERS.csv PARTICIPANT [-- name=value...]")
    threshold.add_argument("--block", dest="blocks", choices=THRESHOLDS, action="append", help="only this one; once or more")
    register = commands.add_parser(
        "register", help="fixes what the study will do, and prints it for a registry", epilog=end,
        usage="study.py register --participants N [option of run...] ANSWERS.csv CLIP... [-- name=value...]")
    register.add_argument("--participants", type=int, required=True, metavar="N", help="how many there will be")
    for command in run, register, threshold:
        command.add_argument("answers", metavar="ANSWERS.csv")
        if command is not register:
            command.add_argument("participant", metavar="PARTICIPANT")
        command.add_argument("--noise", type=float, default=NOISE, metavar="VOLUME",
                             help=f"of pink noise that hides the sound of the motors throughout ({NOISE:g}; 0 to 1)")
    for command in run, register:
        command.add_argument("--practice", metavar="CLIP", default="",
                             help="shown first, with and without haptics, to try it out")
        command.add_argument("--seed", type=int, default=1, help="another random order of clips; the same for all of a study")
        command.add_argument("--question", metavar="NAME=TEXT", action="append", default=[],
                             help="one more question after each clip, on the same five steps")
        command.add_argument("--primary", default=ANALYSIS["primary"], metavar="NAME",
                             help="the question of the primary outcome (movement)")
    for command in run, threshold:
        command.add_argument("--headless", action="store_true", help="no window for the video")
    for command in design, run, register:
        command.add_argument("clips", metavar="CLIP", nargs="+")
        command.add_argument("--paper", action="store_true", help="the paper's own setting: motion=mean, alpha=0.01, and "
                             "conditions of different strength")
        command.add_argument("--accept-alike", action="store_true",
                             help="also clips whose conditions are the same in most frames")
    run.add_argument("--lsl", action="store_true",
                     help="send force, pose, and markers of frames and trials to the Lab Streaming Layer")
    for command in design, threshold:
        command.set_defaults(lsl=False, question=[], primary=ANALYSIS["primary"], practice="")
    design.set_defaults(headless=False, answers="")
    register.set_defaults(lsl=False, headless=False, participant="-")
    run.set_defaults(participants=None)
    threshold.set_defaults(clips=[], paper=False)
    report = commands.add_parser("report", help="what was answered, and what differs")
    report.add_argument("answers", metavar="ANSWERS.csv", nargs="+", help="of several machines, each with files of its own")
    report.add_argument("--exploratory", action="store_true", help="also where files are not as they were written")
    export = commands.add_parser("export", help="answers and recordings as a folder for other programs, as BIDS has them")
    export.add_argument("answers", metavar="ANSWERS.csv")
    export.add_argument("folder", metavar="FOLDER", help="a new one")
    withdraw = commands.add_parser("withdraw", help="deletes what is kept of a participant")
    withdraw.add_argument("answers", metavar="ANSWERS.csv")
    withdraw.add_argument("participant", metavar="PARTICIPANT")
    split = arguments.index("--") if "--" in arguments else len(arguments)
    options, properties = parser.parse_args(arguments[:split]), arguments[split + 1:]
    if options.command in ("run", "register", "threshold"):
        if not options.participant.isprintable() or options.participant in ("", "participant") or "/" in options.participant:
            parser.error(f'"{options.participant}" cannot be a part of a file name: give the participant a code')
        if not 0 <= options.noise <= 1:
            parser.error(f"--noise {options.noise:g} is no volume: give 0 to 1")
        if options.command == "register" and options.participants < 1:
            parser.error(f"--participants {options.participants}: give how many there will be")
        for question in options.question:
            if not all(question.partition("=")):
                parser.error(f"--question {question} is not NAME=TEXT")
    return options, properties
