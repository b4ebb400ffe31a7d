# SPDX-License-Identifier: MIT
# Scenes, error at the end against run time: one particle on a spring that swings, a cloth of 25 × 25 particles that
# falls, and a sheet of water of 25 × 25, which is linear. Grey: GSL and SUNDIALS.
call system("dirname '".ARG0."'")."/style.gp" ARG1 1250
output = ARG1
file = ARG2
call plots."work-panel.gp" file
set output output
set multiplot layout 3,1 margins 0.19,0.94,0.06,0.87 spacing 0.07
call plots."work-panel.gp" file "elastic-pendulum" "elastic pendulum" 0
unset key
call plots."work-panel.gp" file "cloth" "cloth" 0
set xlabel "run time / s"
call plots."work-panel.gp" file "water" "water" 0
unset multiplot
