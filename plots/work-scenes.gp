# SPDX-License-Identifier: MIT
# Work–precision diagrams of scenes, error at the end versus run time (spring-work, problems elastic-pendulum, cloth and
# water): an elastic pendulum, a falling cloth, and a sheet of height-field water, which is linear. Open markers: GSL
# (grey), SUNDIALS (ARKODE and CVODE, brown) and Boost.odeint (violet). The symplectic method of Boost.odeint applies
# only without drag.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "1115 + key_height(methods + 7)"
output = ARG1
work = ARG3
entries = methods + 7
call plots."work-panel.gp" work
set output output
set multiplot layout 3,1 margins 0.2,0.94,82.0/height,key_bottom(entries) - 40.0/height spacing 84.0/height
call plots."work-panel.gp" work "elastic-pendulum" "elastic pendulum" 0
unset key
call plots."work-panel.gp" work "cloth" "cloth" 0
set xlabel "run time / s".note_on_sundials
call plots."work-panel.gp" work "water" "water" 0
unset multiplot
