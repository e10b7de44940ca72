# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# The curves of a stroke across a picture: draws the files `relief` and `ticks`, which touch.cpp
# writes, into `png` under the heading `title`.
set terminal pngcairo size 1100,1300 font "sans,12"
set output png
set encoding utf8
set datafile separator ","

set grid linecolor rgb "#d8d8d8" linetype 1 linewidth 0.5
set border 3 linecolor rgb "#606060"
set tics nomirror
set multiplot layout 3,1 title title . ": touched from left to right" noenhanced font ",15" \
    margins 0.09,0.84,0.06,0.95 spacing 0.07

set xlabel "x, mm"
set ylabel "y, mm"
set cblabel "relief, mm"
set palette gray
set autoscale fix
set key off
plot relief using 1:2:3 skip 1 with image, \
     ticks using 2:3 skip 1 with lines linewidth 2 linecolor rgb "#d9541e"

set key at graph 1.02, graph 0.95 left top Left reverse noenhanced samplen 2 spacing 1.2
set xlabel "time, s"
set ylabel "height, mm"
plot ticks using 1:5 skip 1 with lines linewidth 2 linecolor rgb "#a0a0a0" title "surface", \
     ticks using 1:4 skip 1 with lines linewidth 1.5 linecolor rgb "#d9541e" title "grip"

set ylabel "force on the hand, N"
plot ticks using 1:6 skip 1 with lines linewidth 1.5 linecolor rgb "#0b5fa5" title "x, right", \
     ticks using 1:7 skip 1 with lines linewidth 1.5 linecolor rgb "#009e73" title "y, up", \
     ticks using 1:8 skip 1 with lines linewidth 1.5 linecolor rgb "#d9541e" title "z, to viewer"
