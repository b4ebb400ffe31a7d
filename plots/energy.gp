# SPDX-License-Identifier: MIT
# Energy error versus duration of the run, with steps of {{ data('energy-euler').rows[0].duration_s /
# data('energy-euler').rows[0].steps }} s. Euler's error grows without bound. The errors of leapfrog and symplectic
# Euler oscillate, with the same amplitude at the end as at the beginning. Leapfrog's error is far larger if its
# velocity is taken half a step ahead of its position. RK4 slowly loses energy. Grey: the formulas in the text.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "440 + key_height(methods + 2)"
call plots."need.gp" ARG3 "duration_s steps energy_error_J" methods
call plots."need.gp" ARG4 "duration_s energy_error_J"
energies = ARG3
ahead = ARG4
stats file(energies, 1) using (column("duration_s")/column("steps")) nooutput
dt = STATS_mean
longest = 0
stats file(energies, 1) using (longest = column("duration_s") > longest ? column("duration_s") : longest) nooutput

E0 = 0.5  # [J]
top = 100 # [J]: what is more has left the picture
gain(t) = E0*(exp(t/dt*log(1 + dt**2)) - 1)
loss(t) = E0*(1 - exp(-t/dt*dt**6/72))
law(name, t) = t > longest ? NaN : name eq "euler" ? (t < 1e5*dt*100 ? gain(t) : NaN) : name eq "rk4" ? loss(t) \
    : name eq "leapfrog" ? E0*dt**2/4 : NaN
law_ahead(t) = t > longest ? NaN : E0*dt/2

set logscale xy
set xrange [0.5:2*longest]
set yrange [1e-14:top]
set xlabel "duration / s"
set ylabel "energy error / J"
set format xy "10^{%T}"
set xtics 10
set ytics 1e3
set mxtics 1
set mytics 1
call plots."key.gp" methods + 2
set output ARG1
plot for [m = 1:methods] law(names[m], x) with lines linetype theory notitle, \
     law_ahead(x) with lines linetype theory notitle, \
     for [m = 1:methods] file(energies, m) using "duration_s":"energy_error_J" with points linetype types[m] pointsize 1.2 \
         title labels[m], \
     ahead using "duration_s":"energy_error_J" with points linetype linetype_of("leapfrog") pointtype 4 pointsize 2 \
         linewidth 1.5 title "… v ½ step ahead", \
     NaN with lines linetype theory title "theory"
