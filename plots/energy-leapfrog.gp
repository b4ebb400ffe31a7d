# SPDX-License-Identifier: MIT
# Leapfrog: the error in energy against the time run. With position and velocity at the same time it never exceeds
# E₀ z²/4. With the velocity half a step ahead, as the seed study measured it, it is hundreds of times as large and
# scatters up to about E₀ z/2: position and velocity then belong to two different times.
call system("dirname '".ARG0."'")."/style.gp" ARG1
call plots."need.gp" ARG2 "duration_s steps energy_error_J"
call plots."need.gp" ARG3 "duration_s energy_error_J"
stats ARG2 using (column("duration_s")/column("steps")) nooutput
dt = STATS_mean

E0 = 0.5
set logscale xy
set xrange [0.5:2e8]
set yrange [1e-7:1]
set xlabel "time run / s"
set ylabel "error in energy / J"
set format xy "10^{%T}"
set xtics 100
set mxtics 1
set key top right
set label "E_0 z²/4" at 0.7,E0*dt**2/4 offset 0,0.8
set label "E_0 z/2" at 0.7,E0*dt/2 offset 0,0.8
set output ARG1
plot E0*dt/2 with lines linetype theory notitle, \
     E0*dt**2/4 with lines linetype theory notitle, \
     ARG3 using "duration_s":"energy_error_J" with points linetype leapfrog pointtype 4 pointsize 1.2 title "velocity half a step ahead", \
     ARG2 using "duration_s":"energy_error_J" with points linetype leapfrog pointsize 1.2 title "synchronised"
