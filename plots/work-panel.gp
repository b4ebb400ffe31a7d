# SPDX-License-Identifier: MIT
# Error against run time on one problem, every solver: called by work-springs.gp and work-scenes.gp.
#
#     call plots."work-panel.gp" FILE                  before the first panel: checks the file, sets what panels share
#     call plots."work-panel.gp" FILE PROBLEM TITLE CLOSED      CLOSED: 1 where there is a closed form, or 0

array solvers[8] = ["euler", "leapfrog", "rk4", "gsl-rk4", "gsl-rk8pd", "arkode-adaptive", "cvode-adams", "cvode-bdf"]
array titles[8] = ["Euler", "leapfrog", "RK4", "GSL rk4", "GSL rk8pd", "ARKODE, order 4", "CVODE Adams", "CVODE BDF"]
array markers[8] = [7, 5, 9, 4, 6, 8, 2, 1]
work = ARG1
panel = ARG2
is(solver) = strcol("problem") eq panel && strcol("effort") eq "sweep" && strcol("solver") eq solver
least = 1e-16
drawn(error) = error > least ? error : least
seconds(solver) = is(solver) ? column("time_s") : NaN

# A macro, which has to be there before the block that uses it is read.
closed = ARG4 eq "1" ? 'work using (seconds("exact")):(drawn(column("error"))) title "closed form" with points ' \
                       .'linetype exact pointtype 3 pointsize 1.4' \
                     : 'NaN with points linetype page title " "'

if (ARGC == 1) {
    call plots."need.gp" work "problem solver effort time_s error"
    set datafile missing NaN
    set logscale xy
    set format xy "10^{%T}"
    set yrange [0.3*least:3]
    set ytics 1e3
    set xtics 10
    set mxtics 1
    set mytics 1
    set ylabel "error / size of the motion"
    set key at screen 0.05,0.997 left top Left reverse samplen 1.5 maxcols 2 maxrows 5
} else {
    set title ARG3 offset 0,-0.6
    plot for [s = 1:3] NaN with linespoints linetype s dashtype solid pointsize 0.6 title titles[s], \
         @closed, \
         NaN with points linetype page title " ", \
         for [s = 4:8] work using (seconds(solvers[s])):(drawn(column("error"))) with linespoints linetype theory \
             dashtype solid linewidth 0.8 pointtype markers[s] pointsize 0.6 title titles[s], \
         for [s = 1:3] work using (seconds(solvers[s])):(drawn(column("error"))) with linespoints linetype s \
             linewidth 1.5 dashtype solid pointsize 0.6 notitle
}
