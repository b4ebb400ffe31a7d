# SPDX-License-Identifier: MIT
# The water from above at four instants, the three methods side by side: called by water-methods.gp and its like.
#
#     call plots."water-instants.gp" OUTPUT EULER LEAPFROG RK4 "MILLISECONDS MILLISECONDS ..."

array files[3] = [ARG2, ARG3, ARG4]
array names[3] = ["Euler", "leapfrog", "RK4"]
instants = ARG5
array firsts[3*words(instants)]
array lasts[3*words(instants)]
do for [m = 1:3] {
    call plots."need.gp" files[m] "t_s x_m y_m z_m"
    do for [t = 1:words(instants)] {
        seconds = 0.001*word(instants, t)
        call plots."instant.gp" files[m] seconds
        firsts[3*(t - 1) + m] = first
        lasts[3*(t - 1) + m] = last
    }
}

highest = 0.1  # [m] of the colours
exploded = 1   # [m] from here on a surface is no longer one
metres(z) = z < 1000 ? sprintf("%.0f m", z) : sprintf("%.0f⋅10^{%d} m", z/10**floor(log10(z)), floor(log10(z)))
shown(z) = z > highest ? highest : z < -highest ? -highest : z

# From below to above, even steps to the eye either way, for colour-blind ones too. No colour here is one of style.gp,
# which the page changes in the dark.
set palette maxcolors 0 defined (-1 "#0B2A5B", -0.5 "#4A86B8", 0 "#F3F2EE", 0.5 "#D98A4E", 1 "#6B2408")
set cbrange [-highest:highest]
set colorbox horizontal user origin 0.36,0.965 size 0.56,0.016
unset grid
unset key
unset tics
set cbtics ("≤ −10" -highest, "−5" -0.5*highest, "0" 0, "5" 0.5*highest, "≥ 10" highest) scale 0 offset 0,0.5
set border 15 linewidth 0.5
set autoscale fix
set output ARG1
set multiplot layout words(instants),3 margins 0.075,0.985,0.01,0.87 spacing 0.02
set label 1 "height / cm" at screen 0.02,0.973
do for [t = 1:words(instants)] {
    do for [m = 1:3] {
        first = firsts[3*(t - 1) + m]
        last = lasts[3*(t - 1) + m]
        stats files[m] every ::first::last using (abs(column("z_m"))) nooutput
        height = STATS_max
        if (t == 1) {
            set label 2 names[m] at graph 0.5,1.09 center
        }
        if (m == 1) {
            set label 3 word(instants, t)." ms" at graph -0.1,0.5 center rotate
        }
        if (height > exploded) {
            set object 1 rectangle from graph 0,0 to graph 1,0.38 front fillcolor rgb "#FEFEFE" fillstyle solid noborder
            set label 4 "exploded" at graph 0.5,0.28 center textcolor rgb "#020202" front
            set label 5 metres(height) at graph 0.5,0.1 center textcolor rgb "#020202" front
        }
        plot files[m] every ::first::last using "x_m":"y_m":(shown(column("z_m"))) with image
        unset colorbox
        unset object
        unset label
    }
}
unset multiplot
