# SPDX-License-Identifier: MIT
# Time of a plain loop over the links divided by the library's time, versus the number of links, one dot per
# measurement. The loop uses an array of links and an array of particles, for the same scene in the same order. Below
# the line the plain loop is faster. Brown: sheets with links, or links and particles, in random order.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" "440 + key_height(6)"
call plots."need.gp" ARG3 "kernel precision count speedup"
bench = ARG3

array kernels[6] = ["leapfrog_rope_16", "leapfrog_sheet_16", "leapfrog_jelly_16", "leapfrog_sheet_16_damping", \
    "leapfrog_sheet_1_links_shuffled", "leapfrog_sheet_1_shuffled"]
array titles[6] = ["rope", "sheet", "jelly", "sheet, damped", "links shuffled", "all shuffled"]
array looks[6] = [types[1], types[1], types[1], types[1], sundials, sundials]
array markers[6] = [7, 5, 9, 4, 10, 12]
speedup(k) = strcol("kernel") eq kernels[k] && strcol("precision") eq "double" ? column("speedup") : NaN

set datafile missing NaN # joins the points of a kernel whose rows are not neighbours
set logscale xy
set xrange [0.7:1e7]
set yrange [*<0.25:8<*]
set format x "10^{%T}"
set xlabel "links"
set ylabel "speedup over plain loop"
set ytics (0.125, 0.25, 0.5, 1, 2, 4, 8, 16)
call plots."key.gp" 6
set output ARG1
plot 1 with lines linetype exact linewidth 2 notitle, \
     for [k = 1:6] bench using "count":(speedup(k)) with linespoints linetype looks[k] dashtype solid linewidth 1.5 pointtype markers[k] pointsize 1.1 title titles[k]
