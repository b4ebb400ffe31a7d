# SPDX-License-Identifier: MIT
# Work–precision diagrams of one spring, error at the end versus run time: ten periods without damping, and five with a
# damping ratio of a tenth. Open markers: GSL (grey), SUNDIALS (ARKODE and CVODE, brown) and Boost.odeint (violet). The
# symplectic method of Boost.odeint applies only without drag. The star is the exact solution, which needs no steps.
# Errors below the range of the axis are drawn at its lower end.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "835 + key_height(methods + 8)"
output = ARG1
work = ARG3
entries = methods + 8
call plots."work-panel.gp" work
set output output
set multiplot layout 2,1 margins 0.2,0.94,82.0/height,key_bottom(entries) - 40.0/height spacing 84.0/height
call plots."work-panel.gp" work "ideal-10" "ideal, ten periods" 1
unset key
set xlabel "run time / s".note_on_sundials
call plots."work-panel.gp" work "damped" "damped" 1
unset multiplot
