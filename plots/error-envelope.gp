# SPDX-License-Identifier: MIT
# The largest position error in each interval of about one second of the long run. Dotted: theory for Euler, leapfrog
# and RK4. RK4 has rounding errors far above its truncation error. Symplectic Euler's error oscillates in each period
# and hardly grows.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "440 + key_height(methods + 1)"
envelopes = ARG3
call plots."need.gp" envelopes "t_s error_min_m error_max_m" methods
call plots."need.gp" ARG4 "step t_s"
stats ARG4 using (column("t_s")/column("step")) nooutput
dt = STATS_mean

# Euler's amplitude grows by the factor (1 + dt^2)^(1/2) a step, leapfrog's phase leads by t dt^2/24, RK4's lags by
# t dt^4/120.
law(name, t) = name eq "euler" ? exp(t*dt/2) - 1 : name eq "leapfrog" ? t*dt**2/24 : name eq "rk4" ? t*dt**4/120 : NaN
greater(a, b) = abs(a) > abs(b) ? abs(a) : abs(b)

set logscale xy
set xrange [0.8:1000]
set yrange [1e-18:1]
set format y "10^{%T}"
set ytics 1e3
set mytics 1
set xlabel "time / s"
set ylabel "largest position error / m"
call plots."key.gp" methods + 1
set output ARG1
plot for [m = 1:methods] file(envelopes, m) using "t_s":(greater(column("error_min_m"), column("error_max_m"))) \
         with lines linetype types[m] linewidth 2 title labels[m], \
     for [m = 1:methods] law(names[m], x) with lines linetype theory notitle, \
     NaN with lines linetype theory title "theory"
