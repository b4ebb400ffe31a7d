# SPDX-License-Identifier: MIT
# The error after one second for all methods. The grey lines are not fitted: they are what theory predicts, an error
# constant times n to the power of minus the order. The coloured lines run through every measured point, the markers
# stand on a few of them.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "390 + key_height(methods + 1)"
set xlabel "steps n in 1 s"
call plots."order-all.gp" ARG1 "n" ARG3 ARG4
