# SPDX-License-Identifier: MIT
# One spring, error at the end against the time the run took: ten periods without damping, and five with a damping ratio
# of a tenth. Grey: GSL and SUNDIALS. The star is the closed form, which takes no steps.
# Errors below 10⁻¹⁶ are drawn there.
call system("dirname '".ARG0."'")."/style.gp" ARG1 960
output = ARG1
file = ARG2
call plots."work-panel.gp" file
set output output
set multiplot layout 2,1 margins 0.19,0.94,0.08,0.83 spacing 0.08
call plots."work-panel.gp" file "ideal-10" "ideal, ten periods" 1
unset key
set xlabel "run time / s"
call plots."work-panel.gp" file "damped" "damped" 1
unset multiplot
