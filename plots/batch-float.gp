# SPDX-License-Identifier: MIT
# Time of one step of one spring in a batch in single precision versus the number of springs, for one step per call and
# for many. The dotted lines are the limits, as in the figure above.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "rk4 leapfrog" "390 + key_height(5)"
call plots."batch-precision.gp" ARG1 ARG3 float
