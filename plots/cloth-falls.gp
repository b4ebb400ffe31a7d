# SPDX-License-Identifier: MIT
# The cloth of the figure above, as fast as it falls.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" 360 4
call plots."grid.gp" ARG3 1
unset key
unset border
unset tics
unset grid
set xrange [-0.1:2.1]
set yrange [-1.6:2]
set zrange [-2.1:0.1]
set view equal xyz
set view 74,35,2.2
set xyplane at -2.1
set output ARG1
do for [f = 0:frames - 1] {
    set label 1 sprintf("%.2f s", time_at(f)) at screen 0.03,0.93
    splot sample [u=0:edge-1][v=0:edge-1] '++' using (x_at(f, $1, $2)):(y_at(f, $1, $2)):(z_at(f, $1, $2)) \
          with lines linetype types[1] linewidth 1 dashtype solid
}
