# SPDX-License-Identifier: MIT
# The error of one method against the number of steps, with its fit: called by order-euler.gp and its like.
#
#     call plots."order-method.gp" OUTPUT ERRORS FIT LINETYPE

call plots."need.gp" ARG2 "n error_m"
call plots."need.gp" ARG3 "coefficient_m exponent"
stats ARG3 using "coefficient_m" nooutput
coefficient = STATS_max
stats ARG3 using "exponent" nooutput
exponent = STATS_max

set logscale xy
set format xy "10^{%T}"
set xlabel "steps n in 1 s"
set ylabel "error in position / m"
set key bottom left
set output ARG1
plot ARG2 using "n":"error_m" with lines linetype int(ARG4) dashtype solid linewidth 7 title "measured", \
     coefficient * x**exponent with lines linetype exact dashtype (6,4) title sprintf("%#.4g n^{ −%.4f}", coefficient, -exponent)
