# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# docs/figures/solvers.png from what bench_tension and bench_pose print:
#   gnuplot -e "folder='.'; picture='docs/figures/solvers.png'" tests/bench/solvers.gp
# with tension.txt and pose.txt in `folder`.
set terminal pngcairo size 1200,480 font "Sans,11"
set output picture
set multiplot layout 1,2
set logscale xy
set grid
set key off
set offsets graph 0.05, graph 0.3, graph 0.25, graph 0.1
set xlabel "median time (ns)"
set format y "10^{%T}"

# Names have spaces: numbers are counted from the end of the line.
block(name, columns) = "< awk '/" . name . "/ {on = 1; next} /^$/ {on = 0} on && /[0-9]$/ {" . \
  "n = $0; sub(/  +[0-9].*/, \"\", n); gsub(/ /, \"_\", n); print " . columns . ", n}' "

spaced(s) = strstrt(s, "_") == 0 ? s : s[1:strstrt(s, "_") - 1] . " " . spaced(s[strstrt(s, "_") + 1:*])

set title "Tensions, 1 kHz trajectory"
set ylabel "largest relative KKT residual"
plot block("^1 kHz trajectory", "$(NF-6), $(NF-1)") . folder . "/tension.txt" \
  using 1:2 with points pt 7 ps 1.5 lc rgb "#0060ad", \
  "" using 1:2:(" " . spaced(strcol(3))) with labels left rotate by 25 offset 0.8,0.4

set title "Poses, cold start in 95 % of the box, turned by 60 to 80°"
set ylabel "not found, of 1000"
set format y "%g"
set yrange [0.5:500]
plot block("^cold start.*60-80 deg", "$(NF-3), $NF") . folder . "/pose.txt" \
  using 1:(column(2) > 0 ? column(2) : 0.5) with points pt 7 ps 1.5 lc rgb "#0060ad", \
  "" using 1:(column(2) > 0 ? column(2) : 0.5):(" " . spaced(strcol(3))) with labels left rotate by 25 offset 0.8,0.4
unset multiplot
