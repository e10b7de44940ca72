# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# docs/figures/real_films.png from the CSV file of real_films.py: name, ms, right, wrong, false.
#   gnuplot -e "csv='build/real_films.csv'; picture='docs/figures/real_films.png'" tests/bench/real_films.gp
set terminal pngcairo size 1000,480 font "Sans,11"
set output picture
set multiplot layout 1,2
set datafile separator ","
set logscale x
set grid
set xrange [0.2:20]
set yrange [0:100]
set xlabel "processor time of a frame, ms"
set ylabel "% of frames"
rows = int(system("wc -l < '" . csv . "'"))
name(row) = system(sprintf("sed -n %dp '%s' | cut -d, -f1", row, csv))
set key at graph 0.02, graph 0.75 left top Left reverse

set title "Right where the object moves"
plot for [row = 1:rows] csv every ::row-1::row-1 using 2:3 with points pt row + 3 ps 1.7 title name(row) noenhanced

set title "False force where only the camera moves"
set key off
plot for [row = 1:rows] csv every ::row-1::row-1 using 2:5 with points pt row + 3 ps 1.7 notitle
unset multiplot
