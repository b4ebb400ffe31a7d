# SPDX-License-Identifier: MIT
# Error after one second versus the number of steps, for all methods. The grey lines are theory and are not fitted: an
# error constant times n to the power of minus the order. The coloured lines connect all measured points, and a few of
# these have markers.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "390 + key_height(methods + 1)"
set xlabel "steps n in 1 s"
call plots."order-all.gp" ARG1 "n" ARG3 ARG4
