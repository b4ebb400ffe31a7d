# SPDX-License-Identifier: MIT
# {{ method }} over {{ data('work-long').rows|map(attribute='duration_s')|max|int }} s: stretch of the 99th percentile of links, and change of energy relative to the
# energy that gravity released, versus time per frame. Means over the second half. Accurate runs have no change of energy.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog rk4 srkn6 rkn8" "600 + key_height(methods + 5)"
problem = ARG3
long = ARG4
call plots."need.gp" long "problem solver frame_s stretch_99 energy_change"
set datafile missing NaN
microseconds(name) = strcol("problem") eq problem && strcol("solver") eq name ? column("frame_s")*1e6 : NaN

set logscale xy
set format x ""
set format y "%g"
entries = methods + 5
array others[5] = ["xpbd", "bdf2-cg", "projective", "cvode-bdf2", "cvode-bdf"]
array other_titles[5] = ["XPBD", "BDF2-CG", "projective", "CVODE BDF2", "CVODE BDF"]
array other_types[5] = [exact, gsl, odeint, sundials, sundials]
array other_markers[5] = [6, 8, 12, 3, 2]
call plots."key.gp" entries
set lmargin at screen 0.19
set output ARG1
set multiplot
set bmargin at screen 0.46
set yrange [0.01:9]
set ylabel "stretch, 99th percentile" offset 1,0
plot for [m = 1:methods] long using (microseconds(names[m])):"stretch_99" with linespoints linetype types[m] linewidth 2 \
         title labels[m], \
     for [s = 1:5] long using (microseconds(others[s])):"stretch_99" with linespoints linetype other_types[s] linewidth 2 \
         pointtype other_markers[s] title other_titles[s]
unset key
unset logscale y
set format x "10^{%T}"
set tmargin at screen 0.42
set bmargin at screen 0.13
set yrange [-1.1:0.6]
set ylabel "change of energy" offset 1,0
set xlabel "time per frame / µs"
plot for [m = 1:methods] long using (microseconds(names[m])):"energy_change" with linespoints linetype types[m] linewidth 2, \
     for [s = 1:5] long using (microseconds(others[s])):"energy_change" with linespoints linetype other_types[s] linewidth 2 \
         pointtype other_markers[s]
unset multiplot
