# SPDX-License-Identifier: MIT
# Rain on the water, and a box after a quarter of a second, slowed down; heights are exaggerated. Leapfrog, two steps of
# {{ step('water-rain-energy') }} for each picture.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" 320 4
call plots."grid.gp" ARG3 1
call plots."water-surface.gp"
set zrange [-0.3:0.3]
set cbrange [-0.12:0.12]
set view 50,30,1.35,1.2
set output ARG1
do for [f = 0:frames - 1] {
    set label 1 sprintf("%.2f s", time_at(f)) at screen 0.03,0.93
    splot sample [u=0:edge-1][v=0:edge-1] '++' using (x_at(f, $1, $2)):(y_at(f, $1, $2)):(z_at(f, $1, $2)) with pm3d
}
