# SPDX-License-Identifier: MIT
# {{ method }}: error after one second versus the number of steps, and the power law fitted through all points.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 ARG3 "390 + key_height(3)"
call plots."need.gp" ARG4 "n error_m"
call plots."need.gp" ARG5 "coefficient_m exponent"
stats ARG5 using "coefficient_m" nooutput
coefficient = STATS_max
stats ARG5 using "exponent" nooutput
exponent = STATS_max

set logscale xy
set format xy "10^{%T}"
set xrange [4:20000] # of all methods, and of order.gp
set yrange [1e-16:1]
set ytics 1e3
set mytics 1
set xlabel "steps n in 1 s"
set ylabel "error in position / m"
call plots."key.gp" 3 # two rows in one column
set output ARG1
plot ARG4 using "n":"error_m" with lines linetype types[1] dashtype solid linewidth 7 title "measured", \
     coefficient * x**exponent with lines linetype exact dashtype (6,4) title sprintf("%#.4g n^{ −%.4f}", coefficient, -exponent)
