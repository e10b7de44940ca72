# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What the films of the matrix differ in, which values go together, and a choice of films in which every pair
of values occurs."""
import itertools
import random

H264 = "-c:v libx264 -preset veryfast -crf 18 -x264-params log-level=error:keyint=12"
HEVC = "-c:v libx265 -preset ultrafast -crf 18 -x265-params log-level=error:keyint=12:bframes=3:b-adapt=0"
PICTURES = {  # arguments of ffmpeg
    "H.264": H264 + ":bframes=0",
    "H.264 B": H264 + ":bframes=3:b-adapt=0",
    "HEVC": HEVC,
    "HEVC 10": HEVC + " -pix_fmt yuv420p10le",
    "VP8": "-c:v libvpx -deadline realtime -cpu-used 8 -g 12 -b:v 2M",
    "VP9": "-c:v libvpx-vp9 -deadline realtime -cpu-used 8 -g 12 -b:v 2M",
    "AV1": "-c:v libsvtav1 -preset 12 -g 12 -crf 20",
    "MPEG-2": "-c:v mpeg2video -bf 2 -g 12 -q:v 2",
    "MPEG-4": "-c:v mpeg4 -bf 2 -g 12 -q:v 2",
    "MJPEG": "-c:v mjpeg -pix_fmt yuvj420p -q:v 2",
    "ProRes": "-c:v prores_ks -profile:v 0",
    "Theora": "-c:v libtheora -g 12 -q:v 9",
}
SOUNDS = {
    "none": "",
    "AAC": "-c:a aac",
    "MP3": "-c:a libmp3lame",
    "AC-3": "-c:a ac3",
    "Opus": "-c:a libopus",
    "Vorbis": "-c:a libvorbis",
    "FLAC": "-c:a flac",
    "PCM": "-c:a pcm_s16le",
}
MP4_PICTURES = "H.264,H.264 B,HEVC,HEVC 10,VP9,AV1,MPEG-2,MPEG-4,MJPEG"
FRAGMENTS = "-f mp4 -movflags frag_keyframe+empty_moov+delay_moov+default_base_moof"
CONTAINERS = {  # arguments, extension, pictures, sounds beside "none"
    "mkv": ("", "mkv", MP4_PICTURES + ",VP8", ",".join(SOUNDS)),
    "mp4": ("", "mp4", MP4_PICTURES, "AAC,MP3,AC-3,Opus,FLAC"),
    "fragmented mp4": (FRAGMENTS, "mp4", MP4_PICTURES, "AAC,MP3,AC-3,Opus,FLAC"),
    "mov": ("", "mov", "H.264,H.264 B,HEVC,HEVC 10,MPEG-4,MJPEG,ProRes", "AAC,MP3,AC-3,PCM"),
    "ts": ("-f mpegts", "ts", "H.264,H.264 B,HEVC,HEVC 10,MPEG-2,MPEG-4", "AAC,MP3,AC-3,Opus"),
    "m2ts": ("-f mpegts -mpegts_m2ts_mode 1", "m2ts", "H.264,H.264 B,MPEG-2", "AC-3"),
    "webm": ("", "webm", "VP8,VP9,AV1", "Opus,Vorbis"),
    "avi": ("", "avi", "H.264,MPEG-4,MJPEG", "MP3,AC-3,PCM"),
    "flv": ("", "flv", "H.264,H.264 B", "AAC,MP3"),
    "ogg": ("", "ogg", "Theora", "Opus,Vorbis,FLAC"),
    "3gp": ("", "3gp", "H.264,H.264 B,MPEG-4", "AAC"),
}
EARLY = "begins 300 ms before"
SOUND_TIMES = {  # when it begins, and how much later than the pictures it ends, in s
    "as long": (0.0, 0.0),
    EARLY: (-0.3, 0.0),
    "begins 30 ms after": (0.03, 0.0),
    "begins 500 ms after": (0.5, 0.0),
    "ends 500 ms before": (0.0, -0.5),
    "ends 50 ms after": (0.0, 0.05),
    "ends 5 s after": (0.0, 5.0),
}
TIMES = ("from 0", "from 2.7 s", "edit list", "variable rate", "23.976")
EXTRAS = ("none", "turned by 90", "poster", "second video", "SRT", "ASS", "chapters")
NAMES = {"plain": "film", "space": "a film", "quotes": "it's \"a\" film", "percent": "100%20%s",
         "newline": "two\nlines", "not UTF-8": b"na\xefve".decode(errors="surrogateescape")}
CUTS = ("half", "after the first picture", "5 kB")
PLAYERS = ("playbin", "playbin3", "gapless", "decodebin", "track=auto", "spidar-feel")
TOOLS = ("info", "convert", "plot")  # of which each film goes through one

DIMENSIONS = {"container": tuple(CONTAINERS), "pictures": tuple(PICTURES), "sound": tuple(SOUNDS),
              "sound time": tuple(SOUND_TIMES), "times": TIMES, "extra": EXTRAS, "name": tuple(NAMES),
              "cut": CUTS, "player": PLAYERS, "tool": TOOLS}
# All pairs of values of these: the container with everything, and what meets in a demuxer or a player. Pictures and
# sound, for example, meet in the container only.
MEETING = {frozenset(pair) for pair in (
    *(("container", name) for name in DIMENSIONS if name != "container"),
    ("sound", "sound time"), ("times", "player"), ("name", "tool"))}
# Of these films, so many are played every day that each value occurs, and each pair of these: what decides when a
# picture is shown.
EVERYDAY = {frozenset(pair) for pair in (("container", "times"), ("times", "player"))}

EXTRA_CONTAINERS = {"turned by 90": ("mp4", "mov", "3gp"), "poster": ("mp4", "mov", "mkv"),
                    "second video": ("mkv", "mp4", "mov", "ts"), "SRT": ("mkv",), "ASS": ("mkv",),
                    "chapters": ("mkv", "mp4", "mov", "webm")}
TIME_CONTAINERS = {"from 2.7 s": ("mkv", "mp4", "mov", "ts", "m2ts", "webm", "flv"),
                   "edit list": ("mp4", "mov"),
                   "variable rate": ("mkv", "mp4", "fragmented mp4", "mov", "ts", "webm", "flv"),
                   "23.976": ("mkv", "mp4", "fragmented mp4", "mov", "ts", "m2ts", "webm", "avi", "flv", "ogg")}

RULES = {  # pairs of values that go together
    ("container", "pictures"): lambda c, p: p in CONTAINERS[c][2].split(","),
    ("container", "sound"): lambda c, s: s == "none" or s in CONTAINERS[c][3].split(","),
    ("sound", "sound time"): lambda s, t: s != "none" or t == "as long",
    ("container", "extra"): lambda c, e: e == "none" or c in EXTRA_CONTAINERS[e],
    ("container", "times"): lambda c, t: t == "from 0" or c in TIME_CONTAINERS[t],
    # These encoders know a fixed rate only.
    ("pictures", "times"): lambda p, t: not (t == "variable rate" and p in ("MPEG-2", "Theora")),
    # Muxers place a sound that begins before the pictures by a time at which the film begins, which AVI does not have.
    ("sound time", "times"): lambda s, t: t in ("from 0", "23.976") or s != EARLY,
    ("container", "sound time"): lambda c, s: c != "avi" or s != EARLY,
}


def fits(film):
    return all(rule(film[a], film[b]) for (a, b), rule in RULES.items() if a in film and b in film)


def pairs(film):
    return set(itertools.combinations(sorted(film.items()), 2))


def completed(film, left, wanted):
    """`film` with a value for each dimension of `left` too, with as many of the `wanted` pairs as a greedy search
    finds, or None if no film has the values that are given."""
    if not left:
        return film
    def gain(value):
        return sum(tuple(sorted([(left[0], value), other])) in wanted for other in film.items())
    for value in sorted(DIMENSIONS[left[0]], key=gain, reverse=True):
        longer = {**film, left[0]: value}
        if fits(longer) and (found := completed(longer, left[1:], wanted)):
            return found
    return None


def cover(starts, meet):
    """Films that begin with each of `starts` (some values of a film) and together contain every pair of values
    that some film can have, of the pairs of dimensions for which `meet` is true. The same films in every run."""
    names = list(DIMENSIONS)
    wanted = {pair for a, b in itertools.combinations(names, 2) if meet(a, b)
              for pair in itertools.product([(a, v) for v in DIMENSIONS[a]], [(b, v) for v in DIMENSIONS[b]])}
    wanted = {tuple(sorted(pair)) for pair in wanted}
    films, order = [], random.Random(1)

    def rarity(pair):  # pairs of many values first: most others come along with them
        return -len(DIMENSIONS[pair[0][0]]) * len(DIMENSIONS[pair[1][0]]), pair

    for start in itertools.chain(starts, map(dict, sorted(wanted, key=rarity))):
        if start not in starts and not wanted & pairs(start):
            continue  # another film has this pair
        left = [name for name in names if name not in start]
        choice = []
        for _ in range(20):
            order.shuffle(left)
            left.sort(key="container".__ne__)  # most rules are about it
            choice.append(completed(start, left, wanted))
        film = max(choice, key=lambda film: len(wanted & pairs(film)) if film else -1)
        if film:
            wanted -= pairs(film)
            films.append({name: film[name] for name in names})
    return films


def meeting():
    return cover([], lambda a, b: frozenset((a, b)) in MEETING)


def every_day():
    """Some of meeting(), chosen by a greedy search."""
    def worth(film):
        return set(film.items()) | {pair for pair in pairs(film) if frozenset(name for name, _ in pair) in EVERYDAY}

    left, films = meeting(), []
    wanted = set().union(*map(worth, left))
    while wanted:
        films.append(max(left, key=lambda film: len(worth(film) & wanted)))
        wanted -= worth(films[-1])
    return films


def whole(names):
    """Every combination of the values of these dimensions, and every pair of all."""
    return cover(product(names) if names else [], lambda a, b: True)


def product(names):
    """Every combination of the values of these dimensions that goes together."""
    films = (dict(zip(names, values)) for values in itertools.product(*(DIMENSIONS[name] for name in names)))
    return [film for film in films if fits(film)]
