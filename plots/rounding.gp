# SPDX-License-Identifier: MIT
# Rounding error versus number of steps, from eight starts: the distance between the computed state and the same method
# in exact arithmetic. With a step of {{ data('rounding-leapfrog').rows[0].dt_s }} s, a power of two, leapfrog's
# coefficient dt ω²/2 is exact. The rounding errors are then independent, and their sum grows like √n. With a step of {{
# data('rounding-decimal').rows[0].dt_s }} s the coefficient is rounded once for all steps. The resulting errors have
# the same sign and grow like n. Compensated sums remove most of the first kind of error and none of the second.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog rk4" 900
plain = ARG3
compensated = ARG4
call plots."need.gp" plain "steps state_error" 3
call plots."need.gp" compensated "steps state_error" 3
array titles[3] = [labels[1].", dt = 1/128 s", labels[2].", dt = 1/128 s", labels[1].", dt = 0.01 s"]
array colours[3] = [types[1], types[2], types[1]]
epsilon = 2.0**-52

set logscale xy
set xrange [6e3:2e9]
set yrange [5e-18:2e-8]
set xtics 1e4,10
set ytics 1e-16,1e2
set mxtics 1
set mytics 1
set format y "10^{%T}"
set ylabel "error / amplitude"
set key at screen 0.18,0.99 left top Left reverse samplen 1
set output ARG1
set multiplot layout 3,1 margins 0.23,0.95,0.095,0.92 spacing 0.03
do for [i = 1:3] {
    set label 1 titles[i] at graph 0.97,0.08 right
    set label 2 "√n ε" at 3e4,epsilon*sqrt(3e4) offset 0,0.9 textcolor linetype theory
    set label 3 "n ε" at 1e7,epsilon*1e7 offset -3.5,0.2 textcolor linetype theory
    if (i < 3) {
        set format x ""
    } else {
        set format x "10^{%T}"
        set xlabel "steps n"
    }
    plot epsilon*sqrt(x) with lines linetype theory notitle, epsilon*x with lines linetype theory notitle, \
         file(plain, i) using "steps":"state_error" with points linetype colours[i] pointsize 0.7 title "plain sums, as in the library", \
         file(compensated, i) using "steps":"state_error" with points linetype exact pointtype 6 pointsize 0.9 title "compensated sums"
    unset key
}
unset multiplot
