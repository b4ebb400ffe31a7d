# SPDX-License-Identifier: MIT
# The energy of the water without drag, in steps of {{ step('scene-energy-euler') }}, below leapfrog's stable step. The
# poke brings it in at the beginning; from then on it should stay what it is, the dotted line, from leapfrog in steps of
# {{ step('scene-energy-exact') }}. Euler gains without end. RK4 loses, fast at first, while there are short waves.
# Leapfrog swings about the true energy, by a few percent with so long a step, and does not drift. What leaves the
# picture at the top explodes.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "390 + key_height(methods + 1)"
energies = ARG3
call plots."need.gp" energies "t_s energy_J" methods
call plots."need.gp" ARG4 "t_s energy_J"

kilojoule(y) = y/1000
top = 24 # [kJ]
set logscale x
set xrange [0.004:4]
set yrange [0:top]
set xtics ("0.01" 0.01, "0.1" 0.1, "1" 1)
set xlabel "time / s"
set ylabel "energy / kJ"
entries = methods + 1
call plots."key.gp" entries
set output ARG1

shown(y) = y < 10*top ? y : 10*top
plot for [m = 1:methods] file(energies, m) using "t_s":(shown(kilojoule(column("energy_J")))) \
         with lines linetype types[m] linewidth (symplectic[m] ? 0.7 : 2) dashtype solid notitle, \
     for [m = 1:methods] NaN with lines linetype types[m] dashtype solid title labels[m], \
     ARG4 using "t_s":(kilojoule(column("energy_J"))) with lines linetype theory title "true energy"
