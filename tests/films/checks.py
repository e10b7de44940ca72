# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What must hold for every film of the matrix. A check returns nothing, or raises Wrong with a sentence."""
import json
import math

from corpus import MS, STANDING, probed
from trial import Screen, read_samples

# Both sides round times to the resolution of the container, 1 ms at most.
TIME_S = 1.001 * MS
# A picture may lie half a millisecond beside a sample, at a maximum of the curve. A cubic curve that changes by 5.3 N,
# twice the force, in 40 ms, falls by 5.3 N * 3 * (0.5 / 40)^2 until then. `convert` to HJIF allows 0.0004 of 10 N more.
TRACK_N = 2.5e-3
HJIF_N = 10 * 0.00041 + TRACK_N
FELT_N = 0.1  # a hand feels 0.04 N; the square moves with more than 1 N
# Between two samples, the curve and the loop's own through the samples are each off a straight line by at most their
# second derivative times (1 ms)^2 / 8. That of a cubic whose ends differ by 5.3 N, with slopes of at most as much in
# 40 ms at both, is 12 * 5.3 N / (40 ms)^2.
WANTED_N = 2 * (12 * 5.3 / 40**2 / 8) + TRACK_N
MOST_TRIES = 10
TIME_PARTS = 5  # of a film, in each of which something has to be felt
LEAST_TICKS = 20
# The square moves by whole pairs of pixels, of 5.4 in a picture: its direction is off by up to atan(2 / 5.4), and the
# filter of the motion is a picture late, 10 degrees. A film that is turned is off by 90.
DIRECTION_RAD = math.radians(45)
NO_LENGTH = ("ts", "m2ts", "flv")  # containers that do not say where they end


class Wrong(Exception):
    pass


def expect(condition, text):
    if not condition:
        raise Wrong(text)


def moving(trial):
    """Positions, among the pictures that are shown, of those in which the square has moved."""
    return [i for i, number in enumerate(trial.numbers) if number >= STANDING]


def expect_sentence(text, what):
    """The last line of `text` is a cause that a person understands."""
    line = text.splitlines()[-1] if text else ""
    expect(len(line) > 20 and "Internal data stream error" not in line and "GStreamer error" not in line,
           f"{what}: the cause is not said: {line[-200:]!r}")


# --- what GStreamer and the element make of the film


def pictures(trial):
    """Every player shows the pictures that ffprobe finds, at these times."""
    times = trial.film.times_s
    expect(len(times) == len(trial.film.numbers), f"ffprobe finds {len(times)} pictures, not {len(trial.film.numbers)}")
    for player, play in trial.plays.items():
        expect(not play["error"], f"{player}: {play['error']}")
        shown = [stream for stream, _ in play["frames"]]
        expect(len(shown) == len(times), f"{player} shows {len(shown)} pictures of {len(times)}")
        worst = max(abs((a - shown[0]) - (b - times[0])) for a, b in zip(shown, times))
        expect(worst <= TIME_S, f"{player} shows a picture {1e3 * worst:.1f} ms beside its time")


def analysed(trial):
    """Each picture is analysed once; there is force in the right direction in those in which the square moves. In the
    first of them, an encoder may not show it yet."""
    play, film = trial.plays["decodebin"], trial.film
    shown = [stream for stream, _ in trial.plays["decodebin"]["frames"]]
    expect(len(trial.forces) == len(shown), f"{len(trial.forces)} of {len(shown)} pictures are analysed")
    for stream, force in zip(shown, trial.forces):
        expect(abs(force[0] - stream) < 1e-6, f"the picture of {stream:.3f} s is analysed as of {force[0]:.3f} s")
    first = moving(trial)[0]
    expect(all(math.hypot(x, y) < FELT_N for _, x, y in trial.forces[:first]), "there is force before anything moves")
    for i in moving(trial)[1:]:
        _, x, y = trial.forces[i]
        toward = film.direction(trial.numbers[i])
        expect(math.hypot(x, y) > FELT_N, f"no force in picture {i}, which moves")
        off = math.acos(max(-1, min(1, (x * toward[0] + y * toward[1]) / math.hypot(x, y))))
        expect(off < DIRECTION_RAD, f"the force of picture {i} is turned by {math.degrees(off):.0f} degrees")


# --- spidartrack


def record(trial):
    """The film is recorded, without anything else on the terminal."""
    outcome = trial.spidartrack("record", "-j1", trial.path)
    expect(outcome and trial.track.exists(), f"status {outcome.status}: {outcome.text[-250:]}")
    expect("CRITICAL" not in outcome.text and "WARNING" not in outcome.text, outcome.text[-250:])


def motion_s(trial, i):
    """Stream time of the motion that picture `i` shows: halfway between it and the one that it was compared with."""
    return trial.forces[i][0] - trial.intervals_s[i] / 2


def expect_in_time(samples, trial, error_N=TRACK_N):
    """The force of each picture is in the samples of the time of its motion, or of a millisecond before or after."""
    for i in moving(trial):
        force = trial.forces[i]
        at = motion_s(trial, i) / MS
        near = samples[max(0, math.floor(at - 1.001)):math.ceil(at + 1.001) + 1]
        expect(near, f"the track ends at {len(samples)} ms, before picture {i} of {at:.0f} ms")
        for axis in (0, 1):
            values = [sample[axis] for sample in near]
            expect(min(values) - error_N <= force[1 + axis] <= max(values) + error_N,
                   f"the force of picture {i}, of {at:.0f} ms, is not in the track at this time")


def track_in_time(trial):
    """The track has the force of each picture within a millisecond of the time of its motion, and is at rest before."""
    wav = trial.folder / "track.wav"
    outcome = trial.spidartrack("convert", trial.track, wav)
    expect(outcome, outcome.text)
    trial.samples = read_samples(wav)
    expect_in_time(trial.samples, trial)
    still = int(motion_s(trial, moving(trial)[0] - 1) / MS)
    expect(all(math.hypot(*sample) < FELT_N for sample in trial.samples[:still]), "the track is not at rest at first")
    after_s = len(trial.samples) * MS - trial.forces[-1][0]
    expect(after_s < 0.3, f"the track goes on for {after_s:.1f} s after the last picture")


def info(trial):
    """`info` and `check` find nothing wrong with the track."""
    outcome = trial.spidartrack("info", "--json", trial.track)
    expect(outcome and json.loads(outcome.text)["largest_force_N"] > 1, outcome.text[-200:])
    outcome = trial.spidartrack("check", trial.track)
    expect(outcome, outcome.text[-200:])


def convert(trial):
    """To HJIF and back, the track stays what it was."""
    hjif, wav = trial.folder / "track.hjif", trial.folder / "back.wav"
    for source, target in ((trial.track, hjif), (hjif, wav)):
        outcome = trial.spidartrack("convert", source, target)
        expect(outcome, outcome.text[-200:])
    expect_in_time(read_samples(wav), trial, HJIF_N)


def plot(trial):
    """`plot` draws the track of the film."""
    png = trial.folder / "plot.png"
    outcome = trial.spidartrack("plot", trial.path, png)
    expect(outcome and png.exists() and png.stat().st_size > 5000, outcome.text[-250:])


def own_track(trial):
    """track=auto plays the track beside its film without a warning."""
    played = trial.play_quickly("playbin", trial.path, {"track": "auto"})
    expect(played["of track"] == len(trial.numbers) and not played["analysed"] and not played["warnings"],
           f"{played['of track']} pictures of the track, {played['analysed']} analysed: {played['warnings'][:1]}")


def other_film(trial):
    """The track is refused for another film of the same length, which is analysed."""
    path = trial.copy(trial.other, "other", "film" + trial.other.path.suffix)
    trial.track.exists() and path.with_name(path.name + ".haptic.flac").write_bytes(trial.track.read_bytes())
    played = trial.play_quickly("playbin", path, {"track": "auto"})
    expect(played["analysed"] and not played["of track"], f"track=auto plays the track of another film: {trial.other}")
    expect(played["warnings"], "track=auto refuses the track of another film without a word")
    if trial.film.kind["tool"] != "plot":
        return
    outcome = trial.spidartrack("plot", path, path.with_name("out.png"))
    expect(outcome.status == 1, f"plot takes the track of another film, {trial.other}")
    expect_sentence(outcome.text, "plot")
    expect(not any(path.parent.glob("out.*")), "plot leaves a file")


# --- felt


def judged_ticks(ticks):
    """Those after which the loop had its time for a tenth of a second: after a pause, the force grows again."""
    late_s = last_s = -1
    for tick in ticks:
        if tick[0] - last_s > 5 * MS:
            late_s = tick[0]
        last_s = tick[0]
        if tick[0] - late_s > 0.1:
            yield tick


def off_by(tick, trial, screen):
    """Difference, N, of what is wanted in this tick from the track at this time, in the axis that differs most."""
    stream_s = screen.stream_at(tick[0])
    return max(abs(a - b) for a, b in zip(tick[1:3], trial.force_at(stream_s))) if stream_s is not None else 0.0


def felt_once(trial, player, frames, ticks):
    """Judges that a film is felt as its track says. Returns the parts of its time, from its first moving picture to its
    last, in which the machine left the loop enough time to judge."""
    screen = Screen(frames)
    pictures_s = [screen.due_s[i] for i in moving(trial)]
    # The force fades in over 40 ms when the film begins with it. What comes after the last picture bends the curve
    # before it: it is not the same in the middle of two films as at the end of one.
    first_s, curve_s, last_s = pictures_s[1], pictures_s[-3], pictures_s[-1]
    for tick in ticks:
        if pictures_s[0] <= tick[0] < curve_s:
            off_N = off_by(tick, trial, screen)
            expect(off_N < WANTED_N, f"{player}: what is wanted at {tick[0]:.3f} s is {off_N:.3f} N off the track")
    judged = [tick for tick in judged_ticks(ticks) if first_s <= tick[0] < last_s]
    weak = [tick[0] for tick in judged if tick[3] < FELT_N]
    if weak:
        raise Wrong(f"{player}: nothing is felt from {weak[0]:.3f} s to {weak[-1]:.3f} s in a film that moves from "
                    f"{pictures_s[0]:.3f} s to {last_s:.3f} s")
    return {int(TIME_PARTS * (tick[0] - first_s) / (last_s - first_s)) for tick in judged}


def felt(trial):
    """It is felt from the first picture in which the square has moved to the last, at their times."""
    player = trial.film.kind["player"]
    if player == "spidar-feel":
        return felt_under_spidar_feel(trial)
    if player == "gapless" and trial.film.kind["container"] == "flv":
        player = "playbin3"  # which hangs between two FLV more often than not, also without the element
    count = len(trial.forces)
    problem = f"{player}: in {MOST_TRIES} tries, the machine was too busy to tell what is felt"
    judged = [set(), set()]  # parts of the first and of the second film
    for _ in range(MOST_TRIES):
        play = trial.play_in_time(player)
        expect(not play["warnings"], f"{player}: {play['warnings']}")
        films = [play["frames"][begin:begin + count] for begin in range(0, len(play["frames"]), count)]
        shown, wanted = len(play["frames"]), count * (2 if player == "gapless" else 1)
        expect(shown == wanted, f"{player} shows {shown} of {wanted} pictures")
        try:
            for film, parts in zip(films, judged):
                parts |= felt_once(trial, player, film, play["ticks"])
            if all(len(parts) == TIME_PARTS for _, parts in zip(films, judged)):
                return
        except Wrong as wrong:
            if not play["hurried"]:
                raise
            problem = str(wrong)
    raise Wrong(problem)


def felt_under_spidar_feel(trial):
    """The device opens while the film plays already, and pictures come to the element as gst-play decodes them: what is
    felt is the force of the picture that is shown, if the machine was quick enough."""
    for _ in range(MOST_TRIES):
        play = trial.feel_gst_play()
        screen = Screen(play["frames"])
        judged = [tick for tick in judged_ticks(play["ticks"]) if tick[0] < screen.due_s[-3] and tick[3] > FELT_N]
        if sum(off_by(tick, trial, screen) < WANTED_N for tick in judged) > LEAST_TICKS:
            return
    raise Wrong(f"spidar-feel: in {MOST_TRIES} tries, the film was not felt")


# --- damaged films


def damaged(trial):
    """Cut off, it is an error with a cause, which leaves nothing behind, or its whole pictures are recorded in a
    container that does not say how long it is."""
    film, kind = trial.film, trial.film.kind
    folder = trial.folder / "damaged"
    folder.mkdir(exist_ok=True)
    path = folder / film.path.name
    path.write_bytes(film.path.read_bytes()[:film.cut_bytes])
    outcome = trial.spidartrack("record", "-j1", path)
    left = sorted(p.name for p in folder.iterdir() if p != path)
    if outcome and kind["container"] in NO_LENGTH:
        return expect(left == [trial.track.name], f"status 0, and in the folder: {left}")
    expect(outcome.status == 1, f"status {outcome.status}: {outcome.text[-200:]}")
    expect(not left, f"an error leaves {left}")
    expect_sentence(outcome.text, "record")


def nothing_left(trial):
    """No temporary file is left beside the film."""
    known = {trial.path.name, trial.track.name, "track.wav", "track.hjif", "back.wav", "plot.png"}
    written = (p.name for p in trial.folder.iterdir() if p.is_file() and not p.name.startswith("ticks-"))
    left = [name for name in written if name not in known]
    expect(not left, f"left: {left}")


CHECKS = (pictures, analysed, record, track_in_time, info, convert, plot, own_track, other_film, felt, damaged,
          nothing_left)
# Without these, the others say nothing.
NEEDED = {track_in_time: (record,), info: (record,), convert: (track_in_time,), plot: (record,),
          own_track: (record,), other_film: (record,), felt: (track_in_time,)}
