# SPDX-License-Identifier: MIT
# Time of one step of a sheet with each feature, with many steps per call, in double precision unless noted. The unit is
# the time of a plain loop over an array of links for the same sheet without these features. The number of force
# evaluations per step explains most of the differences between methods.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" 600
call plots."need.gp" ARG3 "kernel precision count ns_per_spring_step baseline_ns"

bars = 14
array kernels[bars] = ["leapfrog_sheet_16", "leapfrog_sheet_16", "leapfrog_sheet_16", "leapfrog_sheet_16_masses", \
    "leapfrog_sheet_16_drag", "leapfrog_sheet_16_damping", "leapfrog_sheet_16_editable", "leapfrog_sheet_16_no_undo", \
    "leapfrog_sheet_16_callback_still", "leapfrog_sheet_16_callback", "leapfrog_sheet_16_links_shuffled", \
    "leapfrog_water_16", "rk4_sheet_16", "rkn8_sheet_16"]
array titles[bars] = ["a plain loop", "leapfrog", "… single precision", "… different masses", "… drag", "… damped links", \
    "… editable", "… no rollback", "… callback, positions", "… callback, velocities", "… unsorted links", \
    "… one axis: water", "RK4", "RKN8"]
array colours[bars]
do for [r = 1:bars] {
    colours[r] = r == 1 ? theory : r < 13 ? types[1] : linetype_of(r == 13 ? "rk4" : "rkn8")
}
is(r) = strcol("kernel") eq kernels[r] && column("count") == 7002 && strcol("precision") eq (r == 3 ? "float" : "double")
stats ARG3 using (is(1) ? column("baseline_ns") : 0) nooutput
plain_loop = STATS_sum
size(r) = r == 1 ? 1 : column("ns_per_spring_step")/plain_loop
set xlabel "time / time of plain loop"
set output ARG1
call plots."bars.gp" ARG3 0.47
