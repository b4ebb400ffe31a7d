# SPDX-License-Identifier: MIT
# What a link asks of two processors: cycles for one, in double and vectors of 32 bytes, as llvm-mca expects them of the
# instructions. Nothing is run.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" 420
call plots."need.gp" ARG3 "loop vector precision processor item cycles_per_item"

bars = 8
array loops[4] = ["all_bands_3", "all_bands_3_damped", "all_bands_2", "all_edges_3"]
array loop_titles[4] = ["in a band", "… damped", "… on two axes", "in no order"]
array processors[2] = ["znver3", "sapphirerapids"]
array processor_titles[2] = ["AMD Zen 3", "Intel Sapphire Rapids"]
array titles[bars]
array colours[bars]
do for [r = 1:bars] {
    titles[r] = r % 2 ? loop_titles[(r + 1)/2] : " "
    colours[r] = r % 2 ? exact : theory
}
is(r) = strcol("loop") eq loops[(r + 1)/2] && strcol("processor") eq processors[2 - r % 2] && column("vector") == 256 \
    && strcol("precision") eq "double" && strcol("item") ne "link-end"
size(r) = column("cycles_per_item")
set tmargin at screen 0.9
do for [p = 1:2] {
    set label p processor_titles[p] at screen 0.31*p - 0.02,0.95 offset 1,0 point linetype (p == 1 ? exact : theory) pointtype 5 pointsize 1.5
}
set xlabel "cycles a link"
set output ARG1
call plots."bars.gp" ARG3 0.3
