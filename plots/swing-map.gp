# SPDX-License-Identifier: MIT
# A link with a mass at its end is released at an angle between hanging down and standing up, and swings for {{
# data('swing-map').last.duration_s|round|int }} s. Leapfrog. Each panel: initial length of the link over its rest
# length. Colour: energy gained, relative to the largest kinetic energy of the exact motion. Orange: values above the
# scale. White line: the stable step that the library returns.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" "700"
map = ARG3
call plots."need.gp" map "stretch angle_deg stable_fraction energy_error"
call plots."cividis.gp" "-2" "1"
set cbtics ("≤0.01" -2, "0.1" -1, "1" 0, ">10" 1.1) scale 0
set cblabel "energy gained / largest kinetic energy" offset 0,0.4
set colorbox horizontal user origin 0.24,1 - 35.0/height size 0.66,14.0/height

# The panels are blocks of as many rows each.
panels = 4
stats map using "stretch" nooutput
rows = int(STATS_records/panels)
array stretches[panels]
do for [p = 1:panels] {
    stats map every ::((p - 1)*rows)::(p*rows - 1) using "stretch" nooutput
    stretches[p] = STATS_max
}
stats map using "angle_deg" nooutput
steepest = STATS_max
stats map using "stable_fraction" nooutput
set xrange [STATS_min - 0.01:STATS_max + 0.01] # an image that is cut becomes thousands of polygons
set yrange [-2:steepest + 2]
set xtics 0.2
unset grid
unset key
set output ARG1
set multiplot layout 2,2 margins 0.15,0.96,80.0/height,1 - 148.0/height spacing 0.05,66.0/height
do for [p = 1:panels] {
    set title sprintf("stretch %.4g", stretches[p]) offset 0,-0.9
    if (p % 2) {
        set ytics 45 format "%g"
        set ylabel "angle / °" offset 1,0
    } else {
        set ytics 45 format ""
        unset ylabel
    }
    if (p > 2) {
        set xtics format "%g"
        set xlabel "step / stable step"
    } else {
        set xtics format ""
    }
    plot map every ::((p - 1)*rows)::(p*rows - 1) using "stable_fraction":"angle_deg":(level(strcol("energy_error"))) with image, \
         map every ::((p - 1)*rows)::(p*rows - 1) using (1):"angle_deg" with lines linecolor rgb "#010101" dashtype solid linewidth 4, \
         map every ::((p - 1)*rows)::(p*rows - 1) using (1):"angle_deg" with lines linecolor rgb "#FEFEFE" dashtype solid linewidth 2
    unset colorbox
}
unset multiplot
