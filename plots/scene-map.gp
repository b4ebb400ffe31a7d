# SPDX-License-Identifier: MIT
# The result of each scene with each method versus the step, which is an integer fraction of a frame of 1/60 s. Bars:
# the stable step that the library returns. A stable step that is too short for the axis is written at the left end of the axis. In
# these runs, every run that explodes lies to the right of its bar.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "120 + 5*32*(methods + 1)"
map = ARG3
call plots."need.gp" map "scene method dt_s stable_step_s verdict"
array scenes[5] = ["rope", "cloth", "jelly", "chain", "water"]
array verdicts[4] = ["fine", "lossy", "gaining", "exploded"]
array marks[4] = [7, 11, 9, 13]
# Told apart by their shapes, too; to be seen on white and on black.
array colours[4] = ["#2A86C8", "#9A7FC0", "#E08A00", "#DB4A38"]

least = 0.015 # [ms] at the left
at(s, m) = (methods + 1)*(s - 1) + m
row(s, m) = strcol("scene") eq scenes[s] && strcol("method") eq names[m]
x(s, m, v) = row(s, m) && strcol("verdict") eq verdicts[v] ? 1000*column("dt_s") : NaN
microseconds(step) = step > 0 ? sprintf("%.2g µs", 1e6*step) : "none"

set xtics ("0.25" 0.25, "" 0.5, "1" 1, "" 2, "4" 4, "" 8, "16" 16, "" 32, "64" 64, "" 128)
set xlabel "step / ms"
set ytics () scale 0
longest = 0 # of the labels, in letters
do for [m = 1:methods] {
    longest = strlen(labels[m]) > longest ? strlen(labels[m]) : longest
}
do for [s = 1:5] {
    set label scenes[s] at least,at(s, 0) left offset 0.3,0
    do for [m = 1:methods] {
        set ytics add (labels[m] at(s, m))
        stats map using (row(s, m) ? 1000*column("stable_step_s") : NaN) nooutput
        stable = STATS_max # [ms]
        if (stable < least) {
            set label microseconds(stable/1000) at least,at(s, m) left offset 0.3,0
        } else {
            set arrow from stable,at(s, m) - 0.4 to stable,at(s, m) + 0.4 nohead front linetype exact linewidth 3
        }
    }
}
set logscale x
set xrange [least:200]
set yrange [at(5, methods) + 0.7:-0.6]
unset key
unset grid
set grid xtics linetype grid
set lmargin longest + 1.5
set tmargin 2.2
do for [v = 1:4] {
    set label verdicts[v] at screen 0.04 + 0.235*(v - 1),1 - 21.0/height offset 1,-0.25 \
        point pointtype marks[v] pointsize 1 linewidth 2 linecolor rgb colours[v]
}
set output ARG1
plot for [s = 1:5] for [m = 1:methods] for [v = 1:4] map using (x(s, m, v)):(at(s, m)) \
         with points pointtype marks[v] pointsize 0.6 linewidth 2 linecolor rgb colours[v]
