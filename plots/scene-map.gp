# SPDX-License-Identifier: MIT
# What becomes of each scene with each method over the step, which is a whole part of a frame of 1/60 s. Bars: the
# stable step that the library states. Euler's is far off to the left, and written there. The library's steps are on the
# safe side: what explodes does so to the right of its bar.
call system("dirname '".ARG0."'")."/style.gp" ARG1 760
call plots."need.gp" ARG2 "scene method dt_s stable_step_s verdict"
array scenes[5] = ["rope", "cloth", "jelly", "chain", "water"]
array methods[3] = ["euler", "leapfrog", "rk4"]
array names[3] = ["Euler", "leapfrog", "RK4"]
array verdicts[4] = ["fine", "lossy", "gaining", "exploded"]
array marks[4] = [7, 11, 9, 13]
# Told apart by their shapes, too; to be seen on white and on black.
array colours[4] = ["#2A86C8", "#9A7FC0", "#E08A00", "#DB4A38"]

least = 0.055 # [ms] at the left
place(s, m) = 4*(s - 1) + m
row(s, m) = strcol("scene") eq scenes[s] && strcol("method") eq methods[m]
x(s, m, v) = row(s, m) && strcol("verdict") eq verdicts[v] ? 1000*column("dt_s") : NaN
microseconds(step) = step > 0 ? sprintf("%.2g µs", 1e6*step) : "none"

array stable_step[15] # [ms]
do for [s = 1:5] {
    do for [m = 1:3] {
        stats ARG2 using (row(s, m) ? 1000*column("stable_step_s") : NaN) nooutput
        stable_step[3*(s - 1) + m] = STATS_max
    }
}

set logscale x
set xrange [least:50]
set yrange [19.7:-0.6]
set xtics ("0.25" 0.25, "" 0.5, 1, 2, 4, 8, 16, 32)
set xlabel "step / ms"
set ytics () scale 0
do for [s = 1:5] {
    set label scenes[s] at least,place(s, 0) left offset 0.3,0
    do for [m = 1:3] {
        set ytics add (names[m] place(s, m))
        stable = stable_step[3*(s - 1) + m]
        if (stable < least) {
            set label microseconds(stable/1000) at least,place(s, m) left offset 0.3,0
        } else {
            set arrow from stable,place(s, m) - 0.5 to stable,place(s, m) + 0.5 nohead front linetype exact linewidth 3
        }
    }
}
unset key
unset grid
set grid xtics linetype grid
set lmargin 9.5
set tmargin 2.2
do for [v = 1:4] {
    set label verdicts[v] at screen 0.04 + 0.235*(v - 1),0.972 offset 1,-0.25 \
        point pointtype marks[v] pointsize 1 linewidth 2 linecolor rgb colours[v]
}
set output ARG1
plot for [s = 1:5] for [m = 1:3] for [v = 1:4] ARG2 using (x(s, m, v)):(place(s, m)) \
         with points pointtype marks[v] pointsize 0.6 linewidth 2 linecolor rgb colours[v]
