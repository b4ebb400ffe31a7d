# SPDX-License-Identifier: MIT
# Relative energy error versus run time for the ideal spring after ten thousand periods. With long steps RK4 loses all
# of the energy. The bound of leapfrog's energy error depends on the step, and not on the duration of the run. Open markers: GSL.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "420 + key_height(methods + 3)"
work = ARG3
call plots."need.gp" work "problem solver effort time_s energy_error"
call plots."externals.gp"
is(solver) = strcol("problem") eq "ideal-10000" && strcol("effort") eq "sweep" && strcol("solver") eq solver
seconds(solver) = is(solver) ? column("time_s") : NaN

set datafile missing NaN
set yrange [1e-13:3]
set xlabel "run time / s"
set ylabel "relative energy error"
entries = methods + 3
call plots."key.gp" entries
set output ARG1
plot for [m = 1:methods] work using (seconds(names[m])):"energy_error" with linespoints linetype types[m] linewidth 2 \
         title labels[m], \
     for [s = 1:3] work using (seconds(externals[s])):"energy_error" with linespoints linetype external_types[s] \
         pointtype external_markers[s] title external_titles[s]
