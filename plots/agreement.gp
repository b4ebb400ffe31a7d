# SPDX-License-Identifier: MIT
# The error of every check as a fraction of its bound, one dot per row of the table. A dot to the right of the line is a
# failed check, which stops the report. Errors below a hundred-millionth of their bound are drawn at the left edge.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "all" "990 + key_height(methods)"
call plots."need.gp" ARG3 "method witness error bound"
array kinds[15] = ["iterate", "solution", "solution", "drive", "gsl-rk4", "arkode-rk4", "gsl-rk8pd", "cvode-adams", "cvode-bdf", \
    "definition", "modes", "reduced-mass", "digits", "formula", "dispersion"]
array titles[15] = ["same method,\n115 digits", "solution,\nsteppers", "solution,\nexact", "solution,\ndriven", \
    "RK4 of GSL", "RK4 of\nARKODE", "GSL rk8pd", "CVODE\nAdams", "CVODE BDF", \
    "scene, second\nprogram", "scene,\nmodes", "scene,\nreduced mass", "scene,\ndigits", "scene,\nformula", "scene,\ndispersion"]
rows = |kinds|
least = 1e-8

# The second row of the two that share a reference is the exact solution's.
belongs(i) = strcol("witness") eq kinds[i] && (i != 2 || strcol("method") ne "exact") && (i != 3 || strcol("method") eq "exact")
fraction = 0.6180339887498949 # spreads the dots of a line evenly, whatever their number
height_in_row(row) = 0.6*(fraction*row - floor(fraction*row) - 0.5)
shown(i) = belongs(i) ? (column("error") > least*column("bound") ? column("error")/column("bound") : least) : NaN

set logscale x
set xrange [0.5*least:3]
set yrange [rows + 0.5:0.5]
set format x "10^{%T}"
set xtics 100
set mxtics 1
set xlabel "error / bound"
set ytics ()
do for [i = 1:rows] {
    set ytics add (titles[i] i)
}
call plots."key.gp" methods
set lmargin 13
set arrow from 1,0.5 to 1,rows + 0.5 nohead linetype theory dashtype solid
set linetype exact pointtype 6 # more easily seen than a cross
set output ARG1
plot for [m = 1:methods] for [i = 1:rows] ARG3 using (strcol("method") eq names[m] ? shown(i) : NaN):(i + height_in_row($0)) \
         with points linetype types[m] pointsize 0.6 notitle, \
     for [m = 1:methods] NaN with points linetype types[m] title labels[m]
