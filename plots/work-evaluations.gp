# SPDX-License-Identifier: MIT
# The ideal spring after one period and after ten: error against force evaluations. Dotted: what theory says, exactly, of
# Euler, leapfrog and RK4. The vertical line is where RK4 passes leapfrog. At the end rounding is all that is left, and
# more steps make it more. Grey: GSL's rk4 and rk8pd.
call system("dirname '".ARG0."'")."/style.gp" ARG1 860
call plots."need.gp" ARG2 "problem solver effort force_evaluations error"
output = ARG1
file = ARG2
array solvers[3] = ["euler", "leapfrog", "rk4"]
array names[3] = ["Euler", "leapfrog", "RK4"]
is(solver, why) = strcol("problem") eq panel && strcol("effort") eq why && strcol("solver") eq solver
work(solver) = is(solver, "sweep") ? column("force_evaluations") : NaN

# n steps of z = ω dt, from the direction (c, s) of (x, v/ω), after whole periods: so the true end is the start.
omega = sqrt(2.7/1.3)
size = sqrt(0.8**2 + (0.9/omega)**2)
c = 0.8/size
s = -0.9/omega/size
i = {0,1}
by_euler(z, n) = abs(exp(n*log(1 - i*z)) - 1)
by_rk4(z, n) = abs(exp(n*log(1 - z**2/2 + z**4/24 - i*(z - z**3/6))) - 1)
side(z) = sqrt(1 - z**2/4)
turn(z, n) = n*2*asin(z/2)
by_leapfrog(z, n) = sqrt((cos(turn(z, n))*c + sin(turn(z, n))*s/side(z) - c)**2 \
                         + (cos(turn(z, n))*s - sin(turn(z, n))*c*side(z) - s)**2)
law(m, z, n) = m == 1 ? by_euler(z, n) : m == 2 ? by_leapfrog(z, n) : by_rk4(z, n)
a_step(m) = m == 3 ? 4 : 1
theory_of(m, evaluations) = law(m, 2*pi*periods*a_step(m)/evaluations, evaluations/a_step(m))
# The laws are computed with 16 digits, of which RK4's logarithm loses some at every step.
visible(m, x) = x > 8*periods*sqrt(a_step(m)) && theory_of(m, x) > (m == 3 ? 1e-16*x : 1e-14) ? theory_of(m, x) : NaN

set datafile missing NaN
array lengths[2] = [1, 10]
array crosses[2]
do for [k = 1:2] {
    panel = "ideal-".lengths[k]
    stats file using (is("rk4", "crossing") ? column("force_evaluations") : NaN) nooutput
    crosses[k] = sqrt(STATS_min*STATS_max)
}

set samples 400
set logscale xy
set format xy "10^{%T}"
set xrange [8:1e7]
set yrange [1e-16:3]
set ytics 1e3
set mxtics 1
set mytics 1
set ylabel "error / size of the motion"
unset key
set output output
set multiplot layout 2,1 margins 0.19,0.94,0.09,0.95 spacing 0.09
do for [k = 1:2] {
    periods = lengths[k]
    panel = "ideal-".periods
    cross = crosses[k]
    set title sprintf("%s, crossing at %.3g a period", periods == 1 ? "one period" : "ten periods", cross/periods) \
        offset -2,-0.6
    set arrow 1 from cross,1e-16 to cross,3 nohead linetype theory linewidth 1
    set label 2 names[1] at 1e5*periods**0.5,theory_of(1, 1e5*periods**0.5) offset character 0.6,0.6 textcolor linetype 1
    set label 3 names[2] at 1e5*periods**0.5,theory_of(2, 1e5*periods**0.5) offset character 0.6,0.6 textcolor linetype 2
    set label 4 names[3] at 7e3*periods**1.1,2e-12 right textcolor linetype 3
    set label 5 "rk8pd" at 260*periods**1.1,1e-10 left
    set label 6 "GSL rk4" at 2e4*periods**1.1,1e-11 left
    if (periods == 10) {
        set xlabel "force evaluations"
    }
    plot for [peer in "gsl-rk4 gsl-rk8pd"] file using (work(peer)):"error" with linespoints linetype theory \
             dashtype solid linewidth 0.8 pointtype (peer eq "gsl-rk4" ? 4 : 6) pointsize 0.6, \
         for [m = 1:3] file using (work(solvers[m])):"error" with points linetype m pointsize 0.7, \
         for [m = 1:3] visible(m, x) with lines linetype theory linewidth 2
}
unset multiplot
