# SPDX-License-Identifier: MIT
# The last six hundredths of a second before the end of the long run. The markers of all methods except Euler lie inside
# the rings of the exact solution.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "390 + key_height(methods + 1)"
runs = ARG3
call plots."need.gp" runs "t_s x_m exact_x_m" methods

first = 999.935
last = 999.995
picked(t) = t > first && t < last ? t : NaN
size(m) = 1.7*0.7**(m - 1)
set xlabel "time / s"
set ylabel "position / m"
set xrange [first:last]
set xtics 999.94,0.02
set format x "%.2f"
set format y "%.2f"
set yrange [0.56:0.68]
set ytics 0.02
entries = methods + 1
call plots."key.gp" entries
set output ARG1
plot file(runs, 1) using (picked(column("t_s"))):"exact_x_m" with points linetype exact pointtype 6 pointsize 2.1 title "exact", \
     for [m = 1:methods] file(runs, m) using (picked(column("t_s"))):"x_m" \
         with points linetype types[m] pointsize size(m) title labels[m]
