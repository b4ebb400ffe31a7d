# SPDX-License-Identifier: MIT
# The errors of several methods with the lines of theory: called by order.gp and readme.gp.
#
#     call plots."order-all.gp" OUTPUT COLUMN "ERRORS..." "FITS..."    a file of each for every method
#
# COLUMN is the horizontal axis: n, or force_evaluations. Where theory says nothing of a method it has no line.

errors = ARG3
fits = ARG4
call plots."need.gp" errors "n force_evaluations error_m" methods
call plots."need.gp" fits "theory_coefficient_m" methods
array constants[methods]
array a_step[methods]
do for [m = 1:methods] {
    STATS_max = NaN
    stats file(fits, m) using "theory_coefficient_m" nooutput
    constants[m] = STATS_max
    a_step[m] = ARG2 eq "n" ? 1 : forces[m]
}
law(m, x) = constants[m] * (x / a_step[m])**-orders[m]

# Of points close together on the logarithmic axis, the first; those of one method between those of the others.
markers_a_decade = 3
last = -1
spaced(m, x) = (step = floor(markers_a_decade*log10(x) + real(m)/methods), step > last ? (last = step, x) : NaN)

set logscale xy
set xrange [4:20000]
set yrange [1e-16:1]
set format x "10^{%T}"
set format y "10^{%T}"
set ytics 1e3
set mytics 1
set ylabel "error in position / m"
call plots."key.gp" methods + 1
set output ARG1
plot for [m = 1:methods] law(m, x) with lines linetype theory notitle, \
     for [m = 1:methods] file(errors, m) using ARG2:"error_m" with lines linetype types[m] notitle, \
     for [m = 1:methods] last = -1, file(errors, m) using (spaced(m, column(ARG2))):"error_m" with points linetype types[m] notitle, \
     for [m = 1:methods] NaN with linespoints linetype types[m] title labels[m], \
     NaN with lines linetype theory title "theory"
