# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# docs/figures/tracking.png from the CSV file of bench_tracking:
#   gnuplot -e "csv='build/tracking.csv'; picture='docs/figures/tracking.png'" tests/bench/tracking.gp
set terminal pngcairo size 1500,480 font "Sans,11"
set output picture
set multiplot layout 1,3
set datafile separator ","
set logscale xy
set grid
set key off
set offsets graph 0.1, graph 0.25, graph 0.1, graph 0.15
set xlabel "median time of a frame, ms"
set style data points

# Columns of the cases that are averaged over, at 1280x720; 1: ms, 2: the error, 3: name.
rows(column) = "< awk -F, '$1 == 1280 && $3 == \"usual\" {print $5 \",\" $" . column . " \",\" $4}' " . csv
point = 'with points pt 7 ps 1.5 lc rgb "#0060ad"'
name = 'with labels left offset 0.8,0.4'

set title "Tracks, 1280×720"
set ylabel "mean end point error, px"
plot rows(8) using 1:2 @point, "" using 1:2:3 @name

set title "Velocity of the object, 1280×720"
set ylabel "95 % of errors are below, px a frame"
plot rows(14) using 1:2 @point, "" using 1:2:3 @name

set title "Time by size of the frame"
set xlabel "width, px"
set ylabel "median time of a frame, ms"
set offsets 0,0,0,0
set xrange [500:5000]
set xtics (640, 1280, 1920, 3840) rotate by -30
set key top left
names = system("awk -F, 'NR > 1 && !seen[$4]++ {printf \"%s \", $4}' " . csv)
size(pipeline) = "< awk -F, '$4 == \"" . pipeline . "\" && $3 == \"usual\" {print $1 \",\" $5}' " . csv
plot for [pipeline in names] size(pipeline) using 1:2 with linespoints pt 7 title pipeline noenhanced
unset multiplot
