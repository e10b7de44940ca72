# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What is asked on the terminal: before a participant may hold the grip, after each clip, and at the end."""

import sys
import termios
import time

from chain import utc_now
from records import append_row, read_rows
from trials import STEPS

# Few people read English faster (M. Brysbaert, How many words do we read per minute?, 2019: most 175 to 300 a minute).
WORDS_S = 300 / 60
GENTLE_N = 1.0  # the limit of the force unless the experimenter confirms more; docs/safety.md
# Questions to the experimenter whose answer must be no.
EXCLUSIONS = [
    "Is the participant younger than 18?",
    "Does the participant have an electronic implant, such as a pacemaker, a defibrillator or an insulin pump?",
    "Has the participant ever had an epileptic seizure?",
    "Does the participant have an injury, a wound, an inflammation or numbness of the hand, the arm or the shoulder, "
    "or white fingers in the cold?",
    "Is the participant pregnant?",
    "Is the participant tired, ill, or under the influence of alcohol or drugs?",
]
# Of the participant, once: what is recorded, the question, and its answers.
PERSON = {
    "handedness": ("Which hand do you write with?", ["right", "left", "both"]),
    "grip-hand": ("Which hand will hold the grip?", ["right", "left"]),
    "experience": ("How often have you held a device that pushes back?", ["never", "once or twice", "often"]),
}

# What may have been done to the force, without a hint at what was: one is right, others are as plausible, and the last
# is for who does not know.
BELIEFS = ["it always followed the motion", "it was at times too late", "it was at times against the motion",
           "it was at times that of another clip", "I do not know"]
RIGHT_BELIEF = BELIEFS[2]


class Stopped(Exception):
    """The participant stops here, or the input ends; the same command goes on."""


class TakesNoPart(Exception):
    """The participant may not hold the grip."""


texts_read = set()  # in this session


def read_line(prompt, text=""):
    """What was typed on a terminal before `prompt` is there, or sooner than it and the `text` above it can be read, is no
    answer; what a pipe has was not typed. Who has read a text once need not read it again."""
    text += prompt
    try:
        while True:
            if sys.stdin.isatty():
                termios.tcflush(sys.stdin, termios.TCIFLUSH)
            begin_s = time.monotonic()
            line = input(prompt)
            read_s = time.monotonic() - begin_s
            if text in texts_read or read_s * WORDS_S >= len(text.split()) or not sys.stdin.isatty():
                texts_read.add(text)
                return line
            print("nobody can read that so fast: read it, and answer again")
    except (EOFError, KeyboardInterrupt):
        raise Stopped from None


def ask(text, answers=STEPS):
    """Asks the participant until there is the number of an answer, from 1 on."""
    question = text + "\n  " + "  ".join(f"{number} {name}" for number, name in enumerate(answers, 1)) + "\n"
    print(question, end="")
    while True:
        line = read_line("> ", question)
        if line == "q":
            raise Stopped
        if line in map(str, range(1, len(answers) + 1)):
            return int(line)
        print(f"a number from 1 to {len(answers)}, or q to stop here and go on another time")


def is_yes(text):
    while True:
        line = read_line(f"{text} yes or no > ")
        if line in ("yes", "no"):
            return line == "yes"


def note_answer(path, participant, check, answer):
    append_row(path, ".briefings", ["participant", "check", "answer", "time_utc"], [participant, check, answer, utc_now()])


def still_open(path, participant, checks):
    known = {row["check"] for row in read_rows(f"{path}.briefings") if row["participant"] == participant}
    return [check for check in checks if check not in known]


def describe(path, participant):
    """Asks the participant about themselves, once."""
    for check in still_open(path, participant, PERSON):
        question, answers = PERSON[check]
        note_answer(path, participant, check, answers[ask(question, answers) - 1])


def debrief(path, participant):
    """After the last clip: what the participant thinks it was about, before anything is said of the sham."""
    for check in still_open(path, participant, ["guess", "believed"]):
        if check == "guess":
            answer = read_line("What do you think differed when a clip was shown again? In your own words\n> ")
        else:
            answer = BELIEFS[ask("Which of these do you believe of the force?", BELIEFS) - 1]
        note_answer(path, participant, check, answer)


def brief(path, participant, force_N, while_taut):
    """Asks the experimenter what must be right before a participant holds the grip. Raises TakesNoPart.

    Every answer is on the disk, in `path`.briefings, before the next question. `while_taut` makes a context in which the strings
    are tight; it is None if nothing pulls, as with a simulated device.
    """

    note = lambda check, answer: note_answer(path, participant, check, answer)

    def require(check, is_right):
        note(check, "yes" if is_right else "no")
        if not is_right:
            raise TakesNoPart(f"{participant} does not take part")

    require("consent", is_yes("Has the participant read and signed the consent form?"))
    # Whether there is a reason is recorded, but not which one, because it concerns the person's health.
    require("eligible", not any([is_yes(reason) for reason in EXCLUSIONS]))
    require("loose-things", is_yes("Are rings, watches and bracelets taken off, sleeves rolled up, and hair and scarf "
                                   "tied back?"))
    if not force_N <= GENTLE_N:
        sentence = f"I am responsible for {force_N:g} N "
        line = read_line(f"More than {GENTLE_N:g} N is asked for. Type, with your name: {sentence}NAME > ")
        if not line.startswith(sentence) or not line[len(sentence):].strip():
            raise TakesNoPart(f"not confirmed; without max-force the limit is {GENTLE_N:g} N")
        note("force", line)
    if while_taut:
        with while_taut():
            works = is_yes("The strings are taut, and nobody holds the grip. Press the emergency stop. Did all strings "
                           "become slack at once?")
        require("emergency-stop", works)
        require("stop-in-reach", is_yes("Switch the motors on again. Can the participant reach the stop with the hand "
                                        "that does not hold the grip, and have they pressed it once?"))
