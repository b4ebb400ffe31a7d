# SPDX-License-Identifier: MIT
# The error in position over the whole of the long run: in each column the least and the greatest error of all the steps
# that fall into it. Grey: what theory predicts for the turning points of the error. For RK4 theory predicts less than
# the width of the line: what is seen is rounding.
call system("dirname '".ARG0."'")."/style.gp" ARG1 600
array envelopes[3] = [ARG2, ARG3, ARG4]
array runs[3] = [ARG5, ARG6, ARG7]
array names[3] = ["Euler", "leapfrog", "RK4"]
array exponents[3] = [-2, -7, -14]
array tics[3] = [3, 2, 5]
do for [m = 1:3] {
    call plots."need.gp" envelopes[m] "t_s error_min_m error_max_m"
    call plots."need.gp" runs[m] "step t_s"
}
stats runs[euler] using (column("t_s")/column("step")) nooutput
dt = STATS_mean

# Euler's amplitude grows by the factor (1 + dt^2)^(1/2) a step, leapfrog's phase leads by t dt^2/24, RK4's lags by
# t dt^4/120.
law(m, t) = m == euler ? exp(t*dt/2) - 1 : m == leapfrog ? t*dt**2/24 : t*dt**4/120

set xrange [0:1000]
set xtics 200
unset key
set output ARG1
set multiplot layout 3,1 margins 0.17,0.94,0.14,0.98 spacing 0.05
do for [m = 1:3] {
    unit = 10.0**exponents[m]
    set ylabel sprintf("error / 10^{%d} m", exponents[m])
    set ytics tics[m]
    set label 1 names[m] at graph 0.03,0.88 textcolor linetype m
    if (m < 3) {
        set format x ""
    } else {
        set format x
        set xlabel "time / s"
    }
    plot envelopes[m] using "t_s":(column("error_min_m")/unit):(column("error_max_m")/unit) \
             with filledcurves linetype m linewidth 0.5, \
         law(m, x)/unit with lines linetype theory, -law(m, x)/unit with lines linetype theory
}
unset multiplot
