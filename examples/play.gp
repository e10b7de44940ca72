# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# What a playback was like: draws `frames` and `ticks` into `png`, headed by `title`. play.cpp writes
# the two files; without a device `ticks` is an empty string. Panels as in Fig. 6 to 10 of the paper:
# position, velocity, force; then the strings.
set terminal pngcairo size 1400,1400 font "sans,12"
set output png
set encoding utf8

set linetype 1 linecolor rgb "#0b5fa5" linewidth 1.5  # x
set linetype 2 linecolor rgb "#d9541e" linewidth 1.5  # y
# One colour a string, from Okabe and Ito's set for colour-blind readers.
array colours[8] = ["#e69f00", "#56b4e9", "#009e73", "#999933", "#0072b2", "#d55e00", "#cc79a7", \
                    "#000000"]

set style data lines
set grid linecolor rgb "#d8d8d8" linetype 1 linewidth 0.5
set key at graph 1.02, graph 0.95 left top Left reverse noenhanced samplen 2 spacing 1.2
set border 3 linecolor rgb "#606060"
set tics nomirror

set multiplot layout 5,1 title title . ": motion felt at the grip" noenhanced font ",15" margins 0.08,0.83,0.05,0.95 spacing 0.03

stats frames using 1 nooutput name "time"
set xrange [time_min : time_max > time_min ? time_max : time_min + 1]
set format x ""

set ylabel "position, px\n(integral of velocity)"
plot frames using 1:2 title "x, right", frames using 1:3 title "y, up"

set ylabel "velocity, px/s"
plot frames using 1:4 title "x, right", frames using 1:5 title "y, up"

wanted(axis) = axis . " wanted"
delivered(axis) = axis . " at the grip"
# What a hand does not feel: kFeltForce_N of core/force/force_limit.h.
set object 1 rectangle from graph 0, first -0.04 to graph 1, first 0.04 behind \
    fillcolor rgb "#ececec" fillstyle solid noborder
set ylabel "force, N"
do for [axis = 1:2] {
    name = axis == 1 ? "x" : "y"
    if (strlen(ticks)) {
        plot frames using 1:(column(5 + axis)) with points pointtype 7 pointsize 0.5 \
                 linecolor rgb "#a0a0a0" title wanted(name), \
             ticks using 1:(column(1 + axis)) linetype axis title delivered(name), \
             NaN with boxes fillstyle solid linecolor rgb "#ececec" title "too weak to feel"
    } else {
        plot frames using 1:(column(5 + axis)) linetype axis title wanted(name)
    }
}
unset object 1

if (strlen(ticks)) {
    set format x "%g"
    set xlabel "running time, s"
    set ylabel "string tension, N"
    set yrange [0:*]
    plot for [i=0:7] ticks using 1:(column(4 + i)) linewidth 1.2 linecolor rgb colours[i + 1] \
             title sprintf("string %d", i)
}
