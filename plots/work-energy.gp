# SPDX-License-Identifier: MIT
# The ideal spring after 10⁴ periods: error of the energy, relative to what it was, against run time. With long steps
# RK4 loses all of it, while leapfrog's error depends on the step alone, not on how long the run is. Grey: GSL.
call system("dirname '".ARG0."'")."/style.gp" ARG1 520
call plots."need.gp" ARG2 "problem solver effort time_s energy_error"
file = ARG2
array solvers[5] = ["leapfrog", "rk4", "gsl-rk4", "gsl-rk8pd", "gsl-rk8pd-adaptive"]
array titles[5] = ["leapfrog", "RK4", "GSL rk4", "GSL rk8pd", "… adaptive"]
array markers[5] = [5, 9, 4, 6, 8]
is(solver) = strcol("problem") eq "ideal-10000" && strcol("effort") eq "sweep" && strcol("solver") eq solver
seconds(solver) = is(solver) ? column("time_s") : NaN

set datafile missing NaN
set logscale xy
set format xy "10^{%T}"
set yrange [1e-13:3]
set ytics 1e3
set mxtics 1
set mytics 1
set xlabel "run time / s"
set ylabel "error of the energy"
set key tmargin center Left reverse samplen 1.5 maxrows 3
set output ARG1
plot for [s = 1:2] file using (seconds(solvers[s])):"energy_error" with linespoints linetype s + 1 linewidth 1.5 \
         dashtype solid pointsize 0.6 title titles[s], \
     for [s = 3:5] file using (seconds(solvers[s])):"energy_error" with linespoints linetype theory dashtype solid \
         linewidth 0.8 pointtype markers[s] pointsize 0.6 title titles[s]
