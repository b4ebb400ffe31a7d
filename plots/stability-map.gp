# SPDX-License-Identifier: MIT
# The error after ten periods over step and damping ratio, as a fraction of the distance from rest at the start. Orange:
# more than the whole of it. White: the largest stable step. Around ζ = 1 a spring has come to rest after ten periods, so
# there even a coarse step leaves no error to speak of, if only it is stable. Leapfrog is stable for every damping, and of
# no use where damping is strong and the step coarse: there a part of its velocity changes sign at every step.
call system("dirname '".ARG0."'")."/style.gp" ARG1 1000
call plots."need.gp" ARG2 "method omega_dt damping_ratio error"
call plots."need.gp" ARG3 "method damping_ratio limit_theory"
array names[3] = ["euler", "leapfrog", "rk4"]
array titles[3] = ["Euler", "leapfrog", "RK4"]

# An image takes whole rows of pixels: the methods' blocks of the table, one after the other.
stats ARG2 using "omega_dt" nooutput
block = STATS_records/3

# Logarithms, for a picture made of pixels has to have linear axes.
least = -8
exploded = 0.5
level(text) = text eq "inf" || text > 1 ? exploded : text > 10**least ? log10(text) : least
edge(m) = strcol("method") eq names[m] && column("damping_ratio") > 0 ? log10(column("damping_ratio")) : NaN

# Cividis: even steps to the eye, colour-blind or not. No colour here is one of style.gp, which the page changes in the dark.
set palette maxcolors 0 defined (-8 "#00224E", -7.1 "#123570", -6.2 "#3B496C", -5.3 "#575D6D", -4.4 "#707173", \
    -3.6 "#8A8678", -2.7 "#A59C74", -1.8 "#C3B369", -0.9 "#E1CC55", 0 "#FEE838", 0 "#D65E00", exploded "#D65E00")
set cbrange [least:exploded]
set cbtics ("≤10^{−8}" -8, "10^{−6}" -6, "10^{−4}" -4, "10^{−2}" -2, "1" 0) scale 0
set cblabel "error after ten periods" offset 0,0.4
set colorbox horizontal user origin 0.24,0.965 size 0.66,0.014

set xrange [-3:1]
set yrange [-2:2]
set xtics ("" -3, "" -2, "" -1, "" 0, "" 1)
set ytics ("0.01" -2, "0.1" -1, "1" 0, "10" 1, "100" 2)
set ylabel "damping ratio ζ"
unset grid
unset key
set output ARG1
set multiplot layout 3,1 margins 0.21,0.94,0.085,0.89 spacing 0.03
do for [m = 1:3] {
    set label 1 titles[m] at graph 0.03,0.5 textcolor rgb "#FEFEFE" front
    if (m == 3) {
        set xtics ("0.001" -3, "0.01" -2, "0.1" -1, "1" 0, "10" 1)
        set xlabel "step ω dt"
    }
    plot ARG2 every ::(m - 1)*block::m*block - 1 \
             using (log10(column("omega_dt"))):(log10(column("damping_ratio"))):(level(strcol("error"))) with image, \
         ARG3 using (log10(column("limit_theory"))):(edge(m)) with lines linecolor rgb "#010101" dashtype solid linewidth 4, \
         ARG3 using (log10(column("limit_theory"))):(edge(m)) with lines linecolor rgb "#FEFEFE" dashtype solid linewidth 2
    unset colorbox
}
unset multiplot
