# SPDX-License-Identifier: MIT
# The solvers of other libraries in figures of work: their names in the tables, titles, line types (one a library) and
# markers. Called by these figures.

array externals[6] = ["gsl-rk4", "gsl-rk8pd", "gsl-rk8pd-adaptive", "arkode-adaptive", "cvode-adams", "cvode-bdf"]
array external_titles[6] = ["GSL rk4", "GSL rk8pd", "… adaptive", "ARKODE", "CVODE Adams", "CVODE BDF"]
array external_types[6] = [gsl, gsl, gsl, sundials, sundials, sundials]
array external_markers[6] = [4, 6, 8, 12, 10, 2]
