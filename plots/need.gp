# SPDX-License-Identifier: MIT
# Stops a figure with a message and status 1 unless each of some data files has a value in every column asked for, and
# there are as many of them as there should be.
#
#     call plots."need.gp" "FILE FILE..." "first_column second_column" [HOW-MANY-FILES]
#
# gnuplot by itself draws what is left and exits with 0.

if (ARGC > 2) {
    if (words(ARG1) != int(ARG3)) {
        exit error sprintf("%d data files where there should be %s (meson setup --reconfigure?): %s", words(ARG1), ARG3, ARG1)
    }
}
do for [needed in ARG1] {
    lacks = system(sprintf("awk -v columns='%s' -f '%sneed.awk' '%s' 2>&1", ARG2, plots, needed))
    if (lacks ne "") {
        exit error needed.": ".lacks
    }
}
