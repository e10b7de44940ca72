# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Fig. 6 to 10 of the paper, from a rendered bouncing ball, drawn into `folder`.
# paper_figures.cpp writes `measured` (one row for each frame) and `analytic` (one row for each
# millisecond) with the columns time, position, velocity, acceleration, k, linear force, nonlinear
# force; upwards is positive. `gravity` is that of the scene, in px/s².
set encoding utf8
set grid linecolor rgb "#d8d8d8" linetype 1 linewidth 0.5
set border 3 linecolor rgb "#606060"
set tics nomirror
set key at graph 1.02, graph 0.95 left top Left reverse samplen 2 spacing 1.2
set style line 1 linecolor rgb "#b0b0b0" linewidth 3                         # analytic
set style line 2 linecolor rgb "#0b5fa5" linewidth 1 pointtype 7 pointsize 0.5   # measured
set xrange [0:*]

# A panel: column of both files, for the analytic curve and the measured points.
panel(column) = sprintf("plot analytic using 1:%d with lines linestyle 1 title 'analytic', " . \
                        "measured using 1:%d with points linestyle 2 title 'measured'", column, column)
start(name, height) = sprintf("set terminal pngcairo size 1100,%d font 'sans,12'; " . \
                              "set output folder . '/%s.png'", height, name)

eval start("fig6", 1000)
set multiplot layout 3,1 title "Fig. 6: motion of a bouncing ball" font ",14" \
    margins 0.1,0.84,0.06,0.93 spacing 0.04
set format x ""
set ylabel "(a) position, px"
eval panel(2)
set ylabel "(b) velocity, px/s"
eval panel(3)
set format x "%g"
set xlabel "time, s"
set ylabel "(c) acceleration, px/s²\n(impacts leave the axis)"
set yrange [-2 * gravity : gravity]
eval panel(4)
set autoscale y
unset multiplot

eval start("fig7", 420)
set rmargin at screen 0.84
set title "Fig. 7: gain k = Fmax / Vmax(T) of the linear controller" font ",14"
set ylabel "k, N per px/s"
set logscale y
eval panel(5)
unset logscale y
set rmargin
unset title

do for [figure in "8 10"] {
    linear = figure eq "8"
    eval start("fig" . figure, 720)
    set multiplot layout 2,1 \
        title sprintf("Fig. %s: force of the %s controller", figure, linear ? "linear" : "nonlinear") \
        font ",14" margins 0.1,0.84,0.09,0.91 spacing 0.05
    set format x ""
    unset xlabel
    set ylabel "(a) position, px"
    eval panel(2)
    set format x "%g"
    set xlabel "time, s"
    set ylabel "(b) force, N"
    eval panel(linear ? 6 : 7)
    unset multiplot
}

eval start("fig9", 420)
set rmargin at screen 0.84
set title "Fig. 9: force of the nonlinear controller, (2 Fmax / π) atan(α V)" font ",14"
set xlabel "speed V, px/s"
set ylabel "force, N"
plot analytic using (abs($3)):(abs($7)) with points pointtype 7 pointsize 0.2 \
         linecolor rgb "#b0b0b0" title 'analytic', \
     measured using (abs($3)):(abs($7)) with points linestyle 2 title 'measured'
set rmargin
unset title
