# SPDX-License-Identifier: MIT
# The error after one second for all three methods. The grey lines are not fitted: they are what theory predicts, an
# error constant times n to the power −1, −2 and −4. The coloured lines run through every measured point, the markers
# stand on a few of them.
call system("dirname '".ARG0."'")."/style.gp" ARG1
set xlabel "steps n in 1 s"
call plots."order-all.gp" ARG1 "n" ARG2 ARG3 ARG4 ARG5 ARG6 ARG7
