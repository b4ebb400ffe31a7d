# SPDX-License-Identifier: MIT
# Position x of the particles of the rope shortly after its release. Left: Euler, steps of {{ step('rope-euler-energy')
# }}. Right: leapfrog, steps of {{ step('rope-coarse-energy') }}, just above its stable step. Both runs explode before
# the rope has begun to fall. Dotted: the correct positions.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" 310
call plots."need.gp" ARG3 "t_s particle x_m" 2
array torn[2] = [word(ARG3, 1), word(ARG3, 2)]
array after[2] = [0.012, 0.01] # [s]
array of[2] = ["euler", "leapfrog"]
array firsts[2]
do for [i = 1:2] {
    seconds = after[i]
    call plots."instant.gp" torn[i] seconds
    firsts[i] = first
}
last_particle = last - first
length = 2 # [m]

unset key
set xrange [0:last_particle]
set yrange [-2:4]
set xtics 5
set ytics 2
set xlabel "particle"
set ylabel "x / m"
set output ARG1
set multiplot layout 1,2 margins 0.14,0.96,82.0/height,1 - 45.0/height spacing 0.05,0
do for [i = 1:2] {
    set label 1 sprintf("%s, %.0f ms", label_of(of[i]), 1000*after[i]) at graph 0.5,1.12 center
    plot length*x/last_particle with lines linetype theory, \
         torn[i] every ::firsts[i]::firsts[i] + last_particle using "particle":"x_m" \
         with linespoints linetype linetype_of(of[i]) dashtype solid linewidth 1.5 pointsize 0.6
    unset ylabel
    set format y ""
}
unset multiplot
