# SPDX-License-Identifier: MIT
# Time of one step of one spring. Grey: the same computation written out in a loop, in registers. For the exact solution
# this is the textbook formula with functions of the C library.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "all" 420
call plots."need.gp" ARG3 "kernel ns_per_spring_step limit_ns"

bars = 8
array kernels[4] = ["euler", "leapfrog", "rk4", "exact_call"]
array methods_of[4] = ["euler", "leapfrog", "rk4", "exact"]
array titles[bars]
array colours[bars]
do for [r = 1:bars] {
    titles[r] = r % 2 ? label_of(methods_of[(r + 1)/2]) : "written out"
    colours[r] = r % 2 ? linetype_of(methods_of[(r + 1)/2]) : theory
}
is(r) = strcol("kernel") eq kernels[(r + 1)/2]
size(r) = column(r % 2 ? "ns_per_spring_step" : "limit_ns")
set xlabel "ns per step"
set output ARG1
call plots."bars.gp" ARG3 0.3
