# SPDX-License-Identifier: MIT
# Time of one step of one spring in a batch in double precision, with each feature. Top: few springs in cache, many steps
# per call. Bottom: many springs in memory, one step per call. Parameters are shared, or each spring has its own.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog rk4" 1000
call plots."need.gp" ARG3 "kernel precision count ns_per_spring_step"

bars = 16
array features[8] = ["_shared_omega2", "", "_shared_gamma", "_own_gamma", "_shared_accel", "_own_accel", \
    "_own_gamma_accel", "_zero_gamma_accel"]
array feature_titles[8] = ["shared stiffness", "own stiffness", "… shared damping", "… own damping", "… shared load", \
    "… own load", "… both own", "… arrays of zeros"]
array titles[bars]
array colours[bars]
do for [r = 1:bars] {
    titles[r] = r % 2 ? feature_titles[(r + 1)/2] : " "
    colours[r] = types[2 - r % 2]
}
steps = 16
springs = 1000
is(r) = strcol("kernel") eq sprintf("%s_batch_%d%s", names[2 - r % 2], steps, features[(r + 1)/2]) \
    && column("count") == springs && strcol("precision") eq "double"
size(r) = column("ns_per_spring_step")
set output ARG1
set multiplot
set tmargin at screen 0.94
set bmargin at screen 0.58
do for [m = 1:2] {
    set label m labels[m] at screen 0.25*m + 0.16,0.975 offset 1,0 point linetype types[m] pointtype 5 pointsize 1.5
}
set xlabel "ns per spring and step, in cache"
call plots."bars.gp" ARG3 0.4
unset label
steps = 1
springs = 1e7
set tmargin at screen 0.475
set bmargin at screen 0.115
set xlabel "ns per spring and step, from memory"
call plots."bars.gp" ARG3 0.4
