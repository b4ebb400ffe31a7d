# SPDX-License-Identifier: MIT
# The errors of all three methods with the lines of theory: called by order.gp and readme.gp.
#
#     call plots."order-all.gp" OUTPUT COLUMN ERRORS... FITS...    three of each: Euler, leapfrog, RK4
#
# COLUMN is the horizontal axis: n, or force_evaluations, of which RK4 makes four a step and the others one.

array errors[3] = [ARG3, ARG4, ARG5]
array fits[3] = [ARG6, ARG7, ARG8]
array names[3] = ["Euler", "leapfrog", "RK4"]
array orders[3] = [1, 2, 4]
array a_step[3] = [1, 1, ARG2 eq "n" ? 1 : 4]
array constants[3]
do for [m = 1:3] {
    call plots."need.gp" errors[m] "n force_evaluations error_m"
    call plots."need.gp" fits[m] "theory_coefficient_m"
    stats fits[m] using "theory_coefficient_m" nooutput
    constants[m] = STATS_max
}
law(m, x) = constants[m] * (x / a_step[m])**-orders[m]

# Of points close together on the logarithmic axis, the first.
markers_a_decade = 5
last = -1
spaced(x) = (step = floor(markers_a_decade*log10(x)), step > last ? (last = step, x) : NaN)

set logscale xy
set xrange [4:20000]
set yrange [1e-15:1]
set format x "10^{%T}"
set format y "10^{%T}"
set ytics 1e3
set mytics 1
set ylabel "error in position / m"
unset key
do for [m = 1:3] {
    set label m names[m] at 200,law(m, 200) offset character 1,0.9 textcolor linetype m
}
set output ARG1
plot for [m = 1:3] law(m, x) with lines linetype theory, \
     for [m = 1:3] errors[m] using ARG2:"error_m" with lines linetype m, \
     for [m = 1:3] last = -1, errors[m] using (spaced(column(ARG2))):"error_m" with points linetype m
