# SPDX-License-Identifier: MIT
# The positions of a sheet at all its instants, read at once into arrays to be drawn from.
#
#     call plots."grid.gp" FILE
#
# Sets edge, particles, and the functions x_at(f, u, v), y_at(), z_at(): where the particle u along x and v along y is in frame
# f = 0, 1, …. Draw over the pseudo-file '++':
#
#     splot sample [u=0:edge-1][v=0:edge-1] '++' using (x_at(f, $1, $2)):(y_at(f, $1, $2)):(z_at(f, $1, $2))

sheet = ARG1
call plots."need.gp" sheet "t_s i x_m y_m z_m"
stats sheet using "i" nooutput
edge = int(STATS_max) + 1
particles = edge*edge
rows = STATS_records
array X[rows]
array Y[rows]
array Z[rows]
row = 0
keep(x, y, z) = (row = row + 1, X[row] = x, Y[row] = y, Z[row] = z, 0)
stats sheet using (keep(column("x_m"), column("y_m"), column("z_m"))) nooutput
cell(f, u, v) = f*particles + edge*int(v + 0.5) + int(u + 0.5) + 1
x_at(f, u, v) = X[cell(f, u, v)]
y_at(f, u, v) = Y[cell(f, u, v)]
z_at(f, u, v) = Z[cell(f, u, v)]
set samples edge
set isosamples edge
set datafile separator whitespace # the pseudo-file has no tabs
