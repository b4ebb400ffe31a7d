# SPDX-License-Identifier: MIT
# Position over the last ten seconds of the long run. Euler swings too far; a method that has no line of its own cannot
# be told from the exact solution here.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "390 + key_height(methods + 1)"
runs = ARG3
call plots."need.gp" runs "t_s x_m exact_x_m" methods

visible = 0.01 # [m]
array seen[methods]
do for [m = 1:methods] {
    stats file(runs, m) using (abs(column("x_m") - column("exact_x_m"))) nooutput
    seen[m] = STATS_max > visible
}

rows_apart = 20 # from the marker of one method to that of the next
set xlabel "time / s"
set ylabel "position / m"
set xrange [990:1000]
set yrange [-1.2:1.2]
set xtics 2
set ytics 0.5
entries = methods + 1
call plots."key.gp" entries
set output ARG1
plot file(runs, 1) using "t_s":"exact_x_m" with lines linetype exact title "exact", \
     for [m = 1:methods] file(runs, m) using (seen[m] ? column("t_s") : NaN):"x_m" \
         with lines linetype types[m] dashtype solid linewidth 1.5 notitle, \
     for [m = 1:methods] file(runs, m) every rows_apart*methods::rows_apart*(m - 1) using "t_s":"x_m" \
         with points linetype types[m] title labels[m]
