# What a playback was like: draws `frames` and `ticks` into `png`, headed by `title`; play.cpp writes
# the two files; without a device there are no `ticks`. Panels as in Fig. 6 to 10 of the paper: position, velocity, force; then the strings.
set terminal pngcairo size 1400,1500 font "sans,11" linewidth 1.2
set output png
set encoding utf8

set linetype 1 linecolor rgb "#0b5fa5"  # x
set linetype 2 linecolor rgb "#d9541e"  # y

set style data lines
set grid linecolor rgb "#d8d8d8" linetype 1 linewidth 0.5
set key outside right top noenhanced spacing 1.2 width 1
set border 3 linecolor rgb "#606060"
set tics nomirror
set lmargin 11
set rmargin 22
set autoscale xfix

set multiplot layout 5,1 title title noenhanced font ",14"

stats frames using 1 nooutput name "time"
set xrange [time_min:time_max]
set format x ""

set ylabel "position, px\n(integral of velocity)"
plot frames using 1:2 title "x, right", frames using 1:3 title "y, up"

set ylabel "velocity felt, px/s"
plot frames using 1:4 title "x, right", frames using 1:5 title "y, up"

set ylabel "force x, N"
plot frames using 1:6 with points pointtype 7 pointsize 0.4 linecolor rgb "#9a9a9a" \
         title "wanted, a frame", \
     strlen(ticks) ? ticks : frames using 1:(strlen(ticks) ? $2 : NaN) linetype 1 title "at the grip"

set ylabel "force y, N"
plot frames using 1:7 with points pointtype 7 pointsize 0.4 linecolor rgb "#9a9a9a" \
         title "wanted, a frame", \
     ticks using 1:3 linetype 2 title "at the grip"

set format x "%g"
set xlabel "running time, s"
set ylabel "string tension, N"
plot for [i=0:7] ticks using 1:(column(4 + i)) linetype 3 + i title sprintf("string %d", i)
