# SPDX-License-Identifier: MIT
# The positions of sheets at all their instants, read at once into arrays to be drawn from: to read a file anew for every
# picture of an animation takes far longer.
#
#     call plots."grid.gp" "FILES..." HOW-MANY      sheets of the same size at the same instants
#
# Sets frames, edge, particles, and the functions x_at(f, u, v), y_at(), z_at(): where the particle u along x and v along y
# is in frame f = 0, 1, …, those of the second file following those of the first; time_at(f); highest_at(f), the largest
# distance from z = 0. Draw over the pseudo-file '++':
#
#     splot sample [u=0:edge-1][v=0:edge-1] '++' using (x_at(f, $1, $2)):(y_at(f, $1, $2)):(z_at(f, $1, $2))

sheets = ARG1
call plots."need.gp" sheets "t_s i x_m y_m z_m" ARG2
stats word(sheets, 1) using "i" nooutput
edge = int(STATS_max) + 1
particles = edge*edge
rows = STATS_records
frames = rows/particles
array X[rows*words(sheets)]
array Y[rows*words(sheets)]
array Z[rows*words(sheets)]
array T[frames*words(sheets)]
array H[frames*words(sheets)]
row = 0
keep(t, x, y, z) = (X[row + 1] = x, Y[row + 1] = y, Z[row + 1] = z, f = row/particles + 1, T[f] = t, \
    H[f] = row%particles == 0 || abs(z) > H[f] ? abs(z) : H[f], row = row + 1, 0)
do for [sheet in sheets] {
    stats sheet using (keep(column("t_s"), column("x_m"), column("y_m"), column("z_m"))) nooutput
}
cell(f, u, v) = f*particles + edge*int(v + 0.5) + int(u + 0.5) + 1
x_at(f, u, v) = X[cell(f, u, v)]
y_at(f, u, v) = Y[cell(f, u, v)]
z_at(f, u, v) = Z[cell(f, u, v)]
time_at(f) = T[f + 1]
highest_at(f) = H[f + 1]
set samples edge
set isosamples edge
set datafile separator whitespace # the pseudo-file has no tabs
