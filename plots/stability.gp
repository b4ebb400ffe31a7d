# SPDX-License-Identifier: MIT
# The largest stable step, as ω dt, over the damping ratio. Marks: found by taking steps and watching whether they grow,
# without any formula. Lines: theory. Euler is stable only where there is damping, and best at critical damping; leapfrog
# does not mind damping at all; RK4's limit rises before it falls.
call system("dirname '".ARG0."'")."/style.gp" ARG1
call plots."need.gp" ARG2 "method damping_ratio limit_measured limit_theory"
array names[3] = ["euler", "leapfrog", "rk4"]
array titles[3] = ["Euler", "leapfrog", "RK4"]

of(m, value) = strcol("method") eq names[m] && column("damping_ratio") > 0 ? value : NaN

set datafile missing NaN # a line runs on past the rows of other methods
set logscale x
set xrange [0.008:125]
set yrange [0:3.3]
set format x "10^{%T}"
set xtics 10
set mxtics 1
set xlabel "damping ratio ζ"
set ylabel "largest stable ω dt"
unset key
set label titles[euler] at 0.035,0.45 textcolor linetype euler
set label titles[leapfrog] at 12,2.18 textcolor linetype leapfrog
set label titles[rk4] at 0.012,3.05 textcolor linetype rk4
set output ARG1
plot for [m = 1:3] ARG2 using "damping_ratio":(of(m, column("limit_theory"))) with lines linetype theory dashtype solid, \
     for [m = 1:3] ARG2 using "damping_ratio":(of(m, column("limit_measured"))) with points linetype m pointsize 0.45
