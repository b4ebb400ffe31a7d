# SPDX-License-Identifier: MIT
# Position over the last ten seconds of the long run. The broad grey line is the exact solution. Euler overshoots it,
# and the lines of all other methods coincide with it.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "390 + key_height(methods + 1)"
runs = ARG3
call plots."need.gp" runs "t_s x_m exact_x_m" methods

set xlabel "time / s"
set ylabel "position / m"
set xrange [990:1000]
set yrange [-1.2:1.2]
set xtics 2
set ytics 0.5
entries = methods + 1
call plots."key.gp" entries
set output ARG1
plot file(runs, 1) using "t_s":"exact_x_m" with lines linetype grid linewidth 9 title "exact", \
     for [m = 1:methods] file(runs, m) using "t_s":"x_m" with lines linetype types[m] linewidth 2 title labels[m]
