# SPDX-License-Identifier: MIT
# Position over the last ten seconds of the long run. Euler swings too far; leapfrog and RK4 cannot be told from the
# exact solution here.
call system("dirname '".ARG0."'")."/style.gp" ARG1
array runs[3] = [ARG2, ARG3, ARG4]
do for [m = 1:3] {
    call plots."need.gp" runs[m] "t_s x_m exact_x_m"
}

rows_apart = 50
set xlabel "time / s"
set ylabel "position / m"
set xrange [990:1000]
set yrange [-1.2:1.2]
set xtics 2
set ytics 0.5
set key horizontal outside top center samplen 1.5
set output ARG1
plot runs[euler] using "t_s":"exact_x_m" with lines linetype exact title "exact", \
     runs[euler] using "t_s":"x_m" with lines linetype euler title "Euler", \
     runs[leapfrog] every rows_apart using "t_s":"x_m" with points linetype leapfrog title "leapfrog", \
     runs[rk4] every rows_apart::rows_apart/2 using "t_s":"x_m" with points linetype rk4 title "RK4"
