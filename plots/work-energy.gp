# SPDX-License-Identifier: MIT
# The ideal spring after 10⁴ periods: error of the energy, relative to what it was, against run time. With long steps
# RK4 loses all of it, while leapfrog's error depends on the step alone, not on how long the run is. Grey: GSL.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "420 + key_height(methods + 3)"
work = ARG3
call plots."need.gp" work "problem solver effort time_s energy_error"
array others[3] = ["gsl-rk4", "gsl-rk8pd", "gsl-rk8pd-adaptive"]
array titles[3] = ["GSL rk4", "GSL rk8pd", "… adaptive"]
array markers[3] = [4, 6, 8]
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
entries = methods + 3
call plots."key.gp" entries
set output ARG1
plot for [m = 1:methods] work using (seconds(names[m])):"energy_error" with linespoints linetype types[m] linewidth 1.5 \
         dashtype solid pointsize 0.6 title labels[m], \
     for [s = 1:3] work using (seconds(others[s])):"energy_error" with linespoints linetype theory dashtype solid \
         linewidth 0.8 pointtype markers[s] pointsize 0.6 title titles[s]
