# SPDX-License-Identifier: MIT
# The stability limit, as ω dt, versus the damping ratio. Marks: measured from the growth of computed motion, without
# using any formula for the limit. Lines: theory. Euler is stable only with damping, and its limit is largest at
# critical damping. Leapfrog's limit does not depend on damping. RK4's limit falls at strong damping.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "390 + key_height(methods + 1)"
stability = ARG3
call plots."need.gp" stability "method damping_ratio limit_measured limit_theory"

of(m, value) = strcol("method") eq names[m] && column("damping_ratio") > 0 ? value : NaN

set datafile missing NaN # a line runs on past the rows of other methods
set logscale xy
set xrange [0.008:125]
set yrange [0.01:*]
set format xy "10^{%T}"
set xtics 10
set mxtics 1
set xlabel "damping ratio ζ"
set ylabel "stability limit ω dt"
call plots."key.gp" methods + 1
set output ARG1
plot for [m = 1:methods] stability using "damping_ratio":(of(m, column("limit_theory"))) with lines linetype theory dashtype solid notitle, \
     for [m = 1:methods] stability using "damping_ratio":(of(m, column("limit_measured"))) with points linetype types[m] pointsize 0.45 \
         notitle, \
     for [m = 1:methods] NaN with points linetype types[m] title labels[m], \
     NaN with lines linetype theory dashtype solid title "theory"
