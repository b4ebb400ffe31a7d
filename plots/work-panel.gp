# SPDX-License-Identifier: MIT
# Error against run time on one problem, every solver: called by work-springs.gp and work-scenes.gp.
#
#     call plots."work-panel.gp" FILE                  before the first panel: checks the file, sets what panels share
#     call plots."work-panel.gp" FILE PROBLEM TITLE EXACT       EXACT: 1 where there is an exact solution, or 0

array shown[7] = [1, 2, 4, 5, 6, 7, 8] # of the external solvers
work = ARG1
panel = ARG2
is(solver) = strcol("problem") eq panel && strcol("effort") eq "sweep" && strcol("solver") eq solver
least = 1e-16
drawn(error) = error > least ? error : least
seconds(solver) = is(solver) ? column("time_s") : NaN

if (ARGC == 1) {
    call plots."externals.gp"
    call plots."need.gp" work "problem solver effort time_s error"
    set datafile missing NaN
    set yrange [0.3*least:3]
    set xtics 10
    set ylabel "error / size of the motion" offset 1.5,0
    call plots."key.gp" entries
} else {
    with_exact = int(ARG4)
    set title ARG3 offset 0,-0.6
    plot for [s = 1:7] work using (seconds(externals[shown[s]])):(drawn(column("error"))) with linespoints \
             linetype external_types[shown[s]] pointtype external_markers[shown[s]] notitle, \
         for [m = 1:methods] work using (seconds(names[m])):(drawn(column("error"))) with linespoints linetype types[m] \
             linewidth 2 title labels[m], \
         work using (with_exact ? seconds("exact") : NaN):(drawn(column("error"))) with points linetype exact pointtype 3 \
             pointsize 1.4 title with_exact ? label_of("exact") : "", \
         for [s = 1:7] NaN with linespoints linetype external_types[shown[s]] \
             pointtype external_markers[shown[s]] title external_titles[shown[s]]
}
