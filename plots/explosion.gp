# SPDX-License-Identifier: MIT
# The water of the figure above, poked in the middle, a picture for each step of {{ step('water-2ms-euler-energy') }},
# slowed down. What is very high or very low is cut off.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "40 + 230*((methods + 2)/3)" 10
call plots."grid.gp" ARG3 methods
call plots."water-surface.gp"
most = 0.5 # [m]
exploded = 1 # [m] from here on a surface is no longer one
shown(z) = z > most ? most : z < -most ? -most : z
metres(z) = z < 1000 ? sprintf("%.0f m", z) : sprintf("%.0f⋅10^{%d} m", z/10**floor(log10(z)), floor(log10(z)))

set zrange [-most:most]
set cbrange [-0.15:0.15]
set view 62,30,1.1,0.8
set output ARG1
do for [t = 0:frames - 1] {
    set multiplot layout (methods + 2)/3,3 margins 0.05,0.95,55.0/height,1 - 45.0/height spacing 0.08,60.0/height
    set label 4 sprintf("%.0f ms", 1000*time_at(t)) at screen 0.5,20.0/height center front
    do for [m = 1:methods] {
        f = (m - 1)*frames + t
        across = ((m - 1)%3 + 0.5)/3
        down = 15.0 + 230*((m - 1)/3) # [px]
        set label 1 labels[m] at screen across,1 - down/height center front
        set label 2 highest_at(f) > exploded ? "exploded: ".metres(highest_at(f)) : "" \
            at screen across,1 - (down + 22)/height center front
        splot sample [u=0:edge-1][v=0:edge-1] '++' \
              using (x_at(f, $1, $2)):(y_at(f, $1, $2)):(shown(z_at(f, $1, $2))) with pm3d
    }
    unset multiplot
}
