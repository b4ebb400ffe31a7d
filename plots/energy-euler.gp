# SPDX-License-Identifier: MIT
# Euler: the error in energy against the time run. The line is the law E = E₀ (1 + z²)ⁿ with z = ω dt, which Euler obeys
# exactly; beyond the last point the energy is greater than the largest double.
call system("dirname '".ARG0."'")."/style.gp" ARG1
call plots."need.gp" ARG2 "duration_s steps energy_error_J"
stats ARG2 using (column("duration_s")/column("steps")) nooutput
dt = STATS_mean

E0 = 0.5
law(t) = E0*((1 + dt**2)**(t/dt) - 1)
highest = 1e60
set logscale xy
set xrange [0.5:2e8]
set yrange [1e-5:highest]
set xlabel "time run / s"
set ylabel "error in energy / J"
set format xy "10^{%T}"
set xtics 100
set mxtics 1
set mytics 1
set key bottom right
set output ARG1
plot (x < log(highest/E0)/log(1 + dt**2)*dt ? law(x) : NaN) with lines linetype theory title "½((1 + z²)^n − 1)", \
     ARG2 using "duration_s":(column("energy_error_J") < highest ? column("energy_error_J") : NaN) \
         with points linetype euler pointsize 1.2 title "Euler", \
     ARG2 using "duration_s":(column("energy_error_J") < highest ? NaN : highest/1e3) \
         with points linetype euler pointtype 8 pointsize 1.5 title "infinite"
