# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The films of regression.py, which ffmpeg makes: a textured disc in front of a pan, and the pan alone."""

import subprocess

RATE = 24
SIZE = "640x360"
MADE_S = 4
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
