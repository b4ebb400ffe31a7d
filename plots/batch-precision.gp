# SPDX-License-Identifier: MIT
# What a spring and step of a batch costs in one precision, with its limits: called by batch-double.gp and batch-float.gp.
#
#     call plots."batch-precision.gp" OUTPUT BENCH PRECISION

call plots."need.gp" ARG2 "kernel precision count ns_per_spring_step limit_ns"
bench = ARG2
precision = ARG3

array kernels[4] = ["rk4_batch_1", "leapfrog_batch_1", "rk4_batch_16", "leapfrog_batch_16"]
array names[4] = ["RK4, one step a call", "leapfrog, one step a call", "RK4, 16 steps a call", "leapfrog, 16 steps a call"]
array types[4] = [rk4, leapfrog, rk4, leapfrog]
is(k) = strcol("kernel") eq kernels[k] && strcol("precision") eq precision
array points[4] = [9, 5, 8, 4] # filled for one step, open for sixteen

set logscale xy
set xrange [1000:1e7]
set format x "10^{%T}"
set xlabel "springs"
set ylabel "time / (ns per spring and step)"
set ytics (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2)
set key tmargin left Left reverse vertical maxrows 5
set output ARG1
plot for [k = 1:4] bench using (is(k) ? column("count") : NaN):"ns_per_spring_step" with linespoints linetype types[k] \
         dashtype solid pointtype points[k] pointsize 1.2 title names[k], \
     for [k = 1:4] bench using (is(k) ? column("count") : NaN):"limit_ns" with lines linetype types[k] linewidth 2 \
         dashtype (2,3) notitle, \
     NaN with lines linetype theory linewidth 2 dashtype (2,3) title "limits"
