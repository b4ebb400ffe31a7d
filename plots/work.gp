# SPDX-License-Identifier: MIT
# Work–precision diagram of the long run: position error at the end versus run time, for different numbers of steps.
# Rings mark the smallest number of steps from which the error never again exceeds Euler's error (dotted line).
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "390 + key_height(methods)"
work = ARG3
call plots."need.gp" work "problem solver effort time_s error_x"

is(solver, effort) = strcol("problem") eq "seed-1000s" && strcol("solver") eq solver && strcol("effort") eq effort
stats work using (is("euler", "equal") ? column("error_x") : NaN) nooutput
euler_error = STATS_max

set logscale xy
set yrange [1e-15:10]
set xlabel "run time / s"
set ylabel "error in position / m"
set format xy "10^{%T}"
set ytics 1e3
set mytics 1
call plots."key.gp" methods
set output ARG1
plot euler_error with lines linetype theory notitle, \
     for [m = 1:methods] work using (is(names[m], "sweep") ? column("time_s") : NaN):"error_x" with lines linetype types[m] title labels[m], \
     for [m = 1:methods] work using (is(names[m], "equal") ? column("time_s") : NaN):"error_x" \
         with points linetype types[m] pointtype 6 pointsize 1.6 notitle
