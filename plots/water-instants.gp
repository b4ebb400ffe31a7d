# SPDX-License-Identifier: MIT
# The water from above at four instants, a line for each method: called by water-methods.gp and its like.
#
#     call plots."water-instants.gp" OUTPUT "POSITIONS..." "MILLISECONDS..."

positions = ARG2
instants = ARG3
columns = words(instants)
array firsts[columns*methods]
array lasts[columns*methods]
call plots."need.gp" positions "t_s x_m y_m z_m" methods
do for [m = 1:methods] {
    do for [t = 1:columns] {
        seconds = 0.001*word(instants, t)
        call plots."instant.gp" file(positions, m) seconds
        firsts[columns*(m - 1) + t] = first
        lasts[columns*(m - 1) + t] = last
    }
}

highest = 0.1  # [m] of the colours
exploded = 1   # [m] from here on a surface is no longer one
metres(z) = z < 1000 ? sprintf("%.0f m", z) : sprintf("%.0f⋅10^{%d} m", z/10**floor(log10(z)), floor(log10(z)))
shown(z) = z > highest ? highest : z < -highest ? -highest : z

# Below a cell: how far an exploded surface reaches. Beside the pictures there is room for a dozen letters in a line.
two_lines(text) = strstrt(text, " ") > 0 \
    ? text[1:strstrt(text, " ") - 1]."\n".text[strstrt(text, " ") + 1:*] : text

# From below to above, even steps to the eye either way, for colour-blind ones too. No colour here is one of style.gp,
# which the page changes in the dark.
set palette maxcolors 0 defined (-1 "#0B2A5B", -0.5 "#4A86B8", 0 "#F3F2EE", 0.5 "#D98A4E", 1 "#6B2408")
set cbrange [-highest:highest]
set colorbox horizontal user origin 0.36,1 - 26.0/height size 0.56,12.0/height
unset grid
unset key
unset tics
set cbtics ("≤ −10" -highest, "−5" -0.5*highest, "0" 0, "5" 0.5*highest, "≥ 10" highest) scale 0 offset 0,0.5
set border 15 linewidth 0.5
set autoscale fix
set output ARG1
set multiplot layout methods,columns margins 0.115,0.985,34.0/height,1 - 95.0/height spacing 0.02,36.0/height
set label 1 "height / cm" at screen 0.02,1 - 20.0/height
do for [m = 1:methods] {
    do for [t = 1:columns] {
        first = firsts[columns*(m - 1) + t]
        last = lasts[columns*(m - 1) + t]
        stats file(positions, m) every ::first::last using (abs(column("z_m"))) nooutput
        if (m == 1) {
            set label 2 word(instants, t)." ms" at graph 0.5,1.12 center
        }
        if (t == 1) {
            set label 3 two_lines(labels[m]) at graph (strstrt(labels[m], " ") ? -0.38 : -0.2),0.5 center rotate
        }
        if (STATS_max > exploded) {
            set label 4 metres(STATS_max) at graph 0.5,-0.15 center
        }
        plot file(positions, m) every ::first::last using "x_m":"y_m":(shown(column("z_m"))) with image
        unset colorbox
        unset label
    }
}
unset multiplot
