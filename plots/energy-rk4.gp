# SPDX-License-Identifier: MIT
# RK4: the error in energy against the time run. RK4 loses z⁶/72 of the energy at every step, for ever: the error grows
# in proportion to time.
call system("dirname '".ARG0."'")."/style.gp" ARG1
call plots."need.gp" ARG2 "duration_s steps energy_error_J"
stats ARG2 using (column("duration_s")/column("steps")) nooutput
dt = STATS_mean

E0 = 0.5
set logscale xy
set xrange [0.5:2e8]
set yrange [1e-13:1e-3]
set xlabel "time run / s"
set ylabel "error in energy / J"
set format xy "10^{%T}"
set xtics 100
set mxtics 1
set ytics 100
set mytics 1
set key top left
set output ARG1
plot E0*(1 - exp(-x/dt*dt**6/72)) with lines linetype theory title "E_0 n z⁶/72", \
     ARG2 using "duration_s":"energy_error_J" with points linetype rk4 pointsize 1.2 title "RK4"
