# SPDX-License-Identifier: MIT
# The solvers of other libraries in figures of work: their names in the tables, titles, line types (one a library) and
# markers. Called by these figures, which set work, the file.

array externals[8] = ["gsl-rk4", "gsl-rk8pd", "gsl-rk8pd-adaptive", "arkode-8", "cvode-adams", "cvode-bdf", \
    "odeint-rkf78", "odeint-sb3a-m4"]
array external_titles[8] = ["GSL rk4", "GSL rk8pd", "… adaptive", "ARKODE 8", "CVODE Adams", "CVODE BDF", \
    "odeint rkf78", "odeint sb3a-m4"]
array external_types[8] = [gsl, gsl, gsl, sundials, sundials, sundials, odeint, odeint]
array external_markers[8] = [4, 6, 8, 12, 10, 2, 14, 4]

# For the label of times: what has to be known of them.
note_on_sundials = system("grep -c '^# sundials: .*unoptimised' ".work."; true") eq "0" ? "" : " (SUNDIALS: unoptimised)"

# The axes of work-precision diagrams
set logscale xy
set format xy "10^{%T}"
set ytics 1e3
set mxtics 1
set mytics 1
