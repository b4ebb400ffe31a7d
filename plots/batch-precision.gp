# SPDX-License-Identifier: MIT
# Time per spring and step of a batch in one precision, with the limits: called by batch-double.gp and batch-float.gp.
#
#     call plots."batch-precision.gp" OUTPUT BENCH PRECISION

call plots."need.gp" ARG2 "kernel precision count ns_per_spring_step limit_ns"
bench = ARG2
precision = ARG3

array steps[2] = [1, 16]
array titles[2] = ["1 step", "16 steps"]
is(m, k) = strcol("kernel") eq sprintf("%s_batch_%d", names[m], steps[k]) && strcol("precision") eq precision

set logscale xy
set xrange [1000:1e7]
set format x "10^{%T}"
set xlabel "springs"
set ylabel "time / (ns per spring and step)"
set ytics (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2)
call plots."key.gp" 5
set output ARG1
plot for [k = 1:2] for [m = 1:methods] bench using (is(m, k) ? column("count") : NaN):"ns_per_spring_step" \
         with linespoints linetype types[m] dashtype solid pointtype (k == 1 ? 7 : 6) pointsize 1 title labels[m].", ".titles[k], \
     for [k = 1:2] for [m = 1:methods] bench using (is(m, k) ? column("count") : NaN):"limit_ns" \
         with lines linetype types[m] linewidth 2 dashtype (2,3) notitle, \
     NaN with lines linetype theory linewidth 2 dashtype (2,3) title "limits"
