# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The films of pathologies.py: made ones, and the variants that ffmpeg makes of a film."""

import subprocess

RATE = 24
SIZE = "640x360"
MADE_S = 4
SKIPPED_S = 0.5  # in which the rhythm of the frames is learnt
SETTLED_S = 3.5 / RATE  # after a fade
LOSSLESS = ["-c:v", "ffv1", "-pix_fmt", "yuv420p"]


def x264(crf, *more):
    return ["-c:v", "libx264", "-crf", str(crf), "-pix_fmt", "yuv420p", *more]


def ffmpeg(*arguments):
    subprocess.run(["ffmpeg", "-v", "error", "-nostdin", "-y", *map(str, arguments)], check=True)


def synthetic_texture(seed, file, size):
    """Shapes of all sizes as photographs have them: noise, blurred by several amounts and added."""
    w, h = size
    layers = [(2, 1.0), (5, 2.2), (14, 5.0)]
    noise = "".join(f"nullsrc=s={w}x{h}:d=0.04:r=25,geq=lum='128+110*(random({seed + i})-0.5)':cb=128:cr=128,"
                    f"gblur=sigma={sigma},lutyuv=y='clip((val-128)*{gain}*1.6+128\\,0\\,255)'[l{i}];"
                    for i, (sigma, gain) in enumerate(layers))
    ffmpeg("-filter_complex", noise + "[l0][l1]blend=all_mode=average[a];[a][l2]blend=all_mode=average,"
           "lutyuv=y='clip((val-128)*2.6+128\\,16\\,235)'", "-frames:v", 1, file)


def make_films(folder):
    """At twice the size, then reduced, so that things move by halves of a pixel, too."""
    wall, thing = folder / "wall.png", folder / "thing.png"
    synthetic_texture(1, wall, (2000, 1100))
    synthetic_texture(7, thing, (240, 240))
    pan = "crop=1280:720:x='200+150*sin(0.9*t+0.3)+60*t':y='150+40*cos(0.7*t)'"
    disc = "format=yuva420p,geq=lum='lum(X,Y)':cb=128:cr=128:a='255*lt(hypot(X-120,Y-120),115)'"
    way = "x='520+200*sin(1.3*t)':y='240+120*cos(1.3*t)'"
    end = f"scale={SIZE.replace('x', ':')}:flags=area,noise=c0s=3:c0f=t,format=yuv420p"
    loop = ["-loop", 1, "-framerate", RATE, "-t", MADE_S]
    ffmpeg(*loop, "-i", wall, "-vf", f"{pan},{end}", *LOSSLESS, folder / "pan.mkv")
    ffmpeg(*loop, "-i", wall, *loop, "-i", thing, "-filter_complex",
           f"[0]{pan}[w];[1]{disc}[d];[w][d]overlay={way}:eval=frame,{end}", *LOSSLESS,
           folder / "object.mkv")
    return [folder / "object.mkv", folder / "pan.mkv"]


class Variant:
    """A film that is made from the plain one."""

    def __init__(self, group, name, filters="", coding=LOSSLESS, complex_filters=None, behind="",
                 plain="", rest=None, spans=None, extra=()):
        self.group, self.name, self.filters, self.coding = group, name, filters, coding
        self.complex_filters, self.behind, self.plain = complex_filters, behind, plain
        self.rest, self.spans, self.extra = rest, spans, extra

    def make(self, film, out):
        if self.complex_filters:
            ffmpeg("-i", film, "-filter_complex", self.complex_filters, "-fps_mode", "vfr",
                   *self.coding, out)
        else:
            ffmpeg("-i", film, "-vf", self.filters or "null", "-fps_mode", "vfr", *self.coding, out)


def text(what, x, y, size, color="white", more=""):
    return f"drawtext=font=Sans:text='{what}':x={x}:y={y}:fontsize={size}:fontcolor={color}{more}"


OUTLINE = ":borderw=2:bordercolor=black"


def captions():
    logo = f"drawbox=x=iw-90:y=20:w=70:h=40:color=gray:t=fill,{text('TV 5', 'w-84', 26, 26)}"
    see_through = text("TV 5", "w-100", 20, 34, "white@0.5")
    subtitles = ",".join(
        text(words, "(w-tw)/2", "h-48", 24, more=f"{OUTLINE}:enable='between(t,{t},{t + 1.1})'")
        for words, t in (("We shall never know who it was", 0.6), ("or where they went", 1.8),
                         ("in that long summer.", 2.9)))
    clock = text("%{pts\\:hms}", 20, 20, 26, more=":box=1:boxcolor=black")
    letterbox = ("drawbox=x=0:y=0:w=iw:h=ih/8:color=black:t=fill,"
                 "drawbox=x=0:y=ih-ih/8:w=iw:h=ih/8:color=black:t=fill")
    pillarbox = ("drawbox=x=0:y=0:w=iw/8:h=ih:color=black:t=fill,"
                 "drawbox=x=iw-iw/8:y=0:w=iw/8:h=ih:color=black:t=fill")
    display = ",".join([text("HP 72  AMMO 18/90", 16, "h-40", 22, more=OUTLINE),
                        text("%{n}", "w-90", "h-40", 22, more=OUTLINE),
                        "drawbox=x=16:y=16:w=150:h=14:color=black:t=fill",
                        "drawbox=x=18:y=18:w=120:h=10:color=white:t=fill",
                        "drawbox=x=iw/2-14:y=ih/2-1:w=28:h=2:color=white:t=fill",
                        "drawbox=x=iw/2-1:y=ih/2-14:w=2:h=28:color=white:t=fill"])
    still = ("[0]split[a][b];[b]trim=end_frame=1,scale=iw/4:ih/4,hflip,loop=-1:1,setpts=N/FRAME_RATE/TB[p];"
             "[a][p]overlay=x=W-w-20:y=20:shortest=1")
    for crf in (0, 23):
        coding, how = (LOSSLESS, "") if crf == 0 else (x264(crf), f", crf {crf}")
        for name, filters in (("logo", logo), ("half-transparent logo", see_through),
                              ("subtitles", subtitles), ("clock", clock), ("letterbox", letterbox),
                              ("pillarbox", pillarbox), ("head-up display", display)):
            yield Variant("captions", name + how, filters, coding)
        yield Variant("captions", "still picture in picture" + how, coding=coding, complex_filters=still)


def every(n):
    return f"select='not(mod(n,{n}))'"


def variants(length_s):
    middle = length_s / 2
    yield Variant("repeats", "24 in 30", "fps=30")
    yield Variant("repeats", "24 in 60", "fps=60")
    yield Variant("repeats", "24 in 60, crf 23", "fps=60", x264(23))
    yield Variant("repeats", "24 in 25", "fps=25")
    yield Variant("repeats", "five in six", "fps=144/5")
    yield Variant("repeats", "on twos", every(2) + ",fps=24", plain=every(2))
    yield Variant("repeats", "on threes", every(3) + ",fps=24", plain=every(3))
    yield Variant("repeats", "one in eleven repeated", "select='mod(n,11)-7',fps=24")
    yield Variant("repeats", "one in seven dropped", "select='mod(n,7)-3'")
    yield Variant("repeats", "variable rate", "select='not(eq(mod(n*n,13),4)+eq(mod(n,5),2))'")
    yield Variant("repeats", "videorate to 30", behind="videorate ! video/x-raw,framerate=30/1 !")
    yield Variant("repeats", "videorate to 60", behind="videorate ! video/x-raw,framerate=60/1 !")
    interlaced = ["-flags", "+ildct+ilme", "-top", 1]
    for crf in (18, 23):
        yield Variant("fields", f"3:2 telecine, flagged, crf {crf}", "telecine=pattern=23",
                      x264(crf, *interlaced))
        yield Variant("fields", f"3:2 telecine, not flagged, crf {crf}",
                      "telecine=pattern=23,setfield=prog", x264(crf))
        yield Variant("fields", f"interlaced, flagged, crf {crf}", "tinterlace=interleave_top",
                      x264(crf, *interlaced), plain=every(2))
        yield Variant("fields", f"interlaced, not flagged, crf {crf}",
                      "tinterlace=interleave_top,setfield=prog", x264(crf), plain=every(2))
    yield from captions()
    fade_s = 0.5
    after = [(SKIPPED_S + SETTLED_S, length_s)]
    yield Variant("editing", "fade from black", f"fade=in:st=0:d={fade_s}", spans=after)
    yield Variant("editing", "fade to black and back",
                  f"fade=out:st={middle - fade_s}:d={fade_s}:enable='lt(t,{middle})',"
                  f"fade=in:st={middle}:d={fade_s}:enable='gte(t,{middle})'",
                  spans=[(SKIPPED_S, middle - fade_s), (middle + fade_s + SETTLED_S, length_s)])
    yield Variant("light", "flicker of 10 %", "lutyuv=y='clip(val*1.1,0,255)':enable='mod(n,2)'")
    yield Variant("light", "flicker of 10 %, slow",
                  "eq=eval=frame:contrast='1+0.1*sin(9*t)'")
    for crf in (29, 35):
        yield Variant("coding", f"crf {crf}", coding=x264(crf))
    for crf in (23, 35):
        yield Variant("coding", f"grain, crf {crf}", "noise=c0s=10:c0f=t", x264(crf))
    shake = "crop=iw-32:ih-32:x='16+8*sin(13*t)+5*sin(29*t+1)':y='16+7*sin(11*t+2)+5*sin(31*t)'"
    yield Variant("camera", "hand-held shake", shake, plain="crop=iw-32:ih-32")
    yield Variant("camera", "zoom",
                  "scale=w='trunc(iw*(1+0.04*t)/2)*2':h='trunc(ih*(1+0.04*t)/2)*2':eval=frame,crop=%s" %
                  "{w}:{h}")
    ramp = "setpts='PTS*(1.25-0.25*sin(2*T))'"
    yield Variant("camera", "speed ramp, resampled", f"{ramp},fps=24", plain=ramp)
