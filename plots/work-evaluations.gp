# SPDX-License-Identifier: MIT
# Work–precision diagrams of the ideal spring after one period and after ten: error versus force evaluations. Dotted:
# the exact errors of Euler, leapfrog and RK4 from theory. Nested markers show that methods agree. At the vertical line
# RK4 becomes more accurate than leapfrog. At the right only rounding error is left, and it grows with the number of
# steps. Open markers: GSL.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "855 + key_height(methods + 2)"
output = ARG1
work = ARG3
call plots."externals.gp"
call plots."need.gp" work "problem solver effort force_evaluations error"
is(solver, why) = strcol("problem") eq panel && strcol("effort") eq why && strcol("solver") eq solver
evaluations(solver) = is(solver, "sweep") ? column("force_evaluations") : NaN

# n steps of z = ω dt, from the direction (c, s) of (x, v/ω), after whole periods: so the true end is the start.
omega = sqrt(2.7/1.3)
motion = sqrt(0.8**2 + (0.9/omega)**2)
c = 0.8/motion
s = -0.9/omega/motion
i = {0,1}
by_euler(z, n) = abs(exp(n*log(1 - i*z)) - 1)
by_rk4(z, n) = abs(exp(n*log(1 - z**2/2 + z**4/24 - i*(z - z**3/6))) - 1)
side(z) = sqrt(1 - z**2/4)
turn(z, n) = n*2*asin(z/2)
by_leapfrog(z, n) = sqrt((cos(turn(z, n))*c + sin(turn(z, n))*s/side(z) - c)**2 \
                         + (cos(turn(z, n))*s - sin(turn(z, n))*c*side(z) - s)**2)
law(name, z, n) = name eq "euler" ? by_euler(z, n) : name eq "leapfrog" ? by_leapfrog(z, n) : name eq "rk4" ? by_rk4(z, n) : NaN
theory_of(m, x) = law(names[m], 2*pi*periods*forces[m]/x, x/forces[m])
# The laws are computed with 16 digits, of which RK4's logarithm loses some at every step.
visible(m, x) = x > 8*periods*sqrt(forces[m]) && theory_of(m, x) > (names[m] eq "rk4" ? 1e-16*x : 1e-14) ? theory_of(m, x) : NaN

size(m) = 1.5*0.75**(m - 1)

set datafile missing NaN
array lengths[2] = [1, 10]
array crosses[2]
do for [k = 1:2] {
    panel = "ideal-".lengths[k]
    stats work using (is("rk4", "crossing") ? column("force_evaluations") : NaN) nooutput
    crosses[k] = sqrt(STATS_min*STATS_max)
}

set samples 400
set xrange [8:1e7]
set yrange [1e-16:3]
set ylabel "error / size of the motion" offset 1.5,0
entries = methods + 2
call plots."key.gp" entries
set output output
set multiplot layout 2,1 margins 0.2,0.94,82.0/height,key_bottom(entries) - 40.0/height spacing 84.0/height
do for [k = 1:2] {
    periods = lengths[k]
    panel = "ideal-".periods
    cross = crosses[k]
    set title sprintf("%s, crossing at %.3g per period", periods == 1 ? "one period" : "ten periods", cross/periods) \
        offset -2,-0.6
    set arrow 1 from cross,1e-16 to cross,3 nohead linetype theory linewidth 1
    if (k == 2) {
        unset key
        set xlabel "force evaluations"
    }
    plot for [m = 1:methods] work using (evaluations(names[m])):"error" with points linetype types[m] pointsize size(m) \
             title labels[m], \
         for [s = 1:2] work using (evaluations(externals[s])):"error" with linespoints linetype external_types[s] \
             pointtype external_markers[s] title external_titles[s], \
         for [m = 1:methods] visible(m, x) with lines linetype theory linewidth 2 notitle
}
unset multiplot
