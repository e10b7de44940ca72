# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# The curves of a playback: draws `frames` and `ticks` into `png` under the heading `title`.
# play.cpp writes the two files; without a device `ticks` is an empty string. Panels as in Fig. 6 to
# 10 of the paper: position, velocity, force; then force towards the viewer and torque if a hand
# could feel them (`depth`, `roll` are not empty); then the strings. Axes of force go to ±
# `max_force`, those of torque to ± the torque that this force has at `arm`.
panels = 4 + (strlen(depth) > 0) + (strlen(roll) > 0) + (strlen(ticks) > 0)
set terminal pngcairo size 1400,280 * panels font "DejaVu Sans,12"
set output png
set encoding utf8

set linetype 1 linecolor rgb "#0b5fa5" linewidth 1.5  # x
set linetype 2 linecolor rgb "#d9541e" linewidth 1.5  # y
# One colour for each string, from Okabe and Ito's set for colour-blind readers.
array colours[8] = ["#e69f00", "#56b4e9", "#009e73", "#999933", "#0072b2", "#d55e00", "#cc79a7", \
                    "#000000"]

set style data lines
set grid linecolor rgb "#d8d8d8" linetype 1 linewidth 0.5
set key at graph 1.02, graph 0.95 left top Left reverse noenhanced samplen 2 spacing 1.2
set border 3 linecolor rgb "#606060"
set tics nomirror

set multiplot layout panels,1 title title . ": motion felt at the grip" noenhanced font ",15" \
    margins 0.1,0.84,0.25 / panels,1 - 0.25 / panels spacing 0.15 / panels

stats frames using 1 nooutput name "time"
set xrange [time_min : time_max > time_min ? time_max : time_min + 1]
set format x ""

set yrange [*<-1 : 1<*]  # not empty if nothing moves
set ylabel "position, px\n(integral of velocity)"
plot frames using 1:2 title "x, right", frames using 1:3 title "y, up"

set ylabel "velocity, px/s"
plot frames using 1:4 title "x, right", frames using 1:5 title "y, up"

# Force and torque: `limit` at the ends of the axis, `felt` is what a hand feels, `in_unit` of them in
# one of the unit. Column `wanted` of frames, `given` of ticks.
limit = max_force > 0 ? real(max_force) : 0.1
felt = 0.04  # kFeltForce_N of core/analysis/force_limit.h
grey = "#a0a0a0"
draw = 'plot frames using 1:(in_unit * column(wanted)) with points pointtype 7 pointsize 0.5 linecolor rgb grey \
             title "wanted", \
         ticks using 1:(in_unit * column(given)) linetype line title "at the grip", \
         NaN with boxes fillstyle solid linecolor rgb "#ececec" title "too weak to feel"'
draw_wanted = 'plot frames using 1:(in_unit * column(wanted)) linetype line title "wanted"'
if (strlen(ticks) == 0) { draw = draw_wanted }

set linetype 3 linecolor rgb "#009e73" linewidth 1.5  # z
set linetype 4 linecolor rgb "#7b3294" linewidth 1.5  # about z
lowest = strlen(roll) ? 4 : strlen(depth) ? 3 : 2
array labels[4] = ["force x, N\n(right)", "force y, N\n(up)", "force z, N\n(towards you)", \
                   "torque, mNm\n(about z)"]
do for [line = 1:4] {
    if ((line == 3 && strlen(depth) == 0) || (line == 4 && strlen(roll) == 0)) { continue }
    in_unit = line == 4 ? 1000 : 1
    end = limit * (line == 4 ? 1000 * arm : 1)
    band = felt * (line == 4 ? 1000 * arm : 1)
    wanted = 5 + line
    given = 1 + line
    set ylabel labels[line]
    set yrange [-end : end]
    set object 1 rectangle from graph 0, first -band to graph 1, first band behind \
        fillcolor rgb "#ececec" fillstyle solid noborder
    if (strlen(ticks) == 0 && line == lowest) {
        set format x "%g"
        set xlabel "running time, s"
    }
    eval draw
}
unset object 1

if (strlen(ticks)) {
    set format x "%g"
    set xlabel "running time, s"
    set ylabel "string tension, N"
    set yrange [0:*]
    plot for [i=0:7] ticks using 1:(column(6 + i)) linewidth 1.2 linecolor rgb colours[i + 1] \
             title sprintf("string %d", i)
}
