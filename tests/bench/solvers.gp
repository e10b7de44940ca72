# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# docs/figures/solvers.png from the tables of docs/solvers.md:
#   gnuplot -e "page='docs/solvers.md'; picture='docs/figures/solvers.png'" tests/bench/solvers.gp
set encoding utf8
set terminal pngcairo size 1400,560 font "DejaVu Sans,13"
set output picture
set multiplot layout 1,2 margins 0.08,0.98,0.14,0.9 spacing 0.11
set logscale xy
set grid linecolor rgb "#d8d8d8"
set border 3 linecolor rgb "#606060"
set tics nomirror
set key off
set xlabel "median time of a solution, ns"

# Rows of the table that begins with a line: name, time, error. The n-th column after the name; spaces in numbers go.
rows(begin, time, error) = "< awk -F'|' '/^" . begin . "/ {on = 1; getline; next} !/^\\|/ {on = 0} on {" . \
  "t = $" . (time + 2) . "; e = $" . (error + 2) . "; sub(/\\/.*/, \"\", t); sub(/^.*, /, \"\", e); gsub(/ /, \"\", t); " . \
  "gsub(/ /, \"\", e); n = $2; gsub(/^ +| +$/, \"\", n); gsub(/ /, \"_\", n); print n, t, e}' " . page
spaced(s) = strstrt(s, "_") == 0 ? s : s[1:strstrt(s, "_") - 1] . " " . spaced(s[strstrt(s, "_") + 1:*])
here(s) = s[1:4] eq "here" ? 1 : 0
# Neighbours share a decade of both axes: some labels stand below their points.
above(n) = n == 0 || n == 5
high(n) = n == 2

tensions = rows("\\| solver \\| median ns \\| 99 % \\| max \\| max", 1, 6)
set title "String tensions: 4000 ticks at 1 kHz"
set ylabel "largest relative KKT residual"
set format y "10^{%T}"
set format x "10^{%T}"
set xrange [50:3e7]
set yrange [1e-17:1e4]
set arrow from 50, 1e-9 to 3e7, 1e-9 nohead linecolor rgb "#d55e00" dashtype 2
set label "above: a failure" at 2e7, 1e-9 right offset 0, 0.6 textcolor rgb "#d55e00"
# Timed in a run of its own, which states of its residual only that it never fails.
set label "DAQP 0.9.1, Q and c given\n(residual below the line)" at 421, 1e-9 left offset 1.2, -0.8
set object circle at 421, 1e-9 size graph 0.008 fillstyle empty border linecolor rgb "#000000"
plot tensions using 2:3:(here(strcol(1)) ? 0x0072b2 : 0xe69f00) with points pointtype 7 pointsize 2 linecolor rgb variable, \
  "" using 2:3:(above($0) ? " " . spaced(strcol(1)) : "") with labels left offset 0.8, 0.9, \
  "" using 2:3:(high($0) ? " " . spaced(strcol(1)) : "") with labels left offset 0.8, 2, \
  "" using 2:3:(above($0) || high($0) ? "" : " " . spaced(strcol(1))) with labels left offset 0.8, -0.9
unset arrow
unset label
unset object

set title "Poses: cold start in 95 % of the box, turned by 60 to 80°"
set ylabel "not found, of 1000"
set format y "%g"
set xrange [1000:1e5]
set yrange [0.5:500]
# The last row has a solver in each column.
last = "< awk -F'|' '/60–80°/ {for (i = 3; i <= 5; i++) {t = $i; e = $i; sub(/^.*, */, \"\", e); sub(/(\\/|,).*/, \"\", t); " . \
  "gsub(/ /, \"\", t); gsub(/ /, \"\", e); print (i == 3 ? \"here\" : i == 4 ? \"TinySolver\" : \"Ceres\"), t, e}}' " . page
plot last using 2:3:(here(strcol(1)) ? 0x0072b2 : 0xe69f00) with points pointtype 7 pointsize 2 linecolor rgb variable, \
  "" using 2:3:(" " . strcol(1)) with labels left offset 0.8, 0.9
unset multiplot
