# SPDX-License-Identifier: MIT
# A cloth of {{ data('cloth-map').last.size|round|int }} by {{ data('cloth-map').last.size|round|int }} particles,
# pinned at two corners, falls, swings and hangs, with 1, 2, 4, … steps per frame of 1/60 s. Colour: error compared
# with RK4 with short steps (spring-sweep), relative to the size of the motion. Orange: exploded. White line: the stable
# step that the library returns. The empty area at the bottom has less than one step per frame.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "200 + 250*((methods + 1)/2)"
map = ARG3
call plots."need.gp" map "stiffness_N_per_m steps_per_frame method error status stable_step_s"
call plots."cividis.gp" "-5" "-1"
set cbtics ("≤10^{−5}" -5, "10^{−4}" -4, "10^{−3}" -3, "10^{−2}" -2, "exploded" beyond) scale 0
set cblabel "error / size of the motion" offset 0,0.4
set colorbox horizontal user origin 0.2,1 - 35.0/height size 0.66,14.0/height

frame = 1.0/60 # [s]
binary(x) = log(x)/log(2)
stiffness(m) = strcol("method") eq names[m] ? log10(column("stiffness_N_per_m")) : NaN
colour(status, error) = status eq "exploded" ? beyond : level(error)
limit(m) = column("stable_step_s") > 0 ? binary(forces[m]*frame/column("stable_step_s")) : NaN

# A box a point, half a column to each side and half a row up and down, and a little more, so that no seams are seen.
stats map using (log10(column("stiffness_N_per_m"))) nooutput
left = STATS_min
right = STATS_max
stats map using (column("stiffness_N_per_m") > 1.01*10**left ? log10(column("stiffness_N_per_m")) : NaN) nooutput
half = 0.51*(STATS_min - left)
set style fill solid noborder
stats map using (binary(column("steps_per_frame"))) nooutput
finest = STATS_max # of methods with one force a step; others end there, too

set datafile missing NaN # a line runs on past the rows of other methods
set xrange [left - half:right + half]
set yrange [-0.51:finest + 0.51]
unset grid
unset key
set output ARG1
set multiplot layout (methods + 1)/2,2 margins 0.17,0.96,80.0/height,1 - 148.0/height spacing 0.05,66.0/height
do for [m = 1:methods] {
    set title labels[m] offset 0,-0.9
    if (m % 2) {
        set ytics ("1" 0, "4" 2, "16" 4, "64" 6, "256" 8)
        set ylabel "force evaluations / frame" offset 1,0
    } else {
        set ytics ("" 0, "" 2, "" 4, "" 6, "" 8)
        unset ylabel
    }
    if (m > methods - 2) {
        set xlabel "stiffness / (N/m)"
        set xtics ("10" 1, "10^2" 2, "10^3" 3, "10^4" 4, "10^5" 5)
    } else {
        unset xlabel
        set xtics ("" 1, "" 2, "" 3, "" 4, "" 5)
    }
    plot map using (stiffness(m)):(binary(forces[m]*column("steps_per_frame"))):(half):(0.51):(colour(strcol("status"), strcol("error"))) \
             with boxxyerror fillcolor palette, \
         map using (stiffness(m)):(limit(m)) with lines linecolor rgb "#010101" dashtype solid linewidth 4, \
         map using (stiffness(m)):(limit(m)) with lines linecolor rgb "#FEFEFE" dashtype solid linewidth 2
    unset colorbox
}
unset multiplot
