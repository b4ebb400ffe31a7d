# SPDX-License-Identifier: MIT
# Stops a figure with a message and status 1 unless a data file has a value in every column asked for.
#
#     call plots."need.gp" FILE "first_column second_column"
#
# gnuplot by itself draws what is left and exits with 0.

lacks = system(sprintf("awk -v columns='%s' -f '%sneed.awk' '%s' 2>&1", ARG2, plots, ARG1))
if (lacks ne "") {
    exit error ARG1.": ".lacks
}
