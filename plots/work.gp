# SPDX-License-Identifier: MIT
# The same long run in more and more steps: the error in position at its end against the time the run took. Rings mark
# the smallest numbers of steps from which on the error never exceeds Euler's, the dotted line.
call system("dirname '".ARG0."'")."/style.gp" ARG1
call plots."need.gp" ARG2 "problem solver effort time_s error_x"

array solvers[3] = ["euler", "leapfrog", "rk4"]
array names[3] = ["Euler", "leapfrog", "RK4"]
is(solver, effort) = strcol("problem") eq "seed-1000s" && strcol("solver") eq solver && strcol("effort") eq effort
array times[3]
do for [m = 1:3] {
    stats ARG2 using (is(solvers[m], "equal") ? column("time_s") : NaN) nooutput
    times[m] = STATS_max
}
stats ARG2 using (is("euler", "equal") ? column("error_x") : NaN) nooutput
euler_error = STATS_max

set logscale xy
set yrange [1e-15:10]
set xlabel "run time / s"
set ylabel "error in position / m"
set format xy "10^{%T}"
set ytics 1e3
set mytics 1
unset key
set label 1 names[euler] at times[euler],20*euler_error center textcolor linetype euler
set label 2 names[leapfrog] at 18*times[leapfrog],1e-3 textcolor linetype leapfrog
set label 3 names[rk4] at 30*times[rk4],1e-10 right textcolor linetype rk4
set output ARG1
plot euler_error with lines linetype theory, \
     for [m = 1:3] ARG2 using (is(solvers[m], "sweep") ? column("time_s") : NaN):"error_x" with lines linetype m, \
     for [m = 1:3] ARG2 using (is(solvers[m], "equal") ? column("time_s") : NaN):"error_x" \
         with points linetype m pointtype 6 pointsize 1.6
