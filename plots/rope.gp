# SPDX-License-Identifier: MIT
# A rope, drawn every quarter of a second after its release from a horizontal position. Its last particle has {{
# (data('rope-energy').setting('end-mass') / data('rope-energy').setting('mass'))|int|count }} times the mass of each
# other particle. Leapfrog, steps of {{ step('rope-energy') }}. The black dot is the pinned end.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" 330
call plots."need.gp" ARG3 "t_s particle x_m z_m"
rope = ARG3
array firsts[7]
do for [t = 1:7] {
    seconds = 0.25*(t - 1)
    call plots."instant.gp" rope seconds
    firsts[t] = first
}
last_particle = last - first

unset key
set xrange [-2.6:2.7]
set yrange [-2.5:0.32]
set size ratio -1
set tics 1
set xlabel "x / m"
set ylabel "z / m"
set label 1 "0 s" at 2.2,0.05
set label 2 "¼ s" at 2.2,-0.3
set label 3 "½ s" at 2.0,-1.17
set label 4 "¾ s" at 1.08,-2.1
set label 5 "1 s" at -0.8,-2.2 right
set label 6 "1¼ s" at -1.88,-1.37 right
set label 7 "1½ s" at -2.05,-0.18 center
set output ARG1
plot for [t = 1:7] rope every ::firsts[t]::firsts[t] + last_particle using "x_m":"z_m" \
         with lines linetype types[1] linewidth 2 dashtype solid, \
     for [t = 1:7] rope every ::firsts[t] + last_particle::firsts[t] + last_particle using "x_m":"z_m" \
         with points linetype types[1] pointtype 7 pointsize 1.1, \
     rope every ::firsts[1]::firsts[1] using "x_m":"z_m" with points linetype exact pointtype 7 pointsize 1.1
