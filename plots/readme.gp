# SPDX-License-Identifier: MIT
# Error after one second versus cost, counted in force evaluations. RK4 has four force evaluations per step, the other
# methods have one. Grey: theory, not fitted.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "euler leapfrog rk4" "390 + key_height(methods + 1)"
do for [m = 1:methods] {
    types[m] = word("1 3 4", m) + 0 # the README keeps its picture when the table grows
}
set object rectangle from screen 0,0 to screen 1,1 behind fillcolor linetype page fillstyle solid noborder
set xlabel "force evaluations in 1 s"
call plots."order-all.gp" ARG1 "force_evaluations" ARG3 ARG4
