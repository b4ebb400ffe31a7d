# SPDX-License-Identifier: MIT
# The energy of the swinging rope without drag. Leapfrog, steps of {{ step('rope-energy') }}. Potential energy is
# converted to kinetic energy and back, and their sum is conserved closely.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog"
call plots."need.gp" ARG3 "t_s energy_J kinetic_J elastic_J gravity_J"
kilojoule(y) = y/1000

unset key
set xrange [0:1.5]
set yrange [-2.4:2.4]
set xtics 0.5
set ytics 1
set xlabel "time / s"
set ylabel "energy / kJ"
set label 1 "kinetic" at 0.5,1.45 right
set label 2 "elastic" at 1.2,0.5
set label 3 "gravity" at 0.5,-1.55 right
set label 4 "sum" at 1.25,-0.3
set output ARG1
plot ARG3 using "t_s":(kilojoule(column("kinetic_J"))) with lines linetype exact dashtype (8,3,2,3), \
     "" using "t_s":(kilojoule(column("elastic_J"))) with lines linetype exact dashtype (2,2), \
     "" using "t_s":(kilojoule(column("gravity_J"))) with lines linetype exact dashtype (8,4), \
     "" using "t_s":(kilojoule(column("energy_J"))) with lines linetype types[1] dashtype solid
