# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Maps of what a device delivers of a wanted force of 3 N: draws `position` and `rotation` of the
# device `profile` into `png`. workspace/pose_map.cpp writes the two files. Top row: the grip moved
# in the plane of the screen; bottom row: rotated at the centre.
set terminal pngcairo size 1600,860 font "sans,16"
set output png
set encoding utf8
set datafile separator ","

# Viridis (van der Walt and Smith): perceptually uniform, and suitable for colour-blind readers. Bright is good: a
# moment is unwanted, so its columns have the palette reversed. Letters are legible at a width of 700 pixels.
set palette defined (0 "#440154", 1 "#472d7b", 2 "#3b528b", 3 "#2c728e", 4 "#21918c", \
                     5 "#28ae80", 6 "#5ec962", 7 "#addc30", 8 "#fde725")
set border linecolor rgb "#606060"
set tics out nomirror scale 0.4
unset key
set autoscale xfix
set autoscale yfix
set size ratio -1

# Panels in a row: column of the file, heading, largest value. Colour bars are above the top row.
array columns[5] = [3, 4, 6, 5, 7]
array names[5] = ["tension factor\n(white: none)", \
                  "force, N\ngst-spidar", "force, N\npublished", \
                  "moment, N mm\ngst-spidar", "moment, N mm\npublished"]
array largest[5] = [1, 3, 3, 100, 100]

n_moment = 4  # the first column of a moment

left(i) = 0.075 + 0.186 * (i - 1)
width = 0.155
bottom(row) = row == 1 ? 0.485 : 0.095
height = 0.295

stats position skip 1 using 1:2 nooutput
step(half_size) = half_size > 100 ? 100 : half_size > 50 ? 40 : half_size > 30 ? 20 : 10

set multiplot title profile . ": what is left of a wanted 3 N in the worst direction; bright is good" noenhanced font ",20"
do for [row = 1:2] {
    file = row == 1 ? position : rotation
    do for [i = 1:5] {
        set lmargin at screen left(i)
        set rmargin at screen left(i) + width
        set bmargin at screen bottom(row)
        set tmargin at screen bottom(row) + height
        set xlabel (row == 1 ? "x, mm" : "about x, °") offset 0,0.4
        set ylabel (i > 1 ? "" : row == 1 ? "y, mm" : "about y, °") offset 0.5,0
        set xtics row == 1 ? step(STATS_max_x) : 45
        set ytics row == 1 ? step(STATS_max_y) : 45
        set format y (i > 1 ? "" : "%g")
        set cbrange [0:largest[i]]
        set cbtics largest[i] / 2.0
        if (n_moment <= i) { set palette negative } else { set palette positive }
        if (row == 1) {
            set colorbox horizontal user origin screen left(i), screen 0.845 size screen width, screen 0.018
            set cbtics offset 0,0.6 scale 0.3
            set label 1 names[i] font ",17" at screen left(i) + width / 2, screen 0.92 center
        } else {
            unset colorbox
            unset label 1
        }
        n = columns[i]
        plot file skip 1 using 1:2:(n == 3 && column(n) <= 0 ? NaN : column(n)) with image
    }
}
unset multiplot
