# SPDX-License-Identifier: MIT
# Position and error over the last ten seconds of the long run. Each error has its own scale. The dotted lines mark the
# turning points. Euler has an amplitude error, which is largest at the turning points and zero at the equilibrium
# position. Leapfrog has a phase error, which is zero at the turning points and largest where the velocity is largest.
# RK4 has only rounding errors.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "235 + 155*methods"
runs = ARG3
call plots."need.gp" runs "t_s x_m exact_x_m" methods
array exponents[methods]
array largest[methods] # in units of that power of ten
do for [m = 1:methods] {
    stats file(runs, m) using (abs(column("x_m") - column("exact_x_m"))) nooutput
    exponents[m] = STATS_max > 0 ? floor(log10(STATS_max)) : 0
    largest[m] = STATS_max > 0 ? STATS_max/10.0**exponents[m] : 1
}

set xrange [990:1000]
set xtics 2
set format x ""
unset key
do for [half_periods = 316:318] {
    set arrow from half_periods*pi,graph 0 to half_periods*pi,graph 1 nohead linetype theory
}
set output ARG1
set multiplot layout methods + 1,1 margins 0.17,0.94,82.0/height,1 - 30.0/height spacing 0,40.0/height
set ylabel "position / m"
set yrange [-1.5:1.5]
set ytics 1
set label 1 "exact" at graph 0,1.15
plot file(runs, 1) using "t_s":"exact_x_m" with lines linetype exact
do for [m = 1:methods] {
    unit = 10.0**exponents[m]
    set ylabel sprintf("error / 10^{%d} m", exponents[m])
    set yrange [-1.2*largest[m]:1.2*largest[m]]
    set ytics largest[m] < 2 ? 1 : largest[m] < 5 ? 2 : 5
    set label 1 labels[m] at graph 0.01,1.15 offset 1,0 point linetype types[m]
    if (m == methods) {
        set format x
        set xlabel "time / s"
    }
    plot file(runs, m) using "t_s":((column("x_m") - column("exact_x_m"))/unit) with lines linetype types[m] dashtype solid
}
unset multiplot
