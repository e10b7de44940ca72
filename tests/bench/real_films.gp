# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# docs/figures/real_films.png from the CSV file of real_films.py: name, ms, right, wrong, false.
#   gnuplot -e "csv='build/real_films.csv'; picture='docs/figures/real_films.png'" tests/bench/real_films.gp
set encoding utf8
set terminal pngcairo size 1400,560 font "DejaVu Sans,13"
set output picture
set multiplot layout 1,2 margins 0.07,0.98,0.14,0.9 spacing 0.09
set logscale x
set grid linecolor rgb "#d8d8d8"
set border 3 linecolor rgb "#606060"
set tics nomirror
set xrange [0.2:30]
set yrange [-3:103]
set xlabel "processor time of a frame, ms"
set ylabel "% of frames"
set datafile separator ","
rows = int(system("wc -l < '" . csv . "'"))
name(row) = system(sprintf("sed -n %dp '%s' | cut -d, -f1", row, csv))
# Colours that the colour-blind can tell, and a shape for each.
array colours[6] = ["#0072b2", "#56b4e9", "#009e73", "#000000", "#d55e00", "#cc79a7"]
array shapes[6] = [7, 9, 11, 5, 13, 15]

set title "Right, where an object moves: higher is better"
set key at graph 0.97, graph 0.62 right top Left reverse
plot for [row = 1:rows] csv every ::row-1::row-1 using 2:3 with points pointtype shapes[(row - 1) % 6 + 1] pointsize 2.4 \
  linecolor rgb colours[(row - 1) % 6 + 1] title name(row) noenhanced

set title "False force, where only the camera moves: lower is better"
set key off
plot for [row = 1:rows] csv every ::row-1::row-1 using 2:5 with points pointtype shapes[(row - 1) % 6 + 1] pointsize 2.4 \
  linecolor rgb colours[(row - 1) % 6 + 1] notitle
unset multiplot
