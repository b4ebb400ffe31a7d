# SPDX-License-Identifier: MIT
# A rope of 20 particles, the last of which is ten thousand times as heavy as each of the others, let go level. Top:
# with leapfrog in steps of 0.1 ms, every quarter of a second. Middle: what Euler makes of it in the same steps, and
# leapfrog in steps of 0.25 ms, just above its stable step; the rope is torn apart before it has begun to fall. Dotted:
# where the particles belong. Bottom: the energy of the rope at the top, without drag; the sum stays what it was.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" 900
call plots."need.gp" ARG3 "t_s energy_J kinetic_J elastic_J gravity_J"
call plots."need.gp" ARG4." ".ARG5 "t_s particle x_m z_m" 3
energies = ARG3
swing = ARG4
array torn[2] = [word(ARG5, 1), word(ARG5, 2)]
array after[2] = [0.012, 0.01] # [s]
array of[2] = ["euler", "leapfrog"]
leapfrog = types[1]

array firsts[7]
do for [t = 1:7] {
    seconds = 0.25*(t - 1)
    call plots."instant.gp" swing seconds
    firsts[t] = first
}
array torn_first[2]
do for [i = 1:2] {
    seconds = after[i]
    call plots."instant.gp" torn[i] seconds
    torn_first[i] = first
}
last_particle = last - first
length = 2 # [m]

unset key
set output ARG1
set multiplot
set lmargin at screen 0.17
set rmargin at screen 0.96

set tmargin at screen 0.985
set bmargin at screen 0.73
set xrange [-2.5:2.5]
set yrange [-2.5:0.32]
set ytics 1
set ylabel "z / m"
set xlabel "x / m" offset 0,0.4
set label 1 "0 s" at 2.1,0
set label 2 "¼ s" at 2.1,-0.3
set label 3 "½ s" at 1.9,-1.17
set label 4 "¾ s" at 1,-2.1
set label 5 "1 s" at -0.7,-2.2 right
set label 6 "1¼ s" at -1.8,-1.37 right
set label 7 "1½ s" at -2.05,-0.2 center
plot for [t = 1:7] swing every ::firsts[t]::firsts[t] + last_particle using "x_m":"z_m" \
         with lines linetype leapfrog linewidth 2 dashtype solid, \
     for [t = 1:7] swing every ::firsts[t] + last_particle::firsts[t] + last_particle using "x_m":"z_m" \
         with points linetype leapfrog pointtype 7 pointsize 1.1
unset label

set tmargin at screen 0.61
set bmargin at screen 0.43
set xrange [0:last_particle]
set yrange [-2:4]
set xtics 5
set ytics 2
set xlabel "particle"
set ylabel "x / m"
do for [i = 1:2] {
    set lmargin at screen 0.17 + 0.41*(i - 1)
    set rmargin at screen 0.55 + 0.41*(i - 1)
    set label 1 sprintf("%s, %.0f ms", label_of(of[i]), 1000*after[i]) at graph 0.5,1.1 center
    plot length*x/last_particle with lines linetype theory, \
         torn[i] every ::torn_first[i]::torn_first[i] + last_particle using "particle":"x_m" \
         with linespoints linetype linetype_of(of[i]) dashtype solid linewidth 1.5 pointtype 7 pointsize 0.5
    unset ylabel
    set format y ""
}
unset label

set format y
set lmargin at screen 0.17
set rmargin at screen 0.96
set tmargin at screen 0.31
set bmargin at screen 0.075
set xrange [0:1.5]
set yrange [-2.4:2.4]
set xtics 0.5
set ytics 1
set xlabel "time / s"
set ylabel "energy / kJ"
set label 1 "kinetic" at 0.52,1.35 right
set label 2 "elastic" at 1.18,0.5
set label 3 "of gravity" at 0.52,-1.5 right
set label 4 "sum" at 1.3,-0.27
plot energies using "t_s":(column("kinetic_J")/1000) with lines linetype exact dashtype (8,3,2,3), \
     "" using "t_s":(column("elastic_J")/1000) with lines linetype exact dashtype (2,2), \
     "" using "t_s":(column("gravity_J")/1000) with lines linetype exact dashtype (8,4), \
     "" using "t_s":(column("energy_J")/1000) with lines linetype leapfrog dashtype solid
unset multiplot
