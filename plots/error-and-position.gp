# SPDX-License-Identifier: MIT
# Position and error over the last ten seconds of the long run. Dotted lines stand at the turning points. Euler's error is
# an amplitude that grew: it is greatest there, and zero where the spring passes its rest position. Leapfrog's is a clock
# that runs fast: it is zero at the turning points and greatest where the spring is fastest. What RK4 shows is rounding.
call system("dirname '".ARG0."'")."/style.gp" ARG1 700
array runs[3] = [ARG2, ARG3, ARG4]
array names[3] = ["Euler", "leapfrog", "RK4"]
array exponents[3] = [-2, -7, -14]
array tics[3] = [3, 2, 5]
do for [m = 1:3] {
    call plots."need.gp" runs[m] "t_s x_m exact_x_m"
}

set xrange [990:1000]
set xtics 2
set format x ""
unset key
do for [half_periods = 316:318] {
    set arrow from half_periods*pi,graph 0 to half_periods*pi,graph 1 nohead linetype theory
}
set output ARG1
set multiplot layout 4,1 margins 0.17,0.94,0.13,0.96 spacing 0.06
set ylabel "position / m"
set yrange [-1.5:1.5]
set ytics 1
set label 1 "exact" at graph 0.01,1.12
plot runs[euler] using "t_s":"exact_x_m" with lines linetype exact
set yrange [*:*]
do for [m = 1:3] {
    unit = 10.0**exponents[m]
    set ylabel sprintf("error / 10^{%d} m", exponents[m])
    set ytics tics[m]
    set label 1 names[m] at graph 0.01,1.12 textcolor linetype m
    if (m == 3) {
        set format x
        set xlabel "time / s"
    }
    plot runs[m] using "t_s":((column("x_m") - column("exact_x_m"))/unit) with lines linetype m dashtype solid
}
unset multiplot
