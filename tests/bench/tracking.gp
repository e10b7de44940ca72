# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# docs/figures/tracking.png from the tables of docs/tables-tracking.md, which bench_tracking has printed:
#   gnuplot -e "page='docs/tables-tracking.md'; picture='docs/figures/tracking.png'" tests/bench/tracking.gp
set encoding utf8
# Letters are legible at a width of 700 pixels.
set terminal pngcairo size 1500,720 font "DejaVu Sans,15"
set output picture
set multiplot
set logscale xy
set grid linecolor rgb "#d8d8d8" linetype 1 linewidth 0.5
set border 3 linecolor rgb "#606060"
set tics nomirror
set key off

# Rows of the n-th pipeline in the tables by size: width, ms, mean end point error, 95 % of B.
rows(n) = "< awk -F'|' -v n=" . n . " '/^### [0-9]+x/ {split($1, t, /[ x]/); width = t[2]; row = 0} " . \
          "/^### [^0-9]/ {width = 0} width && NF > 10 && !/---/ && !/pipeline/ " . \
          "{if (row++ == n) print width, $3, $6, $12}' " . page
name(n) = system("awk -F'|' '/^### [0-9]/ {inside = 1} inside && NF > 10 && !/---/ && !/pipeline/ " . \
                 "{if (row++ == " . n . ") {gsub(/^ +| +$/, \"\", $2); print $2; exit}}' " . page)
last = 8

# One colour and one shape a pipeline, the same in all three plots.
array colours[9] = ["#7a7a7a", "#d55e00", "#a03000", "#56b4e9", "#0072b2", "#0b2e59", "#cc79a7", "#e69f00", "#000000"]
array shapes[9] = [5, 7, 7, 9, 9, 9, 13, 4, 6]

at_720(n) = rows(n) . " | grep ^1280"
set xlabel "median time of a frame, ms"
set bmargin at screen 0.36
set tmargin at screen 0.93

set title "Tracks, 1280×720"
set ylabel "mean end point error, px"
set lmargin at screen 0.085
set rmargin at screen 0.30
plot for [n=0:last] at_720(n) using 2:3 with points pointtype shapes[n + 1] pointsize 1.8 \
     linecolor rgb colours[n + 1]

set title "Velocity of the object, 1280×720"
set ylabel "95 % quantile of the error, px"
set lmargin at screen 0.40
set rmargin at screen 0.63
plot for [n=0:last] at_720(n) using 2:4 with points pointtype shapes[n + 1] pointsize 1.8 \
     linecolor rgb colours[n + 1]

set title "Time by size of the frame"
set xlabel "width, px"
set ylabel "median time of a frame, ms"
set lmargin at screen 0.74
set rmargin at screen 0.98
set xrange [560:4400]
set xtics (640, "" 1280, 1920, 3840)
set key at screen 0.03, screen 0.19 left top Left reverse noenhanced samplen 2 spacing 1.3 maxrows 3 width 2
plot for [n=0:last] rows(n) using 1:2 with linespoints pointtype shapes[n + 1] pointsize 1.3 \
     linewidth 1.5 linecolor rgb colours[n + 1] title name(n)
unset multiplot
