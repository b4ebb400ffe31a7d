# SPDX-License-Identifier: MIT
# The energy of the water without drag, in steps of {{ step('scene-energy-euler') }}, below leapfrog's stable step. The
# initial disturbance supplies the energy, which should then remain constant. The dotted line is the energy from
# leapfrog in steps of {{ step('scene-energy-exact') }}. Euler's energy grows without bound. RK4 loses energy, fastest
# while there are short waves. With this long step, leapfrog oscillates about the reference by a few percent, but does
# not drift. Curves that leave the figure at the top belong to runs that explode.
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
     ARG4 using "t_s":(kilojoule(column("energy_J"))) with lines linetype theory title "reference"
