# SPDX-License-Identifier: MIT
# The energy of the water without drag, in steps of 2 ms, below leapfrog's stable step. The poke brings it in within 20
# ms; from then on it should stay what it is, the dotted line, from leapfrog in steps of 0.02 ms. Euler gains without
# end. RK4 loses, fast at first, while there are short waves. Leapfrog swings about the truth, by up to 4 % with so long
# a step, and does not drift.
call system("dirname '".ARG0."'")."/style.gp" ARG1
array files[4] = [ARG2, ARG3, ARG4, ARG5]
do for [i = 1:4] {
    call plots."need.gp" files[i] "t_s energy_J"
}
stats files[euler] using "t_s":"energy_J" nooutput
euler_time = STATS_max_x
euler_energy = STATS_max_y
power = floor(log10(euler_energy))

kilojoule(y) = y/1000
set logscale x
set xrange [0.004:4]
set yrange [0:24]
set xtics ("0.01" 0.01, "0.1" 0.1, "1" 1)
set xlabel "time / s"
set ylabel "energy / kJ"
unset key
set label sprintf("Euler: %.0f⋅10^{%d} kJ\nafter %.2g s", euler_energy/10**power, power - 3, euler_time) \
    at 0.022,22.5 textcolor linetype euler
set label "leapfrog" at 1,17 center textcolor linetype leapfrog
set label "RK4" at 0.5,8.5 center textcolor linetype rk4
set output ARG1
plot files[leapfrog] using "t_s":(kilojoule(column("energy_J"))) \
         with lines linetype leapfrog linewidth 0.7 dashtype solid, \
     files[rk4] using "t_s":(kilojoule(column("energy_J"))) with lines linetype rk4, \
     files[euler] using "t_s":(kilojoule(column("energy_J"))) with lines linetype euler, \
     files[4] using "t_s":(kilojoule(column("energy_J"))) with lines linetype theory
