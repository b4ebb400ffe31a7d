# SPDX-License-Identifier: MIT
# A cloth is pinned at two corners (dots) and released from a horizontal position. Leapfrog, steps of {{
# step('cloth-energy') }}.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" 470
call plots."need.gp" ARG3 "t_s"
instants = "0.2 0.4 0.6 0.8 1.2 2" # [s]
array firsts[words(instants)]
do for [i = 1:words(instants)] {
    seconds = word(instants, i)
    call plots."instant.gp" ARG3 seconds
    firsts[i] = first
}
call plots."grid.gp" ARG3

unset key
unset border
unset tics
unset grid
set xrange [-0.1:2.1]
set yrange [-1.6:2]
set zrange [-2.1:0.1]
set view equal xyz
set view 74,35,1.3
set xyplane at -2.1
set output ARG1
set multiplot
set margins 0,0,0,0
set size 0.6,0.9 # panels overlap where nothing is
do for [corner = 0:1] {
    set label corner + 2 "" at x_at(0, corner*(edge - 1), 0),0,0 point linetype exact pointtype 7 pointsize 0.6 front
}
set arrow from 0,0,-1 to 2,0,-1 heads size 0.06,20 linetype exact
set label 4 "2 m" at 1,0,-1.35 center
do for [i = 1:words(instants)] {
    f = firsts[i]/particles
    set origin (i - 1)%3/3.0 - 0.1,0.25 - 0.5*((i - 1)/3)
    set label 1 word(instants, i)." s" at screen (i - 1)%3/3.0 + 0.03,0.96 - 0.5*((i - 1)/3)
    splot sample [u=0:edge-1][v=0:edge-1] '++' using (x_at(f, $1, $2)):(y_at(f, $1, $2)):(z_at(f, $1, $2)) \
          with lines linetype types[1] linewidth 0.7 dashtype solid
    unset arrow
    unset label 4
}
unset multiplot
