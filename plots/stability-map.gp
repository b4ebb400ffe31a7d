# SPDX-License-Identifier: MIT
# The error after ten periods versus step and damping ratio, as a fraction of the initial displacement. Orange: an error
# larger than the initial displacement. White line: the stability limit. Near ζ = 1 the spring is at rest after ten
# periods, so even long steps leave almost no error if they are stable. Leapfrog's limit is the same at every damping
# ratio. With strong damping and long steps it is inaccurate, because the part of the motion that should decay fast
# changes its sign in each step.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "200 + 250*((methods + 1)/2)"
map = ARG3
limits = ARG4
call plots."need.gp" map "method omega_dt damping_ratio error"
call plots."need.gp" limits "method damping_ratio limit_theory"

# An image takes whole rows of pixels: the block of the table that is the method's. (A column by its name, or the header
# would count as a row.)
array firsts[methods]
array lasts[methods]
do for [m = 1:methods] {
    STATS_records = 0
    stats map using (strcol("method") eq names[m] ? $0 + 0*column("error") : NaN) nooutput
    if (STATS_records == 0) {
        exit error map.": no rows of method ".names[m]
    }
    firsts[m] = STATS_min
    lasts[m] = STATS_max
}

call plots."cividis.gp" "-8" "0"
edge(m) = strcol("method") eq names[m] && column("damping_ratio") > 0 ? log10(column("damping_ratio")) : NaN

set cbtics ("≤10^{−8}" -8, "10^{−6}" -6, "10^{−4}" -4, "10^{−2}" -2, "≥1" 0.3) scale 0
set cblabel "error after ten periods" offset 0,0.4
set colorbox horizontal user origin 0.24,1 - 35.0/height size 0.66,14.0/height

pixel = 0.02 # half of one at the edges: an image that is cut becomes 14400 polygons
set xrange [-3 - pixel:1 + pixel]
set yrange [-2 - pixel:2 + pixel]
set xtics ("" -3, "0.01" -2, "" -1, "1" 0, "" 1)
unset grid
unset key
set output ARG1
set multiplot layout (methods + 1)/2,2 margins 0.2,0.96,80.0/height,1 - 148.0/height spacing 0.05,66.0/height
do for [m = 1:methods] {
    set title labels[m] offset 0,-0.9
    if (m % 2) {
        set ytics ("0.01" -2, "0.1" -1, "1" 0, "10" 1, "100" 2)
        set ylabel "damping ratio ζ" offset 1,0
    } else {
        set ytics ("" -2, "" -1, "" 0, "" 1, "" 2)
        unset ylabel
    }
    if (m > methods - 2) {
        set xlabel "step ω dt"
    }
    plot map every ::firsts[m]::lasts[m] \
             using (log10(column("omega_dt"))):(log10(column("damping_ratio"))):(level(strcol("error"))) with image, \
         limits using (log10(column("limit_theory"))):(edge(m)) with lines linecolor rgb "#010101" dashtype solid linewidth 4, \
         limits using (log10(column("limit_theory"))):(edge(m)) with lines linecolor rgb "#FEFEFE" dashtype solid linewidth 2
    unset colorbox
}
unset multiplot
