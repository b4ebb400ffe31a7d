# SPDX-License-Identifier: MIT
# The last six hundredths of a second before the end of the long run. Leapfrog's and RK4's markers lie inside the rings
# of the exact solution; Euler's are beside them.
call system("dirname '".ARG0."'")."/style.gp" ARG1
array runs[3] = [ARG2, ARG3, ARG4]
do for [m = 1:3] {
    call plots."need.gp" runs[m] "t_s x_m exact_x_m"
}

first = 999.935
last = 999.995
picked(t) = t > first && t < last ? t : NaN
set xlabel "time / s"
set ylabel "position / m"
set xrange [first:last]
set xtics 999.94,0.02
set format x "%.2f"
set format y "%.2f"
set yrange [0.56:0.68]
set ytics 0.02
set key top right
set output ARG1
plot runs[euler] using (picked(column("t_s"))):"x_m" with points linetype euler title "Euler", \
     runs[euler] using (picked(column("t_s"))):"exact_x_m" with points linetype exact pointtype 6 pointsize 2.3 title "exact", \
     runs[leapfrog] using (picked(column("t_s"))):"x_m" with points linetype leapfrog pointtype 4 pointsize 1.3 title "leapfrog", \
     runs[rk4] using (picked(column("t_s"))):"x_m" with points linetype rk4 pointsize 0.7 title "RK4"
