# SPDX-License-Identifier: MIT
# The method with the fewest force evaluations for a given error, for one spring. The steps are as long as
# `spring_accurate_step()` allows. Each panel has a damping ratio ζ. The exact solution needs no force evaluations and
# is left out.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "620 + key_height(methods)"
map = ARG3
call plots."need.gp" map "damping_ratio tolerance periods method force_evaluations"

# The rows of a point follow each other.
stats map using "tolerance" nooutput
array damping[STATS_records]
array error[STATS_records]
array time[STATS_records]
array cheapest[STATS_records] # its number among the methods, 0: none
points = 0
same(z, e, t) = points > 0 && damping[points] == z && error[points] == e && time[points] == t
start(z, e, t) = (points = points + 1, damping[points] = z, error[points] = e, time[points] = t, cheapest[points] = 0, fewest = 1e300)
offer(m, evaluations) = m > 0 && evaluations < fewest ? (cheapest[points] = m, fewest = evaluations) : 0
number(name) = sum [m=1:methods] (names[m] eq name ? m : 0)
note(z, e, t) = (same(z, e, t) ? 0 : start(z, e, t), offer(number(strcol("method")), column("force_evaluations")))
stats map using (note(column("damping_ratio"), column("tolerance"), column("periods"))) nooutput

panels = 4
panel(i) = int((i - 1)*panels/points) + 1
set datafile separator whitespace # arrays have no tabs
set logscale xy
set xrange [0.6:1.6e4]
set yrange [6e-6:1.6]
unset grid
set key at screen 0.02,1 - 4.0/height left top vertical Left reverse samplen 2 maxrows (methods + 1)/2
set output ARG1
set multiplot layout 2,2 margins 0.17,0.96,80.0/height,key_bottom(methods) - 40.0/height spacing 0.05,66.0/height
do for [p = 1:panels] {
    set title sprintf("ζ = %.4g", damping[1 + (p - 1)*points/panels]) offset 0,-0.9
    if (p % 2) {
        set ytics 10 format "10^{%T}"
        set ylabel "error / initial value" offset 1,0
    } else {
        set ytics 10 format ""
        unset ylabel
    }
    if (p > 2) {
        set xtics 10 format "10^{%T}"
        set xlabel "periods"
    } else {
        set xtics 10 format ""
    }
    set mxtics 1
    set mytics 1
    plot for [m = 1:methods] cheapest using (panel($1) == p && $2 == m ? time[$1] : NaN):(error[$1]) with points \
             linetype types[m] pointsize 0.5 title labels[m]
    unset key
}
unset multiplot
