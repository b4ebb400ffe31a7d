# SPDX-License-Identifier: MIT
# Finds an instant in a file of positions: sets first and last, the numbers of its rows. Stops where it is not there.
#
#     call plots."instant.gp" FILE SECONDS

first = -1
last = -1
stats ARG1 using (abs(column("t_s") - real(ARG2)) < 1e-6 ? (first = first < 0 ? $0 : first, last = $0) : 0) nooutput
if (first < 0) {
    exit error ARG1.": no positions at ".ARG2." s"
}
