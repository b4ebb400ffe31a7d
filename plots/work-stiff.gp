# SPDX-License-Identifier: MIT
# {{ method }}: error at the end versus computing time per frame of 1/60 s. Leapfrog's curve begins with the fewest
# steps, at least one per frame, for which the run stays finite, even if they are longer than the stable step of the
# library. Dotted line: leapfrog with links softened until the step is stable. XPBD has one iteration per substep. BDF2-CG is
# BDF of order 2 with conjugate gradients{{ ' and starts with one step per frame. Projective dynamics has one iteration per step' if method != 'Damped cloth' else ', from one step per frame' }}. CVODE's
# BDF, of order 2 or of up to 5, chooses its own steps.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "symplectic-euler leapfrog rk4 srkn6 rkn8" "460 + key_height(methods + 6)"
problem = ARG3
work = ARG4
call plots."externals.gp"
call plots."need.gp" work "problem solver steps effort time_s error"
call plots."need.gp" ARG5 "problem dt_s steps"

# The frames of a run, from any row of the table.
set datafile missing NaN
stats ARG5 using (strcol("problem") eq problem ? column("dt_s")*column("steps") : NaN) nooutput
frames = 60*STATS_max

is(solver) = strcol("problem") eq problem && strcol("effort") eq "sweep" && strcol("solver") eq solver
microseconds(solver) = is(solver) ? column("time_s")/frames*1e6 : NaN

set yrange [1e-13:3]
set xlabel "time per frame / µs".note_on_sundials
set ylabel "error / size of the motion" offset 1.5,0
entries = methods + 6
call plots."key.gp" entries
set output ARG1
plot for [m = 1:methods] work using (microseconds(names[m])):"error" with linespoints linetype types[m] linewidth 2 \
         title labels[m], \
     work using (microseconds("leapfrog-softened")):"error" with linespoints linetype linetype_of("leapfrog") dashtype (3,3) \
         linewidth 1.5 pointtype 4 title "softened leapfrog", \
     work using (microseconds("xpbd")):"error" with linespoints linetype exact linewidth 2 pointtype 6 title "XPBD", \
     work using (microseconds("bdf2-cg")):"error" with linespoints linetype gsl linewidth 2 pointtype 8 title "BDF2-CG", \
     work using (microseconds("projective")):"error" with linespoints linetype odeint linewidth 2 pointtype 12 \
         title "projective", \
     work using (microseconds("cvode-bdf2")):"error" with linespoints linetype sundials pointtype 3 title "CVODE BDF2", \
     work using (microseconds("cvode-bdf")):"error" with linespoints linetype sundials pointtype 2 title "CVODE BDF"
